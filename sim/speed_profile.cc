#include "sim/speed_profile.h"

#include "base/check.h"

namespace piperun::sim {
namespace {

PathPoint EvalRamp(double speed_m_s, double ramp_s, double t_s) {
  const double x = t_s / ramp_s;
  const double x3 = x * x * x;
  return {speed_m_s * ramp_s * x3 * x * (2.5 + x * (x - 3)), speed_m_s * x3 * (10 + x * (6 * x - 15)),
          speed_m_s / ramp_s * 30 * x * x * (1 - x) * (1 - x)};
}

}  // namespace

SpeedProfile::SpeedProfile(double distance_m, double speed_m_s, double ramp_s)
    : distance_m_(distance_m), speed_m_s_(speed_m_s), ramp_s_(ramp_s) {
  Demand(speed_m_s > 0 && ramp_s > 0 && Fits(distance_m, speed_m_s, ramp_s),
         "a speed profile needs its ramps");
}

PathPoint SpeedProfile::Eval(double t_s) const {
  const double left_s = duration_s() - t_s;
  if (t_s <= 0) return {};
  if (left_s <= 0) return {distance_m_, 0, 0};
  if (t_s < ramp_s_) return EvalRamp(speed_m_s_, ramp_s_, t_s);
  if (left_s < ramp_s_) {
    const PathPoint end = EvalRamp(speed_m_s_, ramp_s_, left_s);
    return {distance_m_ - end.s_m, end.v_m_s, -end.a_m_s2};
  }
  return {speed_m_s_ * (t_s - 0.5 * ramp_s_), speed_m_s_, 0};
}

}  // namespace piperun::sim
