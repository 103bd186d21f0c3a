#include "scenarios/load.h"

#include <algorithm>
#include <filesystem>

#include "base/check.h"
#include "scenarios/embedded.h"
#include "scenarios/nearest_name.h"
#include "scenarios/output_file.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

Scenario ReadScenario(YamlDocument document, const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) document.Set(assignment);
  Scenario scenario;
  document.Read([&](ParamVisitor& v) { scenario.Visit(v); }, &scenario.sources);
  return scenario;
}

[[noreturn]] void RefuseUnknownScenario(const std::string& name) {
  std::vector<std::string> known;
  for (const EmbeddedFile& file : EmbeddedScenarios()) known.emplace_back(file.name);
  std::string problem = "there is no such file, and no scenario of this name in the catalogue";
  if (const auto near = FindNearestName(name, known)) problem += "; did you mean '" + *near + "'?";
  throw InputError(problem + " (`piperun scenario list` shows all)", "", name);
}

}  // namespace

Scenario ParseScenario(const std::string& text, const std::string& file,
                       const std::vector<std::string>& overrides) {
  return ReadScenario(YamlDocument(text, file), overrides);
}

Scenario LoadScenario(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  if (std::filesystem::is_regular_file(path_or_name)) {
    return ReadScenario(YamlDocument::FromFile(path_or_name), overrides);
  }
  const auto& catalogue = EmbeddedScenarios();
  const auto found = std::find_if(catalogue.begin(), catalogue.end(),
                                  [&](const EmbeddedFile& f) { return f.name == path_or_name; });
  if (found == catalogue.end()) RefuseUnknownScenario(path_or_name);
  return ParseScenario(std::string(found->text), path_or_name + ".yaml", overrides);
}

std::string WriteScenario(const Scenario& scenario) {
  Scenario copy = scenario;  // visitors may change what they visit; writers do not
  return WriteYaml([&](ParamVisitor& v) { copy.Visit(v); });
}

}  // namespace piperun::scenarios
