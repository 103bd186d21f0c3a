#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace piperun {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Position and orientation of a frame B in a frame A: p_A = R_AB p_B + p_AB. Quaternions are Hamilton,
/// q_AB rotates components in B into components in A.
struct Pose {
  Vector3d p = Vector3d::Zero();
  Quaterniond q = Quaterniond::Identity();

  Vector3d operator*(const Vector3d& p_B) const { return q * p_B + p; }
  Pose operator*(const Pose& X_BC) const { return {q * X_BC.p + p, q * X_BC.q}; }
  Pose Inverse() const { return {q.conjugate() * -p, q.conjugate()}; }
};

/// Skew-symmetric matrix with Skew(a) b = a x b.
Matrix3d Skew(const Vector3d& a);

/// Exponential map of SO(3): the rotation by |theta| about theta. Exact to rounding for every angle.
Quaterniond ExpSO3(const Vector3d& theta);

/// Inverse of ExpSO3 for the shorter way round: |result| <= pi.
Vector3d LogSO3(const Quaterniond& q);

}  // namespace piperun
