#pragma once

#include "estimator/attitude_kalman.h"

namespace piperun::estimator {

/// Multiplicative error-state Kalman filter on SO(3) with gyro bias and an acceleration of the body that
/// lasts (J. Sola, "Quaternion kinematics for the error-state Kalman filter", 2017, chapter 7, global error).
///
/// Nominal state: q_WS, gyro bias b, acceleration a of the body. Error state, nine numbers: R_true =
/// Exp(dtheta) R, db, da, all but db in W. Over a step of rotation vector phi = dtheta_m - b dt:
///
///     R <- R Exp(phi)        dtheta <- dtheta - R Exp(phi/2) dt db - R n
///     b <- b                 db <- db + walk
///     a <- c a               da <- c da + sd sqrt(1 - c^2) w,          c = exp(-dt/tau)
///
/// The acceleration is a first-order Gauss-Markov process whose direction is carried by the gyro: a
/// correction of the attitude turns it, so that it tells nothing of the heading. Measured, the force of the
/// middle of the step brought to its end:
///
///     R f = g up + a + noise,     R f - g up - a = g up x dtheta + da
///
/// With a in the state the errors of successive measurements may be correlated, as those of a motion are. A
/// specific force beyond the chi-square gate has pushed the body: the variance of a grows by |z|^2, z the
/// innovation, so that a takes the force up and the attitude is left alone. While an axis of the gyro is
/// clipped its noise grows (CalcTurnVariance_S); a clipped accelerometer is not listened to. At rest, told by
/// a motion of zero standard deviation, a is zero. Range: |w| dt < 1 rad; covariances to first order in the
/// errors, and to second in phi.
class AttitudeEskf final : public AttitudeKalman<9> {
 public:
  using AttitudeKalman::AttitudeKalman;

  /// The force that is taken for gravity may hold an acceleration: da = -g up x dtheta of the tilt's error.
  void AlignTilt(const Vector3d& f_S_m_s2) override;
  void Propagate(const ImuStep& step) override;
  void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) override;

  /// The body's own.
  const Vector3d& acceleration_W_m_s2() const { return acceleration_W_m_s2_; }

 private:
  static constexpr int kAcceleration = 6;
  using Gain = Eigen::Matrix<double, 9, 3>;

  /// The Gauss-Markov process over the step: its decay and what drives it.
  void PropagateAcceleration(double dt_s, double sd_m_s2);
  void HoldStill();
  /// P H^T of the measurement R f - g up - a.
  Gain CalcCross() const;
  /// H P H^T from it.
  Matrix3d CalcSpread(const Gain& PHt) const;
  void CorrectMore(const State& dx, const Quaterniond& turn_W) override;

  Quaterniond q_WS_force_ = Quaterniond::Identity();  // where the step's specific force is given
  Vector3d acceleration_W_m_s2_ = Vector3d::Zero();
  double decay_dt_s_ = 0, decay_ = 1;  // of the last step's length
};

}  // namespace piperun::estimator
