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
  if (!start.map) return;
  track_.emplace(*start.map, start.ball_radius_m);
  here_ = track_->Eval(start.chainage_m);
  state_.p_W = here_.p_W;
}

void RollingOdometer::Step(const AttitudeStep& step) {
  const Vector3d roll_W = radius_m_ * step.rotation_W_rad.cross(here_.normal_W);
  const double ds_m = track_ ? AdvanceOnMap(roll_W) : AdvanceFreely(roll_W);
  state_.v_W_m_s = (track_ ? ds_m * here_.stretch * here_.tangent_W : roll_W) / step.dt_s;
  state_.chainage_m += ds_m;
  // only now, so that noise at rest does not count itself
  recent_W_ = std::exp(-roll_W.norm() / kCourseMemory_m) * recent_W_ + roll_W;
  UpdateVariance(step, ds_m);
}

double RollingOdometer::AdvanceOnMap(const Vector3d& roll_W) {
  const double slack_m = kSlackSigmas * state_.chainage_sd_m + kSlack_m;
  const double ds_m = roll_W.dot(track_->FindTangent(state_.chainage_m, slack_m, recent_W_)) / here_.stretch;
  here_ = track_->Eval(state_.chainage_m + ds_m);
  state_.p_W = here_.p_W;
  return ds_m;
}

double RollingOdometer::AdvanceFreely(const Vector3d& roll_W) {
  state_.p_W += roll_W;
  const double length_m = recent_W_.norm();
  return length_m > 0 ? roll_W.dot(recent_W_) / length_m : roll_W.norm();
}

void RollingOdometer::UpdateVariance(const AttitudeStep& step, double ds_m) {
  distance_m_ += ds_m;
  slip_variance_m2_ += 2 * params_.slip_sd * params_.slip_sd * params_.slip_correlation_m * std::abs(ds_m);
  if (track_) heading_loss_m_ += (1 - std::exp(-0.5 * step.heading_variance_rad2)) * ds_m;
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
