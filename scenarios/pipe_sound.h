#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acoustics/pipe_section.h"
#include "base/params.h"

namespace piperun::scenarios {

/// How all pipes of a network carry sound, besides their walls.
struct NetworkSoundParams {
  std::string wave_law = "auto";
  std::string soil = "none";
  std::string lining = "none";
  double lining_m = 0.004;
  void Visit(ParamVisitor& v);
};

/// The same of one pipe, where it differs from the network.
struct PipeSoundParams {
  std::string wave_law = "network";
  std::string soil = "network";
  std::string lining = "network";
  std::optional<double> lining_m;  ///< nothing: the network's
  void Visit(ParamVisitor& v);

  friend bool operator==(const PipeSoundParams&, const PipeSoundParams&) = default;
};

/// What counts for a pipe: its own words, and the network's where it has none. Nothing is left to "network".
PipeSoundParams ResolvePipeSound(const PipeSoundParams& pipe, const NetworkSoundParams& network);

/// The cross-section of a pipe whose words have been resolved. A lining lies inside the wall; the bore is
/// that of the water.
acoustics::PipeSection MakePipeSection(double bore_diameter_m, double wall_thickness_m,
                                       const WallMaterial& wall, const PipeSoundParams& sound);

/// Names in the libraries assets/soils/*.yaml and assets/linings/*.yaml, without "none" and "network".
std::vector<std::string_view> SoilNames();
std::vector<std::string_view> LiningNames();
/// By a name that is in the library.
const acoustics::Soil& FindSoil(std::string_view name);
const WallMaterial& FindLining(std::string_view name);

}  // namespace piperun::scenarios
