#include "acoustics/sounding_times.h"

#include <cmath>
#include <numbers>

namespace piperun::acoustics {
namespace {

double CalcFade(double into_s, double ramp_s) {
  if (into_s <= 0) return 0;
  return into_s >= ramp_s ? 1 : std::sin(0.5 * std::numbers::pi * into_s / ramp_s);
}

}  // namespace

double CalcAmplitudeShare(const SoundingTimes& times, TrueTime t) {
  const double t_s = Seconds(t);
  return CalcFade(t_s - times.on_s, times.ramp_s) * CalcFade(times.off_s - t_s, times.ramp_s);
}

double CalcPowerShare(const SoundingTimes& times, TrueTime t) {
  const double share = CalcAmplitudeShare(times, t);
  return share * share;
}

}  // namespace piperun::acoustics
