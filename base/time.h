#pragma once

#include <chrono>
#include <cstdint>

namespace piperun {

using Duration = std::chrono::nanoseconds;

/// The simulator's own time, exact. Zero is the instant the ball is released.
struct TrueClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TrueClock>;
  static constexpr bool is_steady = true;
};

/// Time as the ball's electronics believe it. Every stamp of a measurement is a RobotTime.
struct RobotClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<RobotClock>;
  static constexpr bool is_steady = true;
};

using TrueTime = TrueClock::time_point;
using RobotTime = RobotClock::time_point;

constexpr double Seconds(Duration d) { return static_cast<double>(d.count()) * 1e-9; }
constexpr double Seconds(TrueTime t) { return Seconds(t.time_since_epoch()); }
constexpr double Seconds(RobotTime t) { return Seconds(t.time_since_epoch()); }
/// Nearest nanosecond to `seconds`. Range: |seconds| < 9.2e9.
Duration FromSeconds(double seconds);

/// A sampling rate, kept as an integer number of micro-hertz so that sample times are exact integers.
class Rate {
 public:
  /// Range: 1e-6 to 1e9 Hz; aborts outside, check user input first.
  explicit Rate(double hertz);
  double Hz() const { return static_cast<double>(micro_Hz_) * 1e-6; }
  std::int64_t micro_Hz() const { return micro_Hz_; }
  /// 1/rate in seconds.
  double Period_s() const { return 1e6 / static_cast<double>(micro_Hz_); }
  /// The period where it is a whole number of nanoseconds, as for most rates; else 0.
  std::int64_t whole_period_ns() const { return whole_period_ns_; }
  friend bool operator==(Rate, Rate) = default;

 private:
  std::int64_t micro_Hz_ = 0;
  std::int64_t whole_period_ns_ = 0;
};

namespace internal {
Duration RoundedSampleOffset(std::int64_t k, Rate rate);
}

/// Time of sample k after sample 0: k / rate rounded to the nearest nanosecond. Never accumulates.
inline Duration SampleOffset(std::int64_t k, Rate rate) {
  std::int64_t whole = 0;
  if (rate.whole_period_ns() > 0 && !__builtin_mul_overflow(k, rate.whole_period_ns(), &whole)) {
    return Duration(whole);
  }
  return internal::RoundedSampleOffset(k, rate);
}
inline TrueTime SampleTime(std::int64_t k, Rate rate) { return TrueTime(SampleOffset(k, rate)); }

/// The only converter between the two clocks: robot = true + offset + drift * true, drift > -1.
struct ClockModel {
  Duration offset{0};
  double drift_ppm = 0;  ///< positive: the robot's clock runs fast
  RobotTime ToRobot(TrueTime t) const;
  /// Inverse of ToRobot: ToTrue(ToRobot(t)) is t, to within the nanosecond that rounding may cost.
  TrueTime ToTrue(RobotTime t) const;
};

}  // namespace piperun
