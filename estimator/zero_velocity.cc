#include "estimator/zero_velocity.h"

#include <algorithm>
#include <cmath>

namespace piperun::estimator {
namespace {

constexpr double kProjectionReach_m = 3;  // how far along the route the nearest point may jump

}  // namespace

void ZeroVelocityParams::Visit(ParamVisitor& v) {
  v.Number({"corner_Hz", "Corner of the Butterworth low pass on the specific force."}, Range::Positive(),
           corner_Hz);
  v.Number({"threshold_m_s2", "Below this deviation from gravity the ball counts as quiet."},
           Range::Positive(), threshold_m_s2);
  v.Number({"still_s", "It rests when it has been quiet for this long."}, Range::Positive(), still_s);
  v.NumberOr({"speed_gate_m_s", "Faster than this it cannot come to rest."}, Range::Positive(), "none",
             speed_gate_m_s);
  v.Flag({"remove_drift", "Take the velocity left over at the end of a motion out of its path."},
         remove_drift);
  v.Number({"drift_acceleration_sd_m_s2", "Assumed acceleration error while moving, after that."},
           Range::NonNegative(), drift_acceleration_sd_m_s2);
}

bool RestDetector::Step(double acceleration_m_s2, double dt_s) {
  if (!low_pass_) low_pass_ = ButterworthLowPass(2, std::min(params_.corner_Hz, 0.25 / dt_s), 1 / dt_s);
  quiet_s_ = low_pass_->Step(acceleration_m_s2) < params_.threshold_m_s2 ? quiet_s_ + dt_s : 0;
  return quiet_s_ >= params_.still_s;
}

ZeroVelocityNavigator::ZeroVelocityNavigator(const ZeroVelocityParams& params, const EstimatorStart& start)
    : params_(params),
      g_m_s2_(start.gravity_m_s2),
      detector_(params),
      settled_variance_m2_(start.chainage_sd_m * start.chainage_sd_m),
      p_rest_W_(start.p_W),
      chainage_rest_m_(start.chainage_m) {
  state_.p_W = start.p_W;
  state_.chainage_m = start.chainage_m;
  state_.chainage_sd_m = start.chainage_sd_m;
  if (start.map) track_.emplace(*start.map, start.ball_radius_m);
}

void ZeroVelocityNavigator::Step(const AttitudeStep& step) {
  const Vector3d a_W_m_s2 = step.f_W_m_s2 - g_m_s2_ * Vector3d::UnitZ();
  const bool quiet = detector_.Step(a_W_m_s2.norm(), step.dt_s);
  const bool slow = !params_.speed_gate_m_s || state_.v_W_m_s.norm() < *params_.speed_gate_m_s;
  if (at_rest_ && !quiet) {
    at_rest_ = false;
    state_.v_W_m_s = onset_v_W_m_s_;
  }
  if (!at_rest_ && quiet && slow) EndMotion();
  if (at_rest_) {
    onset_v_W_m_s_ = std::exp(-step.dt_s / params_.still_s) * onset_v_W_m_s_ + a_W_m_s2 * step.dt_s;
  } else {
    Move(step, a_W_m_s2);
  }
}

void ZeroVelocityNavigator::Move(const AttitudeStep& step, const Vector3d& a_W_m_s2) {
  const Vector3d dp = (state_.v_W_m_s + 0.5 * step.dt_s * a_W_m_s2) * step.dt_s;
  state_.v_W_m_s += a_W_m_s2 * step.dt_s;
  state_.p_W += dp;
  path_m_ += dp.norm();
  moving_s_ += step.dt_s;
  UpdateChainage();
}

void ZeroVelocityNavigator::EndMotion() {
  if (params_.remove_drift) {
    const double before_m = (state_.p_W - p_rest_W_).norm();
    state_.p_W -= 0.5 * moving_s_ * state_.v_W_m_s;
    if (before_m > 0) path_m_ *= (state_.p_W - p_rest_W_).norm() / before_m;
  }
  state_.v_W_m_s.setZero();
  onset_v_W_m_s_.setZero();
  UpdateChainage();
  settled_variance_m2_ = state_.chainage_sd_m * state_.chainage_sd_m;
  at_rest_ = true;
  moving_s_ = 0;
  path_m_ = 0;
  p_rest_W_ = state_.p_W;
  chainage_rest_m_ = state_.chainage_m;
}

void ZeroVelocityNavigator::UpdateChainage() {
  state_.chainage_m = track_ ? track_->Project(state_.p_W, state_.chainage_m, kProjectionReach_m)
                             : chainage_rest_m_ + path_m_;
  const double sd_m = 0.5 * params_.drift_acceleration_sd_m_s2 * moving_s_ * moving_s_;
  state_.chainage_sd_m = std::sqrt(settled_variance_m2_ + sd_m * sd_m);
}

}  // namespace piperun::estimator
