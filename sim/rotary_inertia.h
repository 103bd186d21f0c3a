#pragma once

#include "base/pose.h"

namespace piperun::sim {

/// A body's inertia tensor in its own frame B. A number stands for the same moment about every axis.
class RotaryInertia {
 public:
  RotaryInertia(double moment_kg_m2);             // NOLINT(google-explicit-constructor): a number is a tensor
  RotaryInertia(const Matrix3d& tensor_B_kg_m2);  // NOLINT(google-explicit-constructor)

  /// The same about every axis, exactly; attitude does not act on such a body's turning.
  bool isotropic() const { return isotropic_; }
  const Matrix3d& tensor_B_kg_m2() const { return tensor_B_kg_m2_; }
  /// About the principal axes, which are those of the frame I.
  const Vector3d& moments_kg_m2() const { return moments_kg_m2_; }
  const Matrix3d& R_BI() const { return R_BI_; }

  /// L = R I R^T w and back.
  Vector3d Momentum(const Matrix3d& R_WB, const Vector3d& w_W) const;
  Vector3d Rate(const Matrix3d& R_WB, const Vector3d& momentum_W) const;

 private:
  Matrix3d tensor_B_kg_m2_;
  Matrix3d inverse_B_;
  Vector3d moments_kg_m2_;
  Matrix3d R_BI_ = Matrix3d::Identity();
  bool isotropic_ = true;
};

}  // namespace piperun::sim
