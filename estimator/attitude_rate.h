#pragma once

#include <cmath>

#include "base/pose.h"

namespace piperun::estimator {

/// Change of the quaternion q with the rate w in the frame that q turns: 1/2 q (0, w), as (w, x, y, z).
inline Eigen::Vector4d CalcAttitudeRate(const Quaterniond& q, const Vector3d& w) {
  return 0.5 * Eigen::Vector4d(-q.x() * w.x() - q.y() * w.y() - q.z() * w.z(),
                               q.w() * w.x() + q.y() * w.z() - q.z() * w.y(),
                               q.w() * w.y() - q.x() * w.z() + q.z() * w.x(),
                               q.w() * w.z() + q.x() * w.y() - q.y() * w.x());
}

/// q + rate dt, normalised.
inline Quaterniond StepEuler(const Quaterniond& q, const Eigen::Vector4d& rate, double dt_s) {
  return Quaterniond(q.w() + rate[0] * dt_s, q.x() + rate[1] * dt_s, q.y() + rate[2] * dt_s,
                     q.z() + rate[3] * dt_s)
      .normalized();
}

/// R^T up, R the matrix of q.
inline Vector3d CalcUp_S(const Quaterniond& q) {
  return {2 * (q.x() * q.z() - q.w() * q.y()), 2 * (q.w() * q.x() + q.y() * q.z()),
          1 - 2 * (q.x() * q.x() + q.y() * q.y())};
}

/// v / |v|; zero for zero.
inline Vector3d Direction(const Vector3d& v) {
  const double norm2 = v.squaredNorm();
  return norm2 > 0 ? Vector3d(v / std::sqrt(norm2)) : Vector3d(Vector3d::Zero());
}

}  // namespace piperun::estimator
