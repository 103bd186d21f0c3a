#pragma once

#include <optional>

#include "base/params.h"
#include "estimator/biquad.h"
#include "estimator/invert_track.h"
#include "estimator/position_filter.h"

namespace piperun::estimator {

struct ZeroVelocityParams {
  double corner_Hz = 2;
  double threshold_m_s2 = 0.03;
  double still_s = 0.2;
  std::optional<double> speed_gate_m_s = 0.15;
  bool remove_drift = true;
  double drift_acceleration_sd_m_s2 = 0.02;

  void Visit(ParamVisitor& v);
};

/// Tells rest from motion by the accelerometer alone (thesis, section 5.3): the magnitude of the acceleration
/// in W, low-passed by a Butterworth filter of order 2, below a threshold for `still_s`. The filter is
/// designed for the rate of the first interval.
class RestDetector {
 public:
  explicit RestDetector(const ZeroVelocityParams& params) : params_(params) {}
  bool Step(double acceleration_m_s2, double dt_s);

 private:
  ZeroVelocityParams params_;
  std::optional<BiquadCascade> low_pass_;
  double quiet_s_ = 0;
};

/// Position by double integration of acceleration between rests (thesis, section 5.3):
///
///     a = R f - g up,   v += a dt,   p += v dt while moving;   v = 0 at rest
///
/// With `remove_drift`, the velocity left over when a motion ends is taken as the end of a ramp that a
/// constant acceleration error built up, and p is moved back by half of it times the motion's duration. An
/// accelerometer cannot tell rest from steady motion: `speed_gate_m_s` lets only a slow ball come to rest;
/// `none` is the thesis' form. What the filter's delay would miss of a motion's onset is kept in a velocity
/// that forgets over `still_s` while at rest. Chainage: projection on the map if there is one, else the
/// length of the path. Its variance grows with (a_sd T^2 / 2)^2 over each motion of duration T.
class ZeroVelocityNavigator final : public PositionFilter {
 public:
  /// Keeps start.map by reference.
  ZeroVelocityNavigator(const ZeroVelocityParams& params, const EstimatorStart& start);
  void Step(const AttitudeStep& step) override;
  const PositionState& state() const override { return state_; }
  bool at_rest() const { return at_rest_; }

 private:
  void Move(const AttitudeStep& step, const Vector3d& a_W_m_s2);
  void EndMotion();
  void UpdateChainage();

  ZeroVelocityParams params_;
  double g_m_s2_;
  RestDetector detector_;
  std::optional<InvertTrack> track_;
  PositionState state_;
  double settled_variance_m2_;  // of the motions that have ended
  bool at_rest_ = true;
  Vector3d onset_v_W_m_s_ = Vector3d::Zero();
  double moving_s_ = 0;
  Vector3d p_rest_W_;  // where the present motion began
  double chainage_rest_m_;
  double path_m_ = 0;  // length of the present motion
};

}  // namespace piperun::estimator
