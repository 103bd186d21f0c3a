#include "scenarios/materials.h"

#include <algorithm>
#include <map>

#include "base/check.h"
#include "scenarios/embedded.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

using Library = std::map<std::string_view, WallParams>;

WallParams ReadMaterial(const EmbeddedFile& file) {
  const YamlDocument document(std::string(file.text), "assets/materials/" + std::string(file.name) + ".yaml");
  std::string name, description;
  WallParams wall;
  document.Read([&](ParamVisitor& v) {
    v.Text({"name", "Name of the material.", true}, name);
    v.Text({"description", "What it is.", true}, description);
    wall.Visit(v);
  });
  Demand(name == file.name, "a material's file is called like the material");
  return wall;
}

const Library& Materials() {
  static const Library library = [] {
    Library all;
    for (const EmbeddedFile& file : EmbeddedMaterials()) all[file.name] = ReadMaterial(file);
    return all;
  }();
  return library;
}

}  // namespace

std::vector<std::string_view> MaterialNames() {
  std::vector<std::string_view> names;
  for (const auto& [name, wall] : Materials()) names.push_back(name);
  return names;
}

WallParams FindWall(std::string_view material, const WallParams& given) {
  if (given.young_modulus_Pa > 0) return given;
  const auto found = Materials().find(material);
  return found == Materials().end() ? given : found->second;
}

}  // namespace piperun::scenarios
