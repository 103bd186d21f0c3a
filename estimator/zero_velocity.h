#pragma once

#include <array>
#include <optional>

#include "base/params.h"
#include "estimator/biquad.h"
#include "estimator/invert_track.h"
#include "estimator/position_filter.h"

namespace piperun::estimator {

struct ZeroVelocityParams {
  double band_low_Hz = 1;
  double band_high_Hz = 5;
  double threshold_m_s2 = 0.05;
  double still_s = 0.2;
  std::optional<double> speed_gate_m_s = 0.15;
  bool remove_drift = true;
  double drift_acceleration_sd_m_s2 = 0.02;
  double motion_acceleration_sd_m_s2 = 1;

  void Visit(ParamVisitor& v);
};

/// Tells rest from motion by the accelerometer alone (thesis, section 5.3): each component of the specific
/// force through a Butterworth band pass (order 2 at each end), which takes out gravity whatever the tilt;
/// the sensor rests when the magnitude has stayed below a threshold for `still_s`. The filters are designed
/// for the rate of the first interval.
class RestDetector {
 public:
  explicit RestDetector(const ZeroVelocityParams& params) : params_(params) {}
  bool Step(const Vector3d& f_S_m_s2, double dt_s);

 private:
  void Design(const Vector3d& f_S_m_s2, double rate_Hz);

  ZeroVelocityParams params_;
  std::array<BiquadCascade, 3> bands_;
  bool designed_ = false;
  double quiet_s_ = 0;
};

/// Position by double integration of acceleration between rests (thesis, section 5.3):
///
///     a = R f - g up,   v += a dt,   p += v dt while moving;   v = 0 at rest
///
/// With `remove_drift`, the velocity left over when a motion ends is taken as the end of a ramp that a
/// constant acceleration error built up, and p is moved back by half of it times the motion's duration. An
/// accelerometer cannot tell rest from steady motion: `speed_gate_m_s` lets only a slow ball come to rest;
/// `none` is the thesis' form. What the detector's delay would miss of a motion's onset has been integrated
/// meanwhile, from at least kOnset_s before it is noticed. Chainage: projection on the map if there is one,
/// else the sum of each motion's straight displacement. Its variance grows with (a_sd T^2 / 2)^2 over each
/// motion of duration T.
class ZeroVelocityNavigator final : public PositionFilter {
 public:
  /// Keeps start.map by reference.
  ZeroVelocityNavigator(const ZeroVelocityParams& params, const EstimatorStart& start);
  void Step(const AttitudeStep& step) override;
  const PositionState& state() const override { return state_; }
  bool at_rest() const { return at_rest_; }

 private:
  /// Displacement and velocity gathered since some instant at which the sensor was at rest.
  struct Motion {
    Vector3d p_W = Vector3d::Zero();
    Vector3d v_W_m_s = Vector3d::Zero();
    double duration_s = 0;
    void Step(const Vector3d& a_W_m_s2, double dt_s);
  };
  static constexpr double kOnset_s = 0.3;

  void KeepOnset(const Vector3d& a_W_m_s2, double dt_s);
  void EndMotion();
  void UpdateChainage();
  void Settle();

  ZeroVelocityParams params_;
  double g_m_s2_;
  RestDetector detector_;
  std::optional<InvertTrack> track_;
  PositionState state_;
  double settled_variance_m2_;  // of the motions that have ended
  bool at_rest_ = true;
  Motion motion_;
  Motion young_;  // at rest: candidates for the next motion's onset, the older one in motion_
  Vector3d p_rest_W_;
  double chainage_rest_m_;
};

}  // namespace piperun::estimator
