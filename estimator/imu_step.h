#pragma once

#include <cstdint>
#include <optional>

#include "base/measurement.h"

namespace piperun::estimator {

/// One inertial interval, ready for integration: R_k = R_(k-1) Exp(dtheta).
struct ImuStep {
  double dt_s = 0;                           ///< from the stamps
  double missing_s = 0;                      ///< part of dt that no sample covers (lost samples)
  Vector3d w_S_rad_s = Vector3d::Zero();     ///< mean rate over the interval
  Vector3d dw_S_rad_s = Vector3d::Zero();    ///< its change since the interval before
  Vector3d dtheta_S_rad = Vector3d::Zero();  ///< rotation vector over the interval, biases included
  Vector3d f_S_m_s2 = Vector3d::Zero();      ///< mean specific force
  bool f_at_begin =
      false;  ///< f_S is given in the frame at the beginning of the interval, else in its middle
  std::uint8_t saturated = 0;  ///< axes that met the end of their range, as in ImuFlags

  bool GyroClipped(int axis) const { return (saturated >> axis & 1) != 0; }
  bool AccelerometerClipped() const { return saturated >> 3 != 0; }
};

/// Rotation vector over an interval of length T from the mean rates of this and the preceding interval, for a
/// rate that varies linearly in time: w T + T^3 / (12 h) w_before x w, where h is the distance of the two
/// intervals' middles. With equal intervals this is dtheta + dtheta_before x dtheta / 12 (Bortz 1971; Miller
/// 1983, two-sample form with the preceding interval).
Vector3d CalcRotationVector(const Vector3d& w_before_rad_s, double dt_before_s, const Vector3d& w_rad_s,
                            double dt_s);

/// Turns IMU samples into steps, by their real stamps.
///
/// Rates are coning-compensated; increments, where a sample carries them, are exact by contract and taken as
/// they are. A sample with the stamp of the one before is a duplicate and gives no step. After a gap the rate
/// over the missing part is the mean of the rates on both sides of it. Throws InputError on a stamp that runs
/// backwards and on values that are not finite.
class ImuStepper {
 public:
  /// Nothing for the very first sample (its interval is unknown) and for duplicates.
  std::optional<ImuStep> Step(const ImuSample& sample);

 private:
  std::optional<ImuSample> before_;
  double dt_before_s_ = 0;  // 0: there is no step before
  double nominal_s_ = 0;    // running estimate of the sampling interval
};

}  // namespace piperun::estimator
