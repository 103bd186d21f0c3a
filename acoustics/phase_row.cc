#include "acoustics/phase_row.h"

#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr double kNone = 1e-12;  // of the last bin's turns: rounding

}  // namespace

PhaseRow CalcPhaseRow(const PipeWave& wave, double bin_width_Hz, std::size_t bins) {
  Demand(bins >= 2, "a frame has bins above zero");
  const auto turns_1_m = [&](double bin) {
    return wave.Wavenumber_rad_m(bin * bin_width_Hz).real() / std::numbers::pi;
  };
  const auto last = static_cast<double>(bins - 1);
  PhaseRow row{turns_1_m(last) / last};
  const auto excess_1_m = [&](double bin) { return turns_1_m(bin) - bin * row.turns_1_m; };
  for (std::size_t dispersive = bins; dispersive > 1; --dispersive) {
    const auto k = static_cast<double>(dispersive - 1);
    if (std::abs(excess_1_m(k)) <= kNone * last * row.turns_1_m) continue;
    row.excess_turns_1_m.resize(dispersive, 0), row.slopes.resize(dispersive, 1);
    break;
  }
  for (std::size_t i = 1; i < row.slopes.size(); ++i) {
    const auto k = static_cast<double>(i);
    row.excess_turns_1_m[i] = static_cast<float>(excess_1_m(k));
    row.slopes[i] = static_cast<float>((turns_1_m(k + 0.5) - turns_1_m(k - 0.5)) / row.turns_1_m);
  }
  return row;
}

}  // namespace piperun::acoustics
