#include "sim/rotary_inertia.h"

#include <Eigen/Eigenvalues>

namespace piperun::sim {

RotaryInertia::RotaryInertia(double moment_kg_m2)
    : RotaryInertia(Matrix3d(moment_kg_m2 * Matrix3d::Identity())) {}

RotaryInertia::RotaryInertia(const Matrix3d& tensor_B_kg_m2)
    : tensor_B_kg_m2_(tensor_B_kg_m2),
      moments_kg_m2_(tensor_B_kg_m2.diagonal()),
      isotropic_(tensor_B_kg_m2 == Matrix3d(tensor_B_kg_m2(0, 0) * Matrix3d::Identity())) {
  if (!isotropic_) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(tensor_B_kg_m2);
    moments_kg_m2_ = principal.eigenvalues();
    R_BI_ = principal.eigenvectors();
    if (R_BI_.determinant() < 0) R_BI_.col(0) = -R_BI_.col(0);
  }
  inverse_B_ = R_BI_ * moments_kg_m2_.cwiseInverse().asDiagonal() * R_BI_.transpose();
}

Vector3d RotaryInertia::Momentum(const Matrix3d& R_WB, const Vector3d& w_W) const {
  return R_WB * (tensor_B_kg_m2_ * (R_WB.transpose() * w_W));
}

Vector3d RotaryInertia::Rate(const Matrix3d& R_WB, const Vector3d& momentum_W) const {
  return R_WB * (inverse_B_ * (R_WB.transpose() * momentum_W));
}

}  // namespace piperun::sim
