#include "estimator/attitude_ukf.h"

#include <Eigen/LU>
#include <cmath>

namespace piperun::estimator {
namespace {

constexpr double kAlpha2 = 0.01;
constexpr double kWeight = 1 / (12 * kAlpha2);
constexpr double kFirstMean = 1 - 1 / kAlpha2;
constexpr double kFirstSpread = 4 - kAlpha2 - 1 / kAlpha2;

/// Weighted mean of thirteen vectors.
template <class Vector>
Vector CalcMean(const std::array<Vector, 13>& points) {
  Vector sum = points[1];
  for (std::size_t i = 2; i < points.size(); ++i) sum += points[i];
  return kFirstMean * points[0] + kWeight * sum;
}

/// Weighted sum of x_i y_i^T.
template <int n, int m>
Eigen::Matrix<double, n, m> CalcSpread(const std::array<Eigen::Matrix<double, n, 1>, 13>& x,
                                       const std::array<Eigen::Matrix<double, m, 1>, 13>& y) {
  Eigen::Matrix<double, n, m> sum = x[1] * y[1].transpose();
  for (std::size_t i = 2; i < x.size(); ++i) sum += x[i] * y[i].transpose();
  return kWeight * sum + kFirstSpread * x[0] * y[0].transpose();
}

}  // namespace

Eigen::Matrix<double, 6, 6> CalcRoot(const Eigen::Matrix<double, 6, 6>& P) {
  Eigen::Matrix<double, 6, 6> L = Eigen::Matrix<double, 6, 6>::Zero();
  for (int j = 0; j < 6; ++j) {
    double pivot = P(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    if (!(pivot > 1e-14 * P(j, j))) continue;
    L(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < 6; ++i) {
      double rest = P(i, j);
      for (int k = 0; k < j; ++k) rest -= L(i, k) * L(j, k);
      L(i, j) = rest / L(j, j);
    }
  }
  return L;
}

AttitudeUkf::SigmaPoints AttitudeUkf::DrawSigmaPoints() const {
  const Covariance root = std::sqrt(6 * kAlpha2) * CalcRoot(P_);
  SigmaPoints points;
  points[0].setZero();
  for (std::size_t i = 0; i < 6; ++i) {
    points[1 + i] = root.col(static_cast<int>(i));
    points[7 + i] = -points[1 + i];
  }
  return points;
}

void AttitudeUkf::Propagate(const ImuStep& step) {
  const Vector3d turn_S_rad = CorrectedTurn_S(step);
  const Quaterniond before = q_WS_, half = ExpSO3(0.5 * turn_S_rad);
  q_WS_force_ = step.f_at_begin ? before : before * half;
  q_WS_ = before * half * half;
  SigmaPoints points = DrawSigmaPoints();
  for (State& x : points) {
    const Quaterniond q = ExpSO3(x.head<3>()) * before * ExpSO3(turn_S_rad - step.dt_s * x.tail<3>());
    x.head<3>() = LogSO3(q * q_WS_.conjugate());
  }
  const State mean = CalcMean(points);
  for (State& x : points) x -= mean;
  P_ = CalcSpread<6, 6>(points, points);
  AddNoise(step);
  Correct(mean);
}

void AttitudeUkf::UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) {
  if (step.AccelerometerClipped()) return;
  double force_variance = CalcForceVariance(params_, step.dt_s - step.missing_s, motion_acceleration_sd_m_s2);
  force_variance += CalcExcessVariance(step.f_S_m_s2.norm(), g_m_s2_, force_variance);

  const SigmaPoints points = DrawSigmaPoints();
  std::array<Vector3d, 13> up;
  for (std::size_t i = 0; i < points.size(); ++i) {
    up[i] = ExpSO3(-points[i].head<3>()) * Vector3d::UnitZ();
  }
  const Vector3d mean = CalcMean(up);
  for (Vector3d& y : up) y -= mean;
  const Vector3d z = q_WS_force_ * step.f_S_m_s2 / g_m_s2_ - mean;
  Matrix3d S = CalcSpread<3, 3>(up, up);
  S.diagonal().array() += force_variance / (g_m_s2_ * g_m_s2_);
  Matrix3d S_inverse = S.inverse();
  nis_ = Nis{z.dot(S_inverse * z), 3};
  if (nis_->value > gates_.three) {
    S.diagonal().array() += (nis_->value / gates_.three - 1) * S.diagonal().maxCoeff();
    S_inverse = S.inverse();
  }
  const Eigen::Matrix<double, 6, 3> cross = CalcSpread<6, 3>(points, up);
  const Eigen::Matrix<double, 6, 3> K = cross * S_inverse;
  TakeOptimal<6, 3>(P_, cross, K);
  Correct(K * z);
}

}  // namespace piperun::estimator
