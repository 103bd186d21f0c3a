#include "estimator/attitude_iekf.h"

#include <Eigen/LU>
#include <cmath>

namespace piperun::estimator {

Matrix3d CalcLeftJacobian(const Vector3d& phi_rad) {
  const double angle2 = phi_rad.squaredNorm(), angle = std::sqrt(angle2);
  // below 1e-2 rad the series' next terms are under 1e-10
  const bool small = angle2 < 1e-4;
  const double half = std::sin(0.5 * angle);
  const double a = small ? 0.5 - angle2 / 24 : 2 * half * half / angle2;
  const double b = small ? 1.0 / 6 - angle2 / 120 : (angle - std::sin(angle)) / (angle2 * angle);
  const Vector3d& p = phi_rad;
  Matrix3d J = b * p * p.transpose();
  J.diagonal().array() += 1 - b * angle2;
  return J + a * Skew(p);
}

void AttitudeIekf::Propagate(const ImuStep& step) {
  const Vector3d turn_S_rad = CorrectedTurn_S(step);
  const Quaterniond half = ExpSO3(0.5 * turn_S_rad);
  const Matrix3d B = -step.dt_s * (q_WS_.toRotationMatrix() * CalcLeftJacobian(turn_S_rad));
  q_WS_force_ = step.f_at_begin ? q_WS_ : q_WS_ * half;
  q_WS_ = (q_WS_ * half * half).normalized();
  PropagateAttitudeAndBias(step, B);
}

void AttitudeIekf::UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) {
  if (step.AccelerometerClipped()) return;
  using Matrix6x2d = Eigen::Matrix<double, 6, 2>;
  using Eigen::Matrix2d;
  const Eigen::Vector2d z = (q_WS_force_ * step.f_S_m_s2).head<2>() / g_m_s2_;
  double force_variance = CalcForceVariance(params_, step.dt_s - step.missing_s, motion_acceleration_sd_m_s2);
  force_variance += CalcExcessVariance(step.f_S_m_s2.norm(), g_m_s2_, force_variance);

  Matrix6x2d PHt;  // up x xi = (-xi_y, xi_x, 0)
  PHt << -P_.col(1), P_.col(0);
  Matrix2d S;
  S << -PHt.row(1), PHt.row(0);
  S.diagonal().array() += force_variance / (g_m_s2_ * g_m_s2_);
  Matrix2d S_inverse = S.inverse();
  nis_ = Nis{z.dot(S_inverse * z), 2};
  if (nis_->value > gates_.two) {
    S.diagonal().array() += (nis_->value / gates_.two - 1) * S.diagonal().maxCoeff();
    S_inverse = S.inverse();
  }
  const Matrix6x2d K = PHt.lazyProduct(S_inverse);
  TakeOptimal<6, 2>(P_, PHt, K);
  Correct(K * z);
}

}  // namespace piperun::estimator
