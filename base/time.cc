#include "base/time.h"

#include <cmath>

#include "base/check.h"

namespace piperun {

Duration FromSeconds(double seconds) {
  Demand(std::abs(seconds) < 9.2e9, "a duration must fit into 64-bit nanoseconds");
  return Duration(std::llround(seconds * 1e9));
}

namespace {

constexpr std::int64_t kNanoPerMicroHz = 1'000'000'000'000'000;

}  // namespace

Rate::Rate(double hertz) {
  Demand(hertz >= 1e-6 && hertz <= 1e9, "a rate lies between 1e-6 and 1e9 Hz");
  micro_Hz_ = std::llround(hertz * 1e6);
  whole_period_ns_ = kNanoPerMicroHz % micro_Hz_ == 0 ? kNanoPerMicroHz / micro_Hz_ : 0;
}

Duration internal::RoundedSampleOffset(std::int64_t k, Rate rate) {
  __extension__ using Wide = __int128;
  const Wide numerator = static_cast<Wide>(k) * kNanoPerMicroHz;
  const Wide denominator = rate.micro_Hz();
  const Wide half = denominator / 2;
  const Wide rounded = (numerator + (numerator >= 0 ? half : -half)) / denominator;
  Demand(rounded == static_cast<std::int64_t>(rounded), "a sample time must fit into 64-bit nanoseconds");
  return Duration(static_cast<std::int64_t>(rounded));
}

RobotTime ClockModel::ToRobot(TrueTime t) const {
  const Duration elapsed = t.time_since_epoch();
  const double drift_ns = static_cast<double>(elapsed.count()) * drift_ppm * 1e-6;
  return RobotTime(elapsed + offset + Duration(std::llround(drift_ns)));
}

TrueTime ClockModel::ToTrue(RobotTime t) const {
  const Duration shifted = t.time_since_epoch() - offset;
  const double scale = drift_ppm * 1e-6;
  const double drift_ns = static_cast<double>(shifted.count()) * (scale / (1 + scale));
  return TrueTime(shifted - Duration(std::llround(drift_ns)));
}

}  // namespace piperun
