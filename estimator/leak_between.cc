#include "estimator/leak_between.h"

#include <cmath>

#include "base/check.h"

namespace piperun::estimator {
namespace {

/// A place by the time that sound takes to it from a.
struct TimedPlace {
  double from_a_m = 0;
  double speed_m_s = 0;
};

TimedPlace FindPlace(const SoundWay& way, double time_s) {
  double begin_m = 0;
  for (std::size_t i = 0;; ++i) {
    const SoundStretch& stretch = way.stretches[i];
    const double stretch_s = stretch.length_m / stretch.speed_m_s;
    if (time_s <= stretch_s || i + 1 == way.stretches.size())
      return {begin_m + time_s * stretch.speed_m_s, stretch.speed_m_s};
    time_s -= stretch_s;
    begin_m += stretch.length_m;
  }
}

}  // namespace

double CalcLength_m(const SoundWay& way) {
  double sum = 0;
  for (const SoundStretch& stretch : way.stretches) sum += stretch.length_m;
  return sum;
}

double CalcTravelTime_s(const SoundWay& way) {
  double sum = 0;
  for (const SoundStretch& stretch : way.stretches) sum += stretch.length_m / stretch.speed_m_s;
  return sum;
}

LeakBetween LocateBetween(const SoundWay& way, double delay_s, double delay_sd_s) {
  Demand(!way.stretches.empty(), "a way has a stretch");
  const TimedPlace place = FindPlace(way, 0.5 * (CalcTravelTime_s(way) - delay_s));
  const double by_speed_m = delay_s * place.speed_m_s * way.speed_sd;
  const double by_delay_m = place.speed_m_s * delay_sd_s;
  LeakBetween leak;
  leak.from_a_m = place.from_a_m;
  leak.sigma_m = 0.5 * std::hypot(way.length_sd_m, by_speed_m, by_delay_m);
  leak.interval = CalcNormalInterval(leak.from_a_m, leak.sigma_m);
  leak.maybe_beyond_a = leak.interval.low_m <= 0;
  leak.maybe_beyond_b = leak.interval.high_m >= CalcLength_m(way);
  return leak;
}

}  // namespace piperun::estimator
