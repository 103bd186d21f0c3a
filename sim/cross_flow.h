#pragma once

#include "base/pose.h"
#include "sim/axial_flow.h"

namespace piperun::sim {

/// Where a flow across the pipe is asked for.
struct CrossPlace {
  Vector3d axis_W = Vector3d::UnitX();      ///< t
  Vector3d curvature_W = Vector3d::Zero();  ///< kappa
  Vector3d offset_W = Vector3d::Zero();     ///< d, from the axis to the ball's centre
  double radius_m = 0;                      ///< R
  double radius_slope = 0;                  ///< dR/ds
  double ball_radius_m = 0;                 ///< b; 0: the flow at a point
};

/// Velocities of the cells and of the swirl with their derivatives along s. d(cells)/ds holds what the
/// turning of the axis makes of the vector.
struct CrossSpeed {
  Vector3d cells_W_m_s = Vector3d::Zero();  ///< w, across the pipe
  Vector3d cells_slope_W_1_s = Vector3d::Zero();
  double swirl_m_s = 0;  ///< c
  double swirl_slope_1_s = 0;
  double swirl_change_m_s2 = 0;  ///< dc/dt of water whose flow rate stays

  /// False where nothing is left of the last bend's.
  bool Matters() const {
    constexpr double kNothing_m_s = 1e-12;
    constexpr double kNothing_1_s = 1e-12;
    const auto square = [](const Vector3d& v, double c) { return v.squaredNorm() + c * c; };
    return square(cells_W_m_s, swirl_m_s) > kNothing_m_s * kNothing_m_s ||
           square(cells_slope_W_1_s, swirl_slope_1_s) > kNothing_1_s * kNothing_1_s;
  }
};

struct CrossFlow {
  Vector3d velocity_W = Vector3d::Zero();
  Matrix3d gradient_1_s = Matrix3d::Zero();  ///< column j: derivative along axis j of W

  Vector3d Curl_1_s() const;
};

/// Two cells with stream function w R (r/R)(1 - (r/R)^2) sin(theta), w in the middle and 2 w back along the
/// walls, and a single one that turns with c (r/R)(1 - (r/R)^2), as means over the ball's disc,
///
///   u = k (p w - 2/R^2 (d . (t x w)) d x t + c/R p t x d)
///   p = 1 - (b^2 + r^2)/R^2,   k = 1/(1 - d . kappa)
///
/// (the mean of a cubic f over a disc of radius b is f + b^2/8 laplace f). k makes it free of divergence in
/// bends, too. For b = 0 it is tangent to the wall. Exact gradient, the variation along s included.
CrossFlow CalcCrossFlow(const CrossPlace& place, const CrossSpeed& speed);

/// What a flow u2 across the pipe adds to a main flow u1 of velocity `main_velocity_W`, no swirl of its own.
struct CrossAddition {
  Vector3d velocity_W = Vector3d::Zero();
  Vector3d acceleration_W = Vector3d::Zero();  ///< (u1 + u2) . grad u2 + u2 . grad u1 + du2/dt
  Vector3d spin_W = Vector3d::Zero();          ///< 1/2 curl u2
};

/// `main`: u1 before the stretch k. du2/dt = `change_1_s` u2 (the flow rate's dQ/dt over Q) + what dc/dt
/// makes.
CrossAddition CalcCrossAddition(const CrossPlace& place, const CrossSpeed& speed, const AxialFlow& main,
                                const Vector3d& main_velocity_W, double change_1_s);

}  // namespace piperun::sim
