#pragma once

#include "estimator/attitude_ekf.h"

namespace piperun::estimator {

/// The quaternion EKF as Akkaya & Talu (2017) print it, eqs 6-13, kept for comparison.
///
/// State x = [q0 q1 q2 q3, b], both additive; q <- q + 1/2 Omega(w - b) q dt, then normalised; start
/// q = [1 0 0 0]. Measurement, with h derived here because eq. 11 carries slips (the second component's sign
/// and the fourth one's denominator):
///
///     h(x) = [2(q1 q3 - q0 q2), 2(q2 q3 + q0 q1), q0^2 - q1^2 - q2^2 + q3^2,
///             atan2(2(q1 q2 + q0 q3), q0^2 + q1^2 - q2^2 - q3^2)]
///
/// against the specific force over g and the magnetic yaw, levelled by roll = atan(a_y / sqrt(a_x^2 + a_z^2))
/// and pitch = -atan(a_x / sqrt(a_y^2 + a_z^2)) of eqs 6 and 7.
/// What is wrong with it: both arc tangents stay within a quarter turn, so the yaw is levelled onto the wrong
/// side as soon as the sensor is upside down, and a rolling ball is so half of the time; the roll is exact
/// only at zero pitch; the Euler step loses (w dt)^3 / 12 per sample; the covariance is singular along q.
/// Range: slow motion with less than a quarter turn of tilt.
class PrintedEkf final : public AttitudeFilter {
 public:
  PrintedEkf(const AttitudeParams& params, double gravity_m_s2, const Vector3d& field_W_T);

  void AlignTilt(const Vector3d&) override {}  // the paper starts at [1 0 0 0]
  void Propagate(const ImuStep& step) override;
  void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) override;
  bool UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) override;
  void UpdateHeading(double, double) override {}
  void UpdateRestRate(const Vector3d&, double) override {}

  const Quaterniond& q_WS() const override { return q_WS_; }
  const Vector3d& gyro_bias_S_rad_s() const override { return bias_S_; }
  Matrix3d Covariance_W_rad2() const override;
  const Vector3d& w_S_rad_s() const override { return w_S_; }
  const std::optional<Nis>& nis() const override { return nis_; }

 private:
  using Matrix7d = Eigen::Matrix<double, 7, 7>;
  template <int n>
  void Update(const Eigen::Matrix<double, n, 4>& H, const Eigen::Matrix<double, n, 1>& z, double variance);

  AttitudeParams params_;
  double g_m_s2_;
  Vector3d field_W_T_;
  Quaterniond q_WS_ = Quaterniond::Identity();
  Vector3d bias_S_ = Vector3d::Zero();
  Vector3d w_S_ = Vector3d::Zero();
  Vector3d f_S_ = Vector3d::UnitZ();
  Matrix7d P_ = Matrix7d::Zero();
  std::optional<Nis> nis_;
};

}  // namespace piperun::estimator
