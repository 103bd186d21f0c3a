#include "scenarios/pipe_sound.h"

#include <functional>
#include <map>

#include "base/check.h"
#include "scenarios/embedded.h"
#include "scenarios/yaml_document.h"

namespace piperun::scenarios {
namespace {

using Names = std::vector<std::string_view>;

constexpr std::string_view kNetwork = "network", kNone = "none";
constexpr Range kLining{.min = 1e-5, .max = 0.1};

void VisitSoil(ParamVisitor& v, acoustics::Soil& soil) {
  v.Number({"bulk_modulus_Pa", "Bulk modulus.", true}, Range::Positive(), soil.bulk_modulus_Pa);
  v.Number({"shear_modulus_Pa", "Shear modulus.", true}, Range::Positive(), soil.shear_modulus_Pa);
  v.Number({"density_kg_m3", "Density.", true}, Range::Positive(), soil.density_kg_m3);
}

void VisitLining(ParamVisitor& v, WallMaterial& lining) {
  v.Number({"young_modulus_Pa", "Young's modulus.", true}, Range::Positive(), lining.young_modulus_Pa);
  v.Number({"loss_factor", "Loss factor.", true}, Range::Between(0, 1), lining.loss_factor);
  v.Number({"poisson_ratio", "Poisson's ratio.", true}, Range::Between(0, 0.5), lining.poisson_ratio);
  v.Number({"density_kg_m3", "Density.", true}, Range::Positive(), lining.density_kg_m3);
}

/// What the files of a folder describe, by name.
template <class T>
std::map<std::string_view, T> ReadLibrary(const std::vector<EmbeddedFile>& files, const std::string& folder,
                                          void (*visit)(ParamVisitor&, T&)) {
  std::map<std::string_view, T> library;
  for (const EmbeddedFile& file : files) {
    const YamlDocument document(std::string(file.text), folder + std::string(file.name) + ".yaml");
    std::string name, description;
    document.Read([&](ParamVisitor& v) {
      v.Text({"name", "Its name.", true}, name);
      v.Text({"description", "What it is.", true}, description);
      visit(v, library[file.name]);
    });
    Demand(name == file.name, "a file of a library is called like what it describes");
  }
  return library;
}

const std::map<std::string_view, acoustics::Soil>& Soils() {
  static const auto library = ReadLibrary<acoustics::Soil>(EmbeddedSoils(), "assets/soils/", VisitSoil);
  return library;
}

const std::map<std::string_view, WallMaterial>& Linings() {
  static const auto library = [] {
    auto all = ReadLibrary<WallMaterial>(EmbeddedLinings(), "assets/linings/", VisitLining);
    for (auto& [name, lining] : all) lining.name = name;
    return all;
  }();
  return library;
}

template <class T>
Names ListNames(const std::map<std::string_view, T>& library) {
  Names names;
  for (const auto& entry : library) names.push_back(entry.first);
  return names;
}

template <class T>
const T& Find(const std::map<std::string_view, T>& library, std::string_view name) {
  const auto found = library.find(name);
  Demand(found != library.end(), "a name of a library was checked when it was read");
  return found->second;
}

/// Words in front of a library's own.
Names WithWords(Names words, const Names& names) {
  words.insert(words.end(), names.begin(), names.end());
  return words;
}

void VisitNames(ParamVisitor& v, const Names& words, std::string& wave_law, std::string& soil,
                std::string& lining) {
  const bool of_pipe = words.front() == kNetwork;
  const Names laws =
      of_pipe ? Names{kNetwork, "auto", "compact", "wall_inertia"} : Names{"auto", "compact", "wall_inertia"};
  v.Choice(
      {"wave_law",
       "How the wall answers sound: compact (Korteweg), wall_inertia, or auto, which takes the better one "
       "by frequency."},
      laws, wave_law);
  v.Choice({"soil", "What the pipe lies in, a name from the soil library; none: air."},
           WithWords(words, SoilNames()), soil);
  v.Choice({"lining", "What the wall is lined with, a name from the lining library."},
           WithWords(words, LiningNames()), lining);
}

acoustics::WaveLaw FindLaw(std::string_view name) {
  if (name == "compact") return acoustics::WaveLaw::kCompact;
  if (name == "wall_inertia") return acoustics::WaveLaw::kWallInertia;
  Demand(name == "auto", "a wave law's name was checked when it was read");
  return acoustics::WaveLaw::kAuto;
}

}  // namespace

void NetworkSoundParams::Visit(ParamVisitor& v) {
  VisitNames(v, {kNone}, wave_law, soil, lining);
  v.Number({"lining_m", "Thickness of the lining: 0.004 of mortar up to DN300, 0.0003 to 0.001 of epoxy."},
           kLining, lining_m);
}

void PipeSoundParams::Visit(ParamVisitor& v) {
  VisitNames(v, {kNetwork, kNone}, wave_law, soil, lining);
  v.NumberOr({"lining_m", "Thickness of the lining."}, kLining, kNetwork, lining_m);
}

PipeSoundParams ResolvePipeSound(const PipeSoundParams& pipe, const NetworkSoundParams& network) {
  const auto choose = [](const std::string& own, const std::string& of_all) {
    return own == kNetwork ? of_all : own;
  };
  return {choose(pipe.wave_law, network.wave_law), choose(pipe.soil, network.soil),
          choose(pipe.lining, network.lining), pipe.lining_m.value_or(network.lining_m)};
}

acoustics::PipeSection MakePipeSection(double bore_diameter_m, double wall_thickness_m,
                                       const WallMaterial& wall, const PipeSoundParams& sound) {
  acoustics::PipeSection section{bore_diameter_m, {}, std::nullopt, FindLaw(sound.wave_law)};
  if (sound.lining != kNone) section.layers.push_back({sound.lining_m.value(), FindLining(sound.lining)});
  section.layers.push_back({wall_thickness_m, wall});
  if (sound.soil != kNone) section.soil = FindSoil(sound.soil);
  return section;
}

std::vector<std::string_view> SoilNames() { return ListNames(Soils()); }
std::vector<std::string_view> LiningNames() { return ListNames(Linings()); }
const acoustics::Soil& FindSoil(std::string_view name) { return Find(Soils(), name); }
const WallMaterial& FindLining(std::string_view name) { return Find(Linings(), name); }

}  // namespace piperun::scenarios
