#include "estimator/zero_velocity.h"

#include <cmath>

#include "base/check.h"
#include "base/number.h"

namespace piperun::estimator {
namespace {

constexpr double kProjectionReach_m = 3;  // how far along the route the nearest point may jump

}  // namespace

void ZeroVelocityParams::Visit(ParamVisitor& v) {
  v.Number({"band_low_Hz", "Lower corner of the Butterworth band pass on the specific force."},
           Range::Positive(), band_low_Hz);
  v.Number({"band_high_Hz", "Its upper corner; half the IMU's rate must lie above it."}, Range::Positive(),
           band_high_Hz);
  v.Number({"threshold_m_s2", "Below this magnitude of what passes the sensor counts as quiet."},
           Range::Positive(), threshold_m_s2);
  v.Number({"still_s", "It rests when it has been quiet for this long."}, Range::Positive(), still_s);
  v.NumberOr({"speed_gate_m_s", "Faster than this it cannot come to rest."}, Range::Positive(), "none",
             speed_gate_m_s);
  v.Flag({"remove_drift", "Take the velocity left over at the end of a motion out of its path."},
         remove_drift);
  v.Number({"drift_acceleration_sd_m_s2", "Assumed acceleration error while moving, after that."},
           Range::NonNegative(), drift_acceleration_sd_m_s2);
  v.Number({"motion_acceleration_sd_m_s2",
            "Assumed acceleration while moving: how little gravity is then believed."},
           Range::NonNegative(), motion_acceleration_sd_m_s2);
}

void RestDetector::Design(const Vector3d& f_S_m_s2, double rate_Hz) {
  if (!(params_.band_high_Hz < 0.5 * rate_Hz && params_.band_low_Hz < params_.band_high_Hz)) {
    throw InputError("a band from " + FormatNumber(params_.band_low_Hz) + " to " +
                         FormatNumber(params_.band_high_Hz) + " Hz does not fit below half the IMU's " +
                         FormatNumber(rate_Hz) + " Hz",
                     "zero_velocity.band_high_Hz");
  }
  for (int i = 0; i < 3; ++i) {
    BiquadCascade& band = bands_[static_cast<std::size_t>(i)];
    band = ButterworthHighPass(2, params_.band_low_Hz, rate_Hz);
    band.Append(ButterworthLowPass(2, params_.band_high_Hz, rate_Hz));
    band.Settle(f_S_m_s2[i]);
  }
  designed_ = true;
}

bool RestDetector::Step(const Vector3d& f_S_m_s2, double dt_s) {
  if (!designed_) Design(f_S_m_s2, 1 / dt_s);
  Vector3d passed;
  for (int i = 0; i < 3; ++i) passed[i] = bands_[static_cast<std::size_t>(i)].Step(f_S_m_s2[i]);
  quiet_s_ = passed.norm() < params_.threshold_m_s2 ? quiet_s_ + dt_s : 0;
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

void ZeroVelocityNavigator::Motion::Step(const Vector3d& a_W_m_s2, double dt_s) {
  p_W += (v_W_m_s + 0.5 * dt_s * a_W_m_s2) * dt_s;
  v_W_m_s += a_W_m_s2 * dt_s;
  duration_s += dt_s;
}

void ZeroVelocityNavigator::Step(const AttitudeStep& step) {
  const Vector3d a_W_m_s2 = step.f_W_m_s2 - g_m_s2_ * Vector3d::UnitZ();
  const bool quiet = detector_.Step(step.f_S_m_s2, step.dt_s);
  const bool slow = !params_.speed_gate_m_s || motion_.v_W_m_s.norm() < *params_.speed_gate_m_s;
  motion_.Step(a_W_m_s2, step.dt_s);
  if (at_rest_ && quiet) return KeepOnset(a_W_m_s2, step.dt_s);
  at_rest_ = false;
  state_.p_W = p_rest_W_ + motion_.p_W;
  state_.v_W_m_s = motion_.v_W_m_s;
  if (quiet && slow) EndMotion();
  UpdateChainage();
  if (at_rest_) Settle();
}

void ZeroVelocityNavigator::KeepOnset(const Vector3d& a_W_m_s2, double dt_s) {
  young_.Step(a_W_m_s2, dt_s);
  if (young_.duration_s < kOnset_s) return;
  motion_ = young_;
  young_ = {};
}

void ZeroVelocityNavigator::EndMotion() {
  at_rest_ = true;
  if (params_.remove_drift) motion_.p_W -= 0.5 * motion_.duration_s * motion_.v_W_m_s;
  state_.p_W = p_rest_W_ + motion_.p_W;
  state_.v_W_m_s.setZero();
}

void ZeroVelocityNavigator::UpdateChainage() {
  state_.chainage_m = track_ ? track_->Project(state_.p_W, state_.chainage_m, kProjectionReach_m)
                             : chainage_rest_m_ + motion_.p_W.norm();
  const double sd_m = 0.5 * params_.drift_acceleration_sd_m_s2 * motion_.duration_s * motion_.duration_s;
  state_.chainage_sd_m = std::sqrt(settled_variance_m2_ + sd_m * sd_m);
}

void ZeroVelocityNavigator::Settle() {
  settled_variance_m2_ = state_.chainage_sd_m * state_.chainage_sd_m;
  p_rest_W_ = state_.p_W;
  chainage_rest_m_ = state_.chainage_m;
  motion_ = {};
  young_ = {};
}

}  // namespace piperun::estimator
