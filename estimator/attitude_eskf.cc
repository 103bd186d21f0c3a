#include "estimator/attitude_eskf.h"

#include <Eigen/LU>
#include <cmath>

namespace piperun::estimator {

void AttitudeEskf::AlignTilt(const Vector3d& f_S_m_s2) {
  AttitudeKalman::AlignTilt(f_S_m_s2);
  acceleration_W_m_s2_.setZero();
  Matrix3d from_tilt = Matrix3d::Zero();
  from_tilt(0, 1) = g_m_s2_;
  from_tilt(1, 0) = -g_m_s2_;
  const Matrix3d P_at = from_tilt * Covariance_W_rad2();
  P_.bottomRows<3>().setZero();
  P_.rightCols<3>().setZero();
  P_.bottomLeftCorner<3, 3>() = P_at;
  P_.topRightCorner<3, 3>() = P_at.transpose();
  P_.bottomRightCorner<3, 3>() = P_at * from_tilt.transpose();
}

void AttitudeEskf::Propagate(const ImuStep& step) {
  const Quaterniond half = ExpSO3(0.5 * CorrectedTurn_S(step));
  const Quaterniond q_WS_mid = q_WS_ * half;
  q_WS_force_ = step.f_at_begin ? q_WS_ : q_WS_mid;
  q_WS_ = (q_WS_mid * half).normalized();
  PropagateAttitudeAndBias(step, -step.dt_s * q_WS_mid.toRotationMatrix());
}

void AttitudeEskf::PropagateAcceleration(double dt_s, double sd_m_s2) {
  if (dt_s != decay_dt_s_) {
    decay_dt_s_ = dt_s;
    decay_ = std::exp(-dt_s / params_.motion_correlation_s);
  }
  const double c = decay_;
  acceleration_W_m_s2_ *= c;
  P_.rightCols<3>() *= c;
  P_.bottomRows<3>() *= c;
  P_.diagonal().tail<3>().array() += sd_m_s2 * sd_m_s2 * (1 - c * c);
}

void AttitudeEskf::HoldStill() {
  for (int i = 0; i < 3; ++i) {
    const double variance = P_(kAcceleration + i, kAcceleration + i);
    if (!(variance > 0)) continue;
    const State K = P_.col(kAcceleration + i) / variance;
    TakeSymmetric<9, 1>(P_, 0.5 * variance * K, K);
    Correct(K * -acceleration_W_m_s2_[i]);
  }
  P_.rightCols<3>().setZero();
  P_.bottomRows<3>().setZero();
  acceleration_W_m_s2_.setZero();
}

AttitudeEskf::Gain AttitudeEskf::CalcCross() const {
  Gain PHt = P_.rightCols<3>();
  PHt.col(0) -= g_m_s2_ * P_.col(1);
  PHt.col(1) += g_m_s2_ * P_.col(0);
  return PHt;
}

Matrix3d AttitudeEskf::CalcSpread(const Gain& PHt) const {
  Matrix3d S = PHt.bottomRows<3>();
  S.row(0) -= g_m_s2_ * PHt.row(1);
  S.row(1) += g_m_s2_ * PHt.row(0);
  return S;
}

void AttitudeEskf::UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) {
  if (motion_acceleration_sd_m_s2 > 0) {
    PropagateAcceleration(step.dt_s, motion_acceleration_sd_m_s2);
  } else {
    HoldStill();
  }
  if (step.AccelerometerClipped()) return;
  Vector3d z = q_WS_force_ * step.f_S_m_s2 - acceleration_W_m_s2_;
  z.z() -= g_m_s2_;

  Gain PHt = CalcCross();
  Matrix3d S = CalcSpread(PHt);
  S.diagonal().array() += CalcForceVariance(params_, step.dt_s - step.missing_s, 0);
  Matrix3d S_inverse = S.inverse();
  nis_ = Nis{z.dot(S_inverse * z), 3};
  if (nis_->value > gates_.three) {
    const double pushed = z.squaredNorm();
    P_.diagonal().tail<3>().array() += pushed;
    PHt.bottomRows<3>().diagonal().array() += pushed;
    S.diagonal().array() += pushed;
    S_inverse = S.inverse();
  }
  const Gain K = PHt.lazyProduct(S_inverse);
  TakeOptimal<9, 3>(P_, PHt, K);
  Correct(K * z);
}

void AttitudeEskf::CorrectMore(const State& dx, const Quaterniond& turn_W) {
  acceleration_W_m_s2_ = turn_W * (acceleration_W_m_s2_ + dx.segment<3>(kAcceleration));
}

}  // namespace piperun::estimator
