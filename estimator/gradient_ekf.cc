#include "estimator/gradient_ekf.h"

#include <Eigen/LU>
#include <cmath>

#include "estimator/attitude_rate.h"

namespace piperun::estimator {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using Matrix3x4d = Eigen::Matrix<double, 3, 4>;

constexpr double kStartVariance = 0.1;

Vector4d ToVector(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// q -> q (w, x, y, z) as a matrix.
Matrix4d CalcRightProduct(const Quaterniond& r) {
  Matrix4d m;
  m << r.w(), -r.x(), -r.y(), -r.z(), r.x(), r.w(), r.z(), -r.y(), r.y(), -r.z(), r.w(), r.x(), r.z(), r.y(),
      -r.x(), r.w();
  return m;
}

/// F of eq. 5.25, the sign of F(3,2) as printed.
Matrix4d CalcPrintedTransition(const Vector3d& w_S_rad_s, double dt_s) {
  const Vector3d v = 0.5 * dt_s * w_S_rad_s;
  Matrix4d F = CalcRightProduct(Quaterniond(1, v.x(), v.y(), v.z()));
  F(2, 1) = -F(2, 1);
  return F;
}

/// Jacobian of R^T b for b = (b_x, 0, b_z), eqs 5.34 and 5.40.
Matrix3x4d CalcJacobian(const Quaterniond& q, double b_x, double b_z) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  Matrix3x4d J;
  J << -b_z * y, b_z * z, -2 * b_x * y - b_z * w, -2 * b_x * z + b_z * x,            //
      -b_x * z + b_z * x, b_x * y + b_z * w, b_x * x + b_z * z, -b_x * w + b_z * y,  //
      b_x * y, b_x * z - 2 * b_z * x, b_x * w - 2 * b_z * y, b_x * x;
  return 2 * J;
}

}  // namespace

void GradientEkfParams::Visit(ParamVisitor& v) {
  v.Number({"gyro_noise_rad_s_sqrtHz", "Assumed white noise of the gyro, its bias included."},
           Range::Positive(), gyro_noise_rad_s_sqrtHz);
  v.Number({"observation_sd", "Assumed error of each number of the observed quaternion."}, Range::Positive(),
           observation_sd);
  v.Number({"alpha", "Printed form: descent per step over the gyro's turn."}, Range::Between(1, 1000), alpha);
  v.Flag({"printed", "Use the form that the thesis prints, for comparison."}, printed);
}

GradientEkf::GradientEkf(const GradientEkfParams& params)
    : params_(params), P_(kStartVariance * Matrix4d::Identity()) {}

void GradientEkf::Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, double dt_s) {
  const Vector3d a = Direction(f_S);
  if (a.isZero(0)) return Filter(w_S_rad_s, Observe(Vector4d::Zero(), 0, w_S_rad_s, dt_s), dt_s);
  const Matrix3x4d J = CalcJacobian(q_MS_, 0, 1);
  const Vector4d gradient = J.transpose() * (CalcUp_S(q_MS_) - a);
  Filter(w_S_rad_s, Observe(gradient, (J * gradient).squaredNorm(), w_S_rad_s, dt_s), dt_s);
}

void GradientEkf::Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, const Vector3d& m_S, double dt_s) {
  const Vector3d a = Direction(f_S), m = Direction(m_S);
  if (a.isZero(0) || m.isZero(0)) return Step(w_S_rad_s, f_S, dt_s);
  const Vector3d h = q_MS_ * m;
  const Vector3d b(std::sqrt(h.x() * h.x() + h.y() * h.y()), 0, h.z());
  const Matrix3x4d J_g = CalcJacobian(q_MS_, 0, 1), J_b = CalcJacobian(q_MS_, b.x(), b.z());
  const Vector4d gradient =
      J_g.transpose() * (CalcUp_S(q_MS_) - a) + J_b.transpose() * (q_MS_.conjugate() * b - m);
  const double curvature = (J_g * gradient).squaredNorm() + (J_b * gradient).squaredNorm();
  Filter(w_S_rad_s, Observe(gradient, curvature, w_S_rad_s, dt_s), dt_s);
}

Vector4d GradientEkf::Observe(const Vector4d& gradient, double curvature, const Vector3d& w_S_rad_s,
                              double dt_s) const {
  const Vector4d q = ToVector(q_MS_);
  const double norm2 = gradient.squaredNorm();
  if (!(norm2 > 0) || !(curvature > 0)) return q;
  const double printed_share = params_.alpha * 0.5 * w_S_rad_s.norm() * dt_s / std::sqrt(norm2);
  const double share = params_.printed ? printed_share : norm2 / curvature;
  return (q - share * gradient).normalized();
}

void GradientEkf::Filter(const Vector3d& w_S_rad_s, const Vector4d& z_begin, double dt_s) {
  const Matrix4d turn = CalcRightProduct(ExpSO3(w_S_rad_s * dt_s));
  const Matrix4d F = params_.printed ? CalcPrintedTransition(w_S_rad_s, dt_s) : turn;
  const Vector4d z = params_.printed ? z_begin : Vector4d(turn * z_begin);
  const Vector4d q = ToVector(q_MS_), x = F * q;
  const double N = params_.gyro_noise_rad_s_sqrtHz, r = params_.observation_sd * params_.observation_sd;
  P_ = F * P_ * F.transpose() + (0.25 * N * N * dt_s) * (Matrix4d::Identity() - q * q.transpose());

  const Matrix4d K = P_ * (P_ + r * Matrix4d::Identity()).inverse();
  P_ -= (K * P_).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  const Vector4d after = (x + K * (z - x)).normalized();
  q_MS_ = Quaterniond(after[0], after[1], after[2], after[3]);
}

}  // namespace piperun::estimator
