#pragma once

#include <vector>

#include "base/pose.h"
#include "base/time.h"

namespace piperun::sim {

/// Exact kinematics of a body at an instant.
struct ScriptPoint {
  Pose X_WB;
  Vector3d v_WB_W = Vector3d::Zero();
  Vector3d a_WB_W = Vector3d::Zero();
  Vector3d w_WB_B = Vector3d::Zero();
};

/// A prescribed motion from rest to rest, known in closed form at every instant.
class Script {
 public:
  virtual ~Script() = default;
  virtual double duration_s() const = 0;
  /// t >= 0; after its end a script stays where it is, at rest.
  virtual ScriptPoint Eval(double t_s) const = 0;
  /// Instants, ascending, between which the motion is smooth (infinitely differentiable).
  virtual const std::vector<double>& knots_s() const = 0;
  /// Whether the body touches the ground or a wall.
  virtual bool contact() const { return false; }
  /// From the route to the body that is carried along it: what a nearest-point search has to take off.
  virtual Vector3d route_offset_W() const { return Vector3d::Zero(); }
};

/// Mean velocity over [begin, begin + dt] in W: Gauss-Legendre quadrature (three points) of the velocity on
/// each smooth part. Exact to rounding for polynomials of degree five; never differences positions, which
/// would put 1e-16 |p| / dt^2 of noise on the specific force.
Vector3d CalcMeanVelocity(const Script& script, double begin_s, double dt_s);

}  // namespace piperun::sim
