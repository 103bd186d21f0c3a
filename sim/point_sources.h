#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/pose.h"

namespace piperun::sim {

/// A velocity and its gradient, gradient(i, j) = du_i/dx_j.
struct VelocityGradient {
  Vector3d velocity_m_s = Vector3d::Zero();
  Matrix3d gradient_1_s = Matrix3d::Zero();
};

/// Across an axis: the gradient of a potential's primitive along it, and its gradient.
struct CrossPrimitive {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

/// Point sources at fixed places whose strengths are sums of given patterns, q_j = sum_i w_i q_ij:
///
///   Phi = -1/(4 pi) sum_j q_j / |p - x_j|,   u = grad Phi
///
/// harmonic wherever no source is. No evaluation allocates.
class PointSources {
 public:
  /// strengths(j, i): of source j in pattern i.
  PointSources(const std::vector<Vector3d>& places, const Eigen::MatrixXd& strengths);

  VelocityGradient Eval(std::span<const double> weights, const Vector3d& p) const;
  Vector3d EvalVelocity(std::span<const double> weights, const Vector3d& p) const;

  /// A primitive Psi of Phi along the axis z of a frame (`axes`: its unit vectors as columns), dPsi/dz = Phi
  /// and harmonic:
  ///
  ///   Psi = 1/(4 pi) sum_j q_j sigma_j ln(r_j - sigma_j z_j)
  ///
  /// with r_j, z_j from the source to p. Each source draws a singular line parallel to the axis: sources
  /// beyond z = `z_turn` upwards (sigma = 1), the others downwards. `z_turn` and p.z count along the axis
  /// from the origin.
  CrossPrimitive EvalPrimitive(std::span<const double> weights, const Vector3d& p, const Matrix3d& axes,
                               double z_turn) const;

 private:
  using Lanes = Eigen::Array4d;  // four sources at a time
  Lanes Strength(std::span<const double> weights, std::size_t group) const;

  std::vector<Lanes> x_, y_, z_;
  std::vector<Lanes> strength_;  // over 4 pi; of group g in pattern i: g * patterns + i
  std::size_t patterns_;
};

}  // namespace piperun::sim
