#pragma once

#include "base/params.h"
#include "estimator/attitude_filter.h"

namespace piperun::estimator {

/// What the attitude filter assumes of its sensors and of the motion. Assumed, never the truth's own values.
struct AttitudeParams {
  double gyro_noise_rad_s_sqrtHz = 1.75e-4;
  double gyro_bias_sd_rad_s = 2e-3;
  double gyro_bias_walk_rad_s2_sqrtHz = 1e-5;
  double gyro_scale_sd = 1.5e-3;
  double accelerometer_noise_m_s2_sqrtHz = 2e-3;
  double motion_acceleration_sd_m_s2 = 0.05;
  double motion_correlation_s = 0.1;
  double magnetometer_sd_T = 0.5e-6;
  double field_tolerance = 0.2;
  double nis_gate = 13.8;

  void Visit(ParamVisitor& v);
};

/// Error-state (multiplicative) extended Kalman filter on the unit quaternion.
///
/// Nominal state: q_WS, gyro bias b and scale-factor errors s (one per axis). Error state, nine numbers:
/// dtheta in W with R_true = Exp(dtheta) R, then db, ds. With the measured rate w_m = (1 + s) w + b + n:
///
///     R_k = R_(k-1) Exp(dtheta_m - b dt - s * w dt)
///     d(dtheta)/dt = -R db - R diag(w) ds - R n         db/dt = random walk        ds/dt = 0
///
/// Because the error lives in W, both vector measurements read it directly:
///
///     gravity:  R f_S = g up - dtheta x g up  ->  two numbers, dtheta_x and dtheta_y
///     field:    psi_ref - psi(R m_S) = dtheta_z - m_z (m_x dtheta_x + m_y dtheta_y) / m_h^2
///
/// The heading measurement may change only dtheta_z and the bias about the vertical of the moment, so that no
/// magnetic disturbance tilts the attitude (through the bias of a rolling ball a sustained one does, by less
/// than a fiftieth of the heading error); its covariance update is Joseph's, which holds for any gain.
/// Gravity's noise is white noise of the accelerometer plus the motion's own acceleration (sd and correlation
/// time, as an equivalent white density), plus (|f| - g)^2 beyond three sigma. A gravity innovation beyond
/// the gate is weighted down until its NIS equals the gate, so the filter cannot lock itself out; a magnetic
/// one is discarded. Range: |w| dt < 1 rad. Covariances are exact to first order in dtheta.
class AttitudeEkf final : public AttitudeFilter {
 public:
  /// `field_W_T` zero: no magnetic reference.
  AttitudeEkf(const AttitudeParams& params, double gravity_m_s2, const Vector3d& field_W_T);

  void AlignTilt(const Vector3d& f_S_m_s2) override;
  void Propagate(const ImuStep& step) override;
  void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) override;
  bool UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) override;
  void UpdateHeading(double offset_rad, double sd_rad) override;
  void UpdateRestRate(const Vector3d& w_S_rad_s, double duration_s) override;

  const Quaterniond& q_WS() const override { return q_WS_; }
  const Vector3d& gyro_bias_S_rad_s() const override { return bias_S_; }
  const Vector3d& gyro_scale_error() const { return scale_; }
  Matrix3d Covariance_W_rad2() const override { return P_.topLeftCorner<3, 3>(); }
  const Vector3d& w_S_rad_s() const override { return w_S_; }
  const std::optional<Nis>& nis() const override { return nis_; }

 private:
  using Vector9d = Eigen::Matrix<double, 9, 1>;
  using Matrix9d = Eigen::Matrix<double, 9, 9>;

  /// Of one direction component, from an interval's mean specific force.
  double GravityVariance(double interval_s, double motion_sd_m_s2) const;
  void PropagateCovariance(const ImuStep& step);
  /// One scalar measurement of error component i: updates P, returns the correction.
  Vector9d UpdateComponent(int i, double z, double variance);
  /// One scalar measurement z = h . (dtheta) that may only turn about the vertical.
  void UpdateVertical(const Vector3d& h, double z, double variance);
  /// P after a gain K for a measurement row with P h = Ph and innovation variance S (Joseph's form).
  void JosephUpdate(const Vector9d& K, const Vector9d& Ph, double S);
  void Correct(const Vector9d& dx);

  AttitudeParams params_;
  double g_m_s2_;
  Vector3d field_W_T_;
  Quaterniond q_WS_ = Quaterniond::Identity();
  Quaterniond q_WS_mid_ = Quaterniond::Identity();  // in the middle of the last step
  Quaterniond q_WS_begin_ = Quaterniond::Identity();
  Vector3d bias_S_ = Vector3d::Zero();
  Vector3d scale_ = Vector3d::Zero();
  Vector3d w_S_ = Vector3d::Zero();
  Matrix9d P_ = Matrix9d::Zero();
  std::optional<Nis> nis_;
};

/// Smallest rotation R with R f parallel to up: the attitude of a sensor at rest, up to its heading.
Quaterniond CalcTilt(const Vector3d& f_S_m_s2);

/// Angle wrapped into [-pi, pi].
double WrapAngle(double angle_rad);

}  // namespace piperun::estimator
