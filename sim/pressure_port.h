#pragma once

#include <string>

#include "base/params.h"
#include "sim/truth.h"

namespace piperun::sim {

/// Where in the ball a pressure sensor meets the water, and what it feels of the flow around the ball.
struct PressurePortParams {
  Vector3d port_m = Vector3d::Zero();       ///< in B; zero: the centre
  std::string dynamic = "none";             ///< none, sphere or constant
  double pressure_coefficient = 1;          ///< C_p of `constant`
  double base_pressure_coefficient = -0.4;  ///< C_pb of `sphere`

  void Visit(ParamVisitor& v);
  /// Throws InputError (port_m) when the port of `sphere` has no direction.
  void Check() const;
};

/// Pressure on a sphere in a uniform stream, over rho u^2 / 2, where the outward normal makes the angle theta
/// with the direction the stream comes from:
///
///   C_p = 1 - 9/4 sin^2 theta   in front, down to C_pb, and C_pb from there on.
///
/// The potential flow (Lamb, Hydrodynamics, art. 96) as far as the boundary layer follows it, and a wake of
/// one pressure. C_pb = -0.4 fits spheres at Re = 1e3 to 2e5 (Achenbach, J. Fluid Mech. 54, 565, 1972); the
/// drag of this distribution is C_D = 0.44, theirs. Left out: the dip of about 0.2 before separation, walls,
/// the ball's spin, the critical Reynolds number. cos_theta in [-1, 1], C_pb in [-1.25, 1].
double CalcSpherePressureCoefficient(double cos_theta, double base_pressure_coefficient);

/// Gauge pressure at the port,
///
///   p = p_B + rho g . r + C_p rho |u|^2 / 2,
///
/// p_B the static pressure at the ball's centre, r the port from there and u the water's velocity relative to
/// the ball, in W. Pa. Left out: that the water around the ball accelerates.
double CalcPortPressure_Pa(const PressurePortParams& params, const TruthState& truth,
                           const Vector3d& gravity_W, double density_kg_m3);

}  // namespace piperun::sim
