#include "estimator/imu_step.h"

#include <algorithm>

#include "base/check.h"
#include "base/number.h"

namespace piperun::estimator {
namespace {

constexpr double kGapFactor = 1.5;    // an interval longer than this many nominal ones lost samples
constexpr double kNominalMemory = 8;  // intervals

void Check(const ImuSample& sample, const std::optional<ImuSample>& before) {
  if (!sample.w_WS_S_rad_s.allFinite() || !sample.f_WS_S_m_s2.allFinite()) {
    throw InputError("the IMU sample at " + FormatNumber(Seconds(sample.stamp)) +
                     " s holds a value that is not finite; remove the row");
  }
  if (before && sample.stamp < before->stamp) {
    throw InputError("IMU stamps run backwards, from " + FormatNumber(Seconds(before->stamp)) + " s to " +
                     FormatNumber(Seconds(sample.stamp)) + " s; sort the record by time");
  }
}

}  // namespace

Vector3d CalcRotationVector(const Vector3d& w_before_rad_s, double dt_before_s, const Vector3d& w_rad_s,
                            double dt_s) {
  const double between_s = 0.5 * (dt_before_s + dt_s);
  return w_rad_s * dt_s + (dt_s * dt_s * dt_s / (12 * between_s)) * w_before_rad_s.cross(w_rad_s);
}

std::optional<ImuStep> ImuStepper::Step(const ImuSample& sample) {
  Check(sample, before_);
  if (!before_ || sample.stamp == before_->stamp) {
    if (!before_) before_ = sample;
    return std::nullopt;
  }
  ImuStep step;
  step.dt_s = Seconds(sample.stamp - before_->stamp);
  if (nominal_s_ == 0) nominal_s_ = step.dt_s;
  if (step.dt_s > kGapFactor * nominal_s_) step.missing_s = step.dt_s - nominal_s_;
  nominal_s_ += (std::min(step.dt_s, 2 * nominal_s_) - nominal_s_) / kNominalMemory;

  const double covered_s = step.dt_s - step.missing_s;
  step.w_S_rad_s = sample.w_WS_S_rad_s;
  step.dw_S_rad_s = sample.w_WS_S_rad_s - before_->w_WS_S_rad_s;
  step.f_S_m_s2 = sample.f_WS_S_m_s2;
  step.saturated = sample.flags.saturated;
  if (sample.increments) {
    step.dtheta_S_rad = sample.increments->dtheta_S_rad;
    step.f_S_m_s2 = sample.increments->dv_S_m_s / covered_s;
    step.f_at_begin = true;
  } else if (dt_before_s_ > 0 && step.missing_s == 0) {
    step.dtheta_S_rad = CalcRotationVector(before_->w_WS_S_rad_s, dt_before_s_, step.w_S_rad_s, step.dt_s);
  } else {
    step.dtheta_S_rad = step.w_S_rad_s * covered_s;
  }
  step.dtheta_S_rad += step.missing_s * (step.w_S_rad_s - 0.5 * step.dw_S_rad_s);
  before_ = sample;
  dt_before_s_ = covered_s;
  return step;
}

}  // namespace piperun::estimator
