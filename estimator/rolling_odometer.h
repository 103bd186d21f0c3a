#pragma once

#include <optional>

#include "base/params.h"
#include "estimator/invert_track.h"
#include "estimator/position_filter.h"

namespace piperun::estimator {

struct RollingParams {
  double slip_sd = 0.001;
  double slip_correlation_m = 1;

  void Visit(ParamVisitor& v);
};

/// Position of a ball that rolls without slipping, from its attitude: v = w x r n = r (w x n), n the wall's
/// normal at the contact (the rolling-ball paper of sources B has n = up).
///
/// The rotation used is that of the *corrected* attitude, R_k R_(k-1)^T, not the gyro's: gravity turns once
/// through the body per revolution, so the accelerometer counts revolutions and neither scale factor nor bias
/// of the spin axis leaves an error that grows with distance. What remains is r times the tilt error.
/// With a map the chainage advances by r (rotation x n) . t / stretch and the position is the map's invert; t
/// is the map's tangent within three sigma of the chainage that is closest to the direction of rolling, so
/// that a chainage a little behind does not stop the count at a bend. Without a map n = up, the position is
/// dead-reckoned in the horizontal plane, and the chainage advances by the component along the course (the
/// direction of the last centimetre): a ball that rolls back counts back, and noise at rest does not count.
/// Variance of the chainage: start + (distance sd_r / r)^2 + slip + (r tilt)^2 + heading, where slip is a
/// fraction of distance with given sd and correlation length L (variance 2 sd^2 L distance, exact for
/// distance >> L), and, with a map, a heading error psi shortens the projection by 1 - cos psi of the
/// distance.
class RollingOdometer final : public PositionFilter {
 public:
  /// Keeps start.map by reference.
  RollingOdometer(const RollingParams& params, const EstimatorStart& start);

  void Step(const AttitudeStep& step) override;
  const PositionState& state() const override { return state_; }
  /// The heading so far turns out to have been wrong: turns what was dead-reckoned with it about the start.
  void Turn(const Quaterniond& by_W);
  /// Horizontal direction in which the ball has been rolling lately; nothing while it hardly moves.
  std::optional<Vector3d> Course_W() const;

 private:
  /// Both return the signed distance along the route or course.
  double AdvanceOnMap(const Vector3d& roll_W);
  double AdvanceFreely(const Vector3d& roll_W);
  void UpdateVariance(const AttitudeStep& step, double ds_m);

  RollingParams params_;
  double radius_m_;
  double relative_radius_sd_;
  std::optional<InvertTrack> track_;
  /// Where the ball touches; without a map always upright.
  InvertPoint here_{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ()};
  PositionState state_;
  Vector3d p_start_W_;
  double start_variance_m2_;
  double distance_m_ = 0;
  double slip_variance_m2_ = 0;
  double heading_loss_m_ = 0;
  Vector3d recent_W_ = Vector3d::Zero();  // displacement, forgotten over kCourseMemory_m
};

}  // namespace piperun::estimator
