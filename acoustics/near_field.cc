#include "acoustics/near_field.h"

#include <algorithm>
#include <cmath>

namespace piperun::acoustics {
namespace {

constexpr double kRangeOfCutOn = 0.43;
constexpr double kFirstTransverseMode = 1.8412;  // k a at cut-on

}  // namespace

double CalcNearField(const PipeWave& wave, double z_m, double f_Hz) {
  const double ka = kFirstTransverseMode * std::min(kRangeOfCutOn, f_Hz / wave.cut_on_Hz);
  return ka * ka * CalcNearFieldFading(wave.bore_radius_m, z_m);
}

double CalcNearFieldFading(double bore_radius_m, double z_m) {
  const double a_m = bore_radius_m, widths = z_m / (0.15 * 2 * a_m);
  return a_m * a_m / (a_m * a_m + z_m * z_m) * std::exp(-widths * widths);
}

}  // namespace piperun::acoustics
