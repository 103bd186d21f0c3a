#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "acoustics/duct_modes.h"
#include "acoustics/pipe_wave.h"

namespace piperun::acoustics {

/// Up to this X (pipe_wave.h) a wall holds the modes of a rigid one.
inline constexpr double kLargestCompliance = 2;

/// What a higher mode of a hole in the wall adds to the power of the plane wave at the hole: at a distance z
/// along the pipe, `power` exp(-`decay_1_m` |z|) Phi(r)^2,
///
///   power = w Phi(a)^2 |k/k_z|^2,   decay = -2 Im k_z,
///   k_z^2 = k^2 - (j'/a)^2 - 2 i k alpha / (1 - m^2/j'^2),   k = 2 pi f / c_f,   Im k_z < 0,
///
/// modes summed by power: between them lie phases that turn within a fraction of the bore. alpha is the plane
/// wave's loss, taken for an admittance of the wall, which damps a mode more the more it leans on it; it
/// bounds the mode at its cut-on. Below, the mode is evanescent and part of what near_field.h fits: it takes
/// over from there by w, a smoothstep from 0.43 of its cut-on to the cut-on.
///
/// Range: walls that give less than the water does, X <= kLargestCompliance: iron, steel, copper, cement and
/// concrete. In plastic (X of 10 and more) the wall is soft at these frequencies, its modes are others, and
/// nothing is added. A straight pipe: bends, tees and joints mix the modes.
struct ModeWave {
  double power = 0;
  double decay_1_m = 0;
};
ModeWave CalcModeWave(const PipeWave& wave, const DuctMode& mode, double f_Hz);

/// The sum over all modes that reach at least 0.43 of their cut-on, j' up to kLargestRoot, at a place r from
/// the axis (mean over the angle). 0 up to 0.43 of the first cut-on and in soft walls.
double CalcHigherModes(const PipeWave& wave, double r_over_a, double z_m, double f_Hz);

/// The same on the bins of a frame, the mean over each bin, tabulated over the distance.
class HigherModeTable {
 public:
  HigherModeTable(const PipeWave& wave, double r_over_a, double bin_width_Hz, std::size_t bins);

  /// Adds share * at_hole[k] * n(z) to psd. Linear between distances that are 10 % apart; nothing from 480
  /// radii on. Does not allocate.
  void AddTo(std::span<float> psd, std::span<const float> at_hole, double z_m, float share) const;

 private:
  void AddMode(const PipeWave& wave, const DuctMode& mode, double shape, double bin_width_Hz);
  void AddWave(const ModeWave& wave, double share, std::size_t bin);

  double radius_m_ = 0;
  std::size_t first_bin_ = 0;
  std::vector<std::vector<float>> rows_;  // n by distance, then by bin from first_bin_ on; empty: no modes
};

}  // namespace piperun::acoustics
