#include "estimator/madgwick.h"

#include <cmath>

#include "estimator/attitude_rate.h"

namespace piperun::estimator {
namespace {

/// J^T (R^T up - a), J the Jacobian of R^T up by (w, x, y, z) of q; up to a factor of 2.
Eigen::Vector4d CalcGravityGradient(const Quaterniond& q, const Vector3d& a) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const Vector3d e = CalcUp_S(q) - a;
  return {x * e.y() - y * e.x(), z * e.x() + w * e.y() - 2 * x * e.z(), z * e.y() - w * e.x() - 2 * y * e.z(),
          x * e.x() + y * e.y()};
}

/// J^T (R^T b - m) for b = (b_x, 0, b_z), likewise.
Eigen::Vector4d CalcFieldGradient(const Quaterniond& q, const Vector3d& m, double b_x, double b_z) {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double e_x = b_x * (1 - 2 * (y * y + z * z)) + 2 * b_z * (x * z - w * y) - m.x();
  const double e_y = 2 * (b_x * (x * y - w * z) + b_z * (w * x + y * z)) - m.y();
  const double e_z = 2 * b_x * (w * y + x * z) + b_z * (1 - 2 * (x * x + y * y)) - m.z();
  return {-b_z * y * e_x + (b_z * x - b_x * z) * e_y + b_x * y * e_z,
          b_z * z * e_x + (b_x * y + b_z * w) * e_y + (b_x * z - 2 * b_z * x) * e_z,
          -(2 * b_x * y + b_z * w) * e_x + (b_x * x + b_z * z) * e_y + (b_x * w - 2 * b_z * y) * e_z,
          (b_z * x - 2 * b_x * z) * e_x + (b_z * y - b_x * w) * e_y + b_x * x * e_z};
}

}  // namespace

void MadgwickParams::Visit(ParamVisitor& v) {
  v.Number({"beta_rad_s", "How fast accelerometer and magnetometer may turn the attitude."},
           Range::NonNegative(), beta_rad_s);
  v.Flag({"published", "Halve the field's reference, as the published C code does."}, published);
}

void Madgwick::Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, double dt_s) {
  const Vector3d a = Direction(f_S);
  Descend(w_S_rad_s, a.isZero(0) ? Eigen::Vector4d(Eigen::Vector4d::Zero()) : CalcGravityGradient(q_MS_, a),
          dt_s);
}

void Madgwick::Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, const Vector3d& m_S, double dt_s) {
  const Vector3d a = Direction(f_S), m = Direction(m_S);
  if (a.isZero(0) || m.isZero(0)) return Step(w_S_rad_s, f_S, dt_s);
  const Vector3d h = q_MS_ * m;
  const double scale = params_.published ? 0.5 : 1;
  const double b_x = scale * std::sqrt(h.x() * h.x() + h.y() * h.y()), b_z = scale * h.z();
  Descend(w_S_rad_s, CalcGravityGradient(q_MS_, a) + CalcFieldGradient(q_MS_, m, b_x, b_z), dt_s);
}

void Madgwick::Descend(const Vector3d& w, const Eigen::Vector4d& gradient, double dt_s) {
  Eigen::Vector4d rate = CalcAttitudeRate(q_MS_, w);
  const double norm2 = gradient.squaredNorm();
  if (norm2 > 0) rate -= (params_.beta_rad_s / std::sqrt(norm2)) * gradient;
  q_MS_ = StepEuler(q_MS_, rate, dt_s);
}

}  // namespace piperun::estimator
