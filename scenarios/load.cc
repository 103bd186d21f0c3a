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

void RequireSensible(const ExpectEntry& entry, const std::string& key, const SourceMap& sources) {
  const auto refuse = [&](const std::string& problem) { throw InputError(problem, key, sources.Find(key)); };
  if (!entry.path.starts_with('/')) refuse("'" + entry.path + "' is no JSON pointer; it begins with '/'");
  if (!entry.min && !entry.max && entry.equals.empty())
    refuse("nothing is expected; give min, max or equals");
  if (entry.min && entry.max && *entry.min > *entry.max) refuse("min lies above max");
}

Scenario ReadScenario(YamlDocument document, const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) document.Set(assignment);
  Scenario scenario;
  document.Read([&](ParamVisitor& v) { scenario.Visit(v); }, &scenario.sources);
  for (std::size_t i = 0; i < scenario.expect.size(); ++i) {
    RequireSensible(scenario.expect[i], "expect[" + std::to_string(i) + "]", scenario.sources);
  }
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
