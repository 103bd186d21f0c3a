#pragma once

#include <optional>

#include "base/pose.h"
#include "estimator/imu_step.h"

namespace piperun::estimator {

/// Normalised innovation squared z^T S^-1 z of one measurement.
struct Nis {
  double value = 0;
  int dof = 0;
};

/// Attitude of the sensor frame S in W from gyro, accelerometer and magnetometer.
class AttitudeFilter {
 public:
  virtual ~AttitudeFilter() = default;
  /// Takes the tilt from one specific force, as of a sensor at rest; the heading is arbitrary.
  virtual void AlignTilt(const Vector3d& f_S_m_s2) = 0;
  virtual void Propagate(const ImuStep& step) = 0;
  /// Specific force of the step just propagated, freed of lever-arm terms, of a body whose own acceleration
  /// has the given standard deviation.
  virtual void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) = 0;
  /// Magnetic flux density in the frame S that Exp(ahead) turns the present one into. False: not believed.
  virtual bool UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) = 0;
  /// Heading known otherwise: the attitude should be turned by `offset_rad` about the vertical.
  virtual void UpdateHeading(double offset_rad, double sd_rad) = 0;
  /// Mean gyro reading of a sensor known to rest, over `duration_s`.
  virtual void UpdateRestRate(const Vector3d& w_S_rad_s, double duration_s) = 0;

  virtual const Quaterniond& q_WS() const = 0;
  virtual const Vector3d& gyro_bias_S_rad_s() const = 0;
  /// Of the error rotation in W.
  virtual Matrix3d Covariance_W_rad2() const = 0;
  /// Rate of S in W, corrected, in S, over the step last propagated.
  virtual const Vector3d& w_S_rad_s() const = 0;
  virtual const std::optional<Nis>& nis() const = 0;
};

}  // namespace piperun::estimator
