#include "scenarios/sensor_presets.h"

#include <algorithm>

#include "base/check.h"
#include "base/nearest_name.h"
#include "scenarios/embedded.h"
#include "scenarios/output_file.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

/// A section per kind, where the file has one.
void VisitSections(ParamVisitor& v, std::vector<KindEntry>& sections) {
  for (const KindOption& option : SensorOptions()) {
    v.Group({option.name, option.doc}, [&](ParamVisitor& section) {
      sections.emplace_back(SensorOptions, option.name).VisitParams(section);
    });
  }
}

SensorPreset ReadPreset(const std::string& text, const std::string& file) {
  SensorPreset preset;
  YamlDocument(text, file).Read([&](ParamVisitor& v) {
    v.Text({"name", "Name of the preset.", true}, preset.name);
    v.Text({"description", "What it is.", true}, preset.description);
    VisitSections(v, preset.sections);
  });
  if (preset.sections.empty()) {
    std::string kinds;
    for (const KindOption& option : SensorOptions()) kinds += " " + std::string(option.name);
    throw InputError("a preset needs a section for a kind of sensor:" + kinds, "", file);
  }
  return preset;
}

std::vector<SensorPreset> ReadLibrary() {
  std::vector<SensorPreset> all;
  for (const EmbeddedFile& file : EmbeddedSensors()) {
    all.push_back(ReadPreset(std::string(file.text), "assets/sensors/" + std::string(file.name) + ".yaml"));
    Demand(all.back().name == file.name, "a preset's file is called like the preset");
  }
  return all;
}

/// A text as YAML, whatever it holds.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

[[noreturn]] void RefuseUnknownPreset(const std::string& preset) {
  std::vector<std::string> known{"none"};
  for (const SensorPreset& board : SensorPresets()) known.push_back(board.name);
  std::string problem = "there is no sensor preset '" + preset + "', and no such file";
  if (const auto near = FindNearestName(preset, known)) problem += "; did you mean '" + *near + "'?";
  problem += problem.ends_with('?') ? " Known:" : "; known:";
  for (const std::string& name : known) problem += " " + name;
  throw InputError(problem, "preset");
}

}  // namespace

const KindEntry* SensorPreset::Find(std::string_view kind) const {
  const auto found =
      std::find_if(sections.begin(), sections.end(), [&](const KindEntry& s) { return s.kind() == kind; });
  return found == sections.end() ? nullptr : &*found;
}

std::string SensorPreset::Kinds() const {
  std::string kinds;
  for (const KindEntry& section : sections) kinds += (kinds.empty() ? "" : ", ") + section.kind();
  return kinds;
}

std::span<const SensorPreset> SensorPresets() {
  static const std::vector<SensorPreset> library = ReadLibrary();
  return library;
}

SensorPreset LoadSensorPreset(const std::string& preset, const std::filesystem::path& folder) {
  const auto all = SensorPresets();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SensorPreset& p) { return p.name == preset; });
  if (found != all.end()) return *found;
  const std::filesystem::path path = folder / preset;  // an absolute path stands for itself
  if (!std::filesystem::is_regular_file(path)) RefuseUnknownPreset(preset);
  SensorPreset own = ReadPreset(ReadTextFile(path), path.string());
  own.from_file = true;
  return own;
}

std::string WritePresetScenario(const SensorPreset& loaded, const std::string& preset) {
  std::string text =
      "schema: piperun.scenario/1\nname: " + Quoted(loaded.name) + "\nwater: {temperature_C: 25}\nsensors:\n";
  for (const KindEntry& section : loaded.sections) {
    const std::string channel = section.kind() == "magnetometer" ? "mag0" : section.kind() + "0";
    text += "  " + channel + ": {kind: " + section.kind() + ", preset: " + Quoted(preset) +
            (section.kind() != "magnetometer" ? ", thermal: {initial_C: 25}}\n" : "}\n");
  }
  return text;
}

}  // namespace piperun::scenarios
