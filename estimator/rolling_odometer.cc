#include "estimator/rolling_odometer.h"

#include <cmath>

namespace piperun::estimator {
namespace {

constexpr double kCourseMemory_m = 0.01;
constexpr double kSlackSigmas = 3, kSlack_m = 0.05;
constexpr double kCourseKnown_m = 0.005;  // of displacement remembered

}  // namespace

void RollingParams::Visit(ParamVisitor& v) {
  v.Number({"slip_sd", "Assumed slip as a fraction of the distance rolled, one sigma."}, Range::Between(0, 1),
           slip_sd);
  v.Number({"slip_correlation_m", "Distance over which slip stays the same."}, Range::Positive(),
           slip_correlation_m);
}

RollingOdometer::RollingOdometer(const RollingParams& params, const EstimatorStart& start)
    : params_(params),
      radius_m_(start.ball_radius_m),
      relative_radius_sd_(start.ball_radius_sd_m / start.ball_radius_m),
      p_start_W_(start.p_W),
      start_variance_m2_(start.chainage_sd_m * start.chainage_sd_m) {
  state_.p_W = start.p_W;
  state_.chainage_m = start.chainage_m;
  state_.chainage_sd_m = start.chainage_sd_m;
  if (start.map) track_.emplace(*start.map, start.ball_radius_m);
}

void RollingOdometer::Step(const AttitudeStep& step) {
  const double ds_m = Advance(step);
  state_.chainage_m += ds_m;
  UpdateVariance(step, ds_m);
}

double RollingOdometer::Advance(const AttitudeStep& step) {
  const InvertPoint here = track_ ? track_->Eval(state_.chainage_m)
                                  : InvertPoint{state_.p_W, Vector3d::UnitX(), Vector3d::UnitZ()};
  const Vector3d roll_W = radius_m_ * step.rotation_W_rad.cross(here.normal_W);
  const Vector3d before_W = recent_W_;  // without this step, so that noise at rest does not count itself
  recent_W_ = std::exp(-roll_W.norm() / kCourseMemory_m) * recent_W_ + roll_W;
  if (track_) {
    const double slack_m = kSlackSigmas * state_.chainage_sd_m + kSlack_m;
    const Vector3d along_W = track_->FindTangent(state_.chainage_m, slack_m, before_W);
    const double ds_m = roll_W.dot(along_W) / here.stretch;
    state_.p_W = track_->Eval(state_.chainage_m + ds_m).p_W;
    state_.v_W_m_s = (ds_m * here.stretch / step.dt_s) * here.tangent_W;
    return ds_m;
  }
  state_.p_W += roll_W;
  state_.v_W_m_s = roll_W / step.dt_s;
  const double length_m = before_W.norm();
  return length_m > 0 ? roll_W.dot(before_W) / length_m : roll_W.norm();
}

void RollingOdometer::UpdateVariance(const AttitudeStep& step, double ds_m) {
  distance_m_ += ds_m;
  slip_variance_m2_ += 2 * params_.slip_sd * params_.slip_sd * params_.slip_correlation_m * std::abs(ds_m);
  heading_loss_m_ += (1 - std::exp(-0.5 * step.heading_variance_rad2)) * ds_m;
  const double radius_m = relative_radius_sd_ * distance_m_;
  state_.chainage_sd_m =
      std::sqrt(start_variance_m2_ + radius_m * radius_m + slip_variance_m2_ +
                radius_m_ * radius_m_ * step.tilt_variance_rad2 + 2 * heading_loss_m_ * heading_loss_m_);
}

void RollingOdometer::Turn(const Quaterniond& by_W) {
  recent_W_ = by_W * recent_W_;
  if (!track_) state_.p_W = p_start_W_ + by_W * (state_.p_W - p_start_W_);
}

std::optional<Vector3d> RollingOdometer::Course_W() const {
  const Vector3d horizontal(recent_W_.x(), recent_W_.y(), 0);
  if (horizontal.norm() < kCourseKnown_m) return std::nullopt;
  return horizontal.normalized();
}

}  // namespace piperun::estimator
