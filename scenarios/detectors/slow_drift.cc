#include "scenarios/detectors/slow_drift.h"

#include <cmath>
#include <numbers>

namespace piperun::scenarios::detectors {

SlowDrift::SlowDrift(double sd_dB, double length_m, const RandomStream& random)
    : amplitude_dB_(sd_dB * std::sqrt(2.0 / static_cast<double>(waves_.size()))) {
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    waves_[i] = {random.Normals(i, 0)[0] / length_m, 2 * std::numbers::pi * random.Uniforms(i, 1)[0]};
  }
}

double SlowDrift::Eval_dB(double chainage_m) const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::cos(wave.wavenumber_1_m * chainage_m + wave.phase_rad);
  return amplitude_dB_ * sum;
}

}  // namespace piperun::scenarios::detectors
