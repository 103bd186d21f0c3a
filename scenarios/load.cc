#include "scenarios/load.h"

#include <algorithm>
#include <filesystem>

#include "base/check.h"
#include "base/nearest_name.h"
#include "scenarios/embedded.h"
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

/// A path as it is seen from the folder of the file that names it.
std::filesystem::path Resolve(const std::string& path, const std::filesystem::path& folder) {
  return std::filesystem::path(path).is_absolute() ? std::filesystem::path(path) : folder / path;
}

[[noreturn]] void RefuseUnknownFile(const std::string& path, const std::string& key, const SourceMap& sources,
                                    const std::string& otherwise) {
  throw InputError("there is no file '" + path + "'" + otherwise, key, sources.Find(key));
}

/// The text of an EPANET file: by path, or one of our own by name.
std::string ReadInpText(const Scenario& scenario, const std::filesystem::path& folder) {
  const std::string& inp = scenario.network.inp;
  const std::filesystem::path path = Resolve(inp, folder);
  if (std::filesystem::is_regular_file(path)) return ReadTextFile(path);
  std::vector<std::string> known;
  for (const EmbeddedFile& file : EmbeddedNetworks()) {
    if (file.name == inp) return std::string(file.text);
    known.emplace_back(file.name);
  }
  std::string otherwise = ", and no network of this name in piperun";
  if (const auto near = FindNearestName(inp, known)) otherwise += "; did you mean '" + *near + "'?";
  RefuseUnknownFile(path.string(), "network.inp", scenario.sources, otherwise);
}

void RequireOneNetwork(const Scenario& scenario) {
  const NetworkSource& network = scenario.network;
  const auto refuse = [&](const std::string& key, const std::string& problem) {
    throw InputError(problem, key, scenario.sources.Find(key));
  };
  if (network.inp.empty()) {
    if (!network.material_rules.empty()) refuse("network.material_rules", "rules need an EPANET file, `inp`");
    return;
  }
  if (!network.pipes.empty() || !network.nodes.empty()) {
    refuse("network.inp", "an EPANET file brings its own nodes and pipes; give the one or the others");
  }
  if (scenario.flow.inlet_m3_s != 0 || scenario.flow.inlet_pressure_Pa != 0) {
    refuse("flow", "an EPANET file brings its own flows and pressures; leave inlet flow and pressure out");
  }
}

void RequireWholeOrigin(const Scenario& scenario) {
  const GeoOrigin& origin = scenario.network.origin;
  if (origin.latitude_deg.has_value() == origin.longitude_deg.has_value()) return;
  throw InputError("has only one of latitude_deg and longitude_deg; give both", "network.origin",
                   scenario.sources.Find("network.origin"));
}

/// Reads the files that a scenario refers to.
void LoadFiles(const std::filesystem::path& folder, Scenario& scenario) {
  RequireOneNetwork(scenario);
  RequireWholeOrigin(scenario);
  NetworkSource& network = scenario.network;
  if (!network.inp.empty()) network.inp_text = ReadInpText(scenario, folder);
  if (network.material_rules.empty()) return;
  const std::filesystem::path rules = Resolve(network.material_rules, folder);
  if (!std::filesystem::is_regular_file(rules)) {
    RefuseUnknownFile(rules.string(), "network.material_rules", scenario.sources, "");
  }
  network.material_rules_text = ReadTextFile(rules);
}

Scenario ReadScenario(YamlDocument document, const std::filesystem::path& folder,
                      const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) document.Set(assignment);
  Scenario scenario;
  scenario.folder = folder;
  document.Read([&](ParamVisitor& v) { scenario.Visit(v); }, &scenario.sources);
  for (std::size_t i = 0; i < scenario.expect.size(); ++i) {
    RequireSensible(scenario.expect[i], "expect[" + std::to_string(i) + "]", scenario.sources);
  }
  LoadFiles(folder, scenario);
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
  return ReadScenario(YamlDocument(text, file), std::filesystem::path(file).parent_path(), overrides);
}

Scenario LoadScenario(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  if (std::filesystem::is_regular_file(path_or_name)) {
    return ReadScenario(YamlDocument::FromFile(path_or_name),
                        std::filesystem::path(path_or_name).parent_path(), overrides);
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
