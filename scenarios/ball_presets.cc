#include "scenarios/ball_presets.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/check.h"
#include "scenarios/embedded.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

BallPreset ReadPreset(const EmbeddedFile& file) {
  const YamlDocument document(std::string(file.text), "assets/balls/" + std::string(file.name) + ".yaml");
  BallPreset preset{file.name, {}, {}};
  std::string name;
  document.Read([&](ParamVisitor& v) {
    v.Text({"name", "Name of the preset.", true}, name);
    v.Text({"description", "What it is.", true}, preset.description);
    preset.ball.Visit(v);
  });
  Demand(name == file.name, "a preset's file is called like the preset");
  preset.ball.Check();
  return preset;
}

std::vector<BallPreset> ReadLibrary() {
  std::vector<BallPreset> all{{"none", "The defaults listed with the keys of `ball`", {}}};
  for (const EmbeddedFile& file : EmbeddedBalls()) all.push_back(ReadPreset(file));
  return all;
}

}  // namespace

std::span<const BallPreset> BallPresets() {
  static const std::vector<BallPreset> library = ReadLibrary();
  return library;
}

std::span<const std::string_view> BallPresetNames() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const BallPreset& preset : BallPresets()) all.push_back(preset.name);
    return all;
  }();
  return names;
}

const sim::BallParams& FindBall(std::string_view preset) {
  const auto all = BallPresets();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const BallPreset& p) { return p.name == preset; });
  Demand(found != all.end(), "a preset's name was checked when it was read");
  return found->ball;
}

}  // namespace piperun::scenarios
