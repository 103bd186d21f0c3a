#include "base/pose.h"

#include <cmath>

namespace piperun {

Matrix3d Skew(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Quaterniond ExpSO3(const Vector3d& theta) {
  const double angle = theta.norm();
  const double half = 0.5 * angle;
  // sin(x/2)/x = 1/2 - x^2/48 + O(x^4); at x = 1e-4 the next term is below one ulp
  const double k = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(half) / angle;
  return {std::cos(half), k * theta.x(), k * theta.y(), k * theta.z()};
}

Vector3d LogSO3(const Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const Vector3d v = sign * q.vec();
  const double s = v.norm();
  const double w = sign * q.w();
  // 2 atan2(s, w)/s = 2/w (1 - s^2/(3 w^2) + ...)
  const double k = s < 1e-6 ? 2 / w * (1 - s * s / (3 * w * w)) : 2 * std::atan2(s, w) / s;
  return k * v;
}

}  // namespace piperun
