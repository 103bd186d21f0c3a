#pragma once

#include <array>
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "sim/bore.h"
#include "sim/point_sources.h"

namespace piperun::sim {

/// How well the potential of a joint keeps to its walls: the normal velocity it leaves there, in Q/(pi R^2)
/// of the arm that carries the most, worst of the flows from one arm to another; on a wall of finer patches
/// than the one it was fitted to.
struct JunctionFit {
  int sources = 0;
  int wall_points = 0;
  double wall_rms = 0;
  double wall_max = 0;
};

/// Potential flow through a joint, for any outflows Q_i from the node into its arms:
///
///   u = sum_i Q_i grad Phi_i,   laplace Phi_i = 0
///
/// Phi_i carries a unit flow out of arm i and none out of the others; what the outflows do not balance comes
/// in through the wall, evenly spread: the withdrawal of the node. Each arm ends as a straight tube at
/// z = core_i from the node; there the flow is uniform, u = Q_i/A_i.
///
/// Phi_i is a sum of point sources outside the water (method of fundamental solutions; Fairweather &
/// Karageorghis, Adv. Comput. Math. 9, 69 (1998)), found by least squares over walls and end sections under
/// the exact condition that the flux through sections along each arm is the given one. So mass is conserved
/// to rounding, divergence and rotation vanish everywhere; what is approximate is that walls are tangent
/// (fit()). Lips are rounded (sim/junction_wall.h): at a sharp one the potential flow would be infinitely
/// fast.
///
/// Along the last 1.5 radii of an arm the potential flow fades into the uniform one, chi(z) from 1 to 0:
///
///   u = (1 - chi) U e_z + chi grad Phi + chi' (grad_T Psi + U r/2 - grad_T h),   dPsi/dz = Phi
///
/// which is divergence-free for any chi, since laplace_T Psi = -d^2 Phi/dz^2 (T: across the arm). h(x, y) is
/// the plane harmonic function that makes the bracket tangent to the wall.
///
/// Range: any number of arms >= 2 at angles above kMinAngle_rad. No evaluation allocates.
class JunctionFlow {
 public:
  static constexpr double kMinAngle_rad = 0.2;
  /// Whether the joint's arms are far enough from parallel.
  static bool Covers(const Joint& joint);

  /// `core_m` per arm, > 0. Costs 20 to 400 ms, most where arms meet at sharp angles.
  JunctionFlow(const Joint& joint, std::span<const double> core_m);

  /// Velocity at p_N (from the node, axes of W), seen from arm `arm`: up to the arm's end section.
  VelocityGradient Eval(std::span<const double> outflow_m3_s, std::size_t arm, const Vector3d& p_N) const;
  /// The velocity alone: what du/dt is for changing outflows.
  Vector3d EvalVelocity(std::span<const double> outflow_m3_s, std::size_t arm, const Vector3d& p_N) const;
  const JunctionFit& fit() const { return fit_; }
  /// Where an arm's flow begins to fade into the uniform one.
  double fade_begin_m(std::size_t arm) const { return arms_[arm].fade_begin_m; }

 private:
  static constexpr std::size_t kHarmonics = 8;
  using Harmonics = std::array<std::complex<double>, kHarmonics>;  ///< a_m - i b_m of dh/dr on the wall
  struct Arm {
    Matrix3d axes;  ///< columns; z along the arm
    double radius_m = 0;
    double fade_begin_m = 0;
    double core_m = 0;
    std::vector<Harmonics> h;  ///< per unit flow
  };

  Harmonics FindHarmonics(const Arm& arm, std::span<const double> outflow_m3_s) const;
  CrossPrimitive EvalHarmonics(const Arm& arm, std::span<const double> outflow_m3_s,
                               const Eigen::Vector2d& p) const;

  std::vector<Arm> arms_;
  JunctionFit fit_;
  std::optional<PointSources> sources_;
};

}  // namespace piperun::sim
