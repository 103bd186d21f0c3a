#include "sim/fluid_load.h"

#include <numbers>

#include "sim/drag.h"

namespace piperun::sim {
namespace {

/// 1/2 rho A C_D |u| u = pi/8 rho nu d (C_D Re) u for the free sphere; in the tube u/f takes the place of u.
Vector3d CalcDrag(const FluidLoadCoefficients& c, double bore_radius_m, const Vector3d& u_rel) {
  const double reynolds = u_rel.norm() * c.diameter_m / c.viscosity_m2_s;
  const double f = CalcWallFactor(0.5 * c.diameter_m / bore_radius_m, reynolds);
  return c.drag_scale_N_s_m * CalcDragTimesReynolds(reynolds / f) / f * u_rel;
}

/// 1/2 rho r^5 C_w |w| w = 1/8 rho nu r^3 (C_w Re_w) w with Re_w = d^2 |w| / nu.
Vector3d CalcSpinTorque(const FluidLoadCoefficients& c, const Vector3d& w_rel) {
  const double reynolds = c.diameter_m * c.diameter_m * w_rel.norm() / c.viscosity_m2_s;
  return c.spin_scale_N_m_s * CalcSpinTorqueTimesReynolds(reynolds) * w_rel;
}

}  // namespace

FluidLoadCoefficients CalcFluidLoadCoefficients(const BallParams& ball, const WaterProperties& water,
                                                const Vector3d& gravity_W) {
  const double r = ball.radius_m;
  const double rho_nu = water.density_kg_m3 * water.kinematic_viscosity_m2_s;
  FluidLoadCoefficients c;
  c.volume_m3 = ball.volume_m3();
  c.displaced_mass_kg = water.density_kg_m3 * c.volume_m3;
  c.added_mass_kg = ball.added_mass_coefficient.value_or(0.62) * c.displaced_mass_kg;
  c.weight_W_N = (ball.mass_kg() - c.displaced_mass_kg) * gravity_W;
  c.diameter_m = 2 * r;
  c.viscosity_m2_s = water.kinematic_viscosity_m2_s;
  c.drag_scale_N_s_m = std::numbers::pi / 8 * rho_nu * c.diameter_m;
  c.spin_scale_N_m_s = ball.spin_drag_factor * rho_nu * r * r * r / 8;
  return c;
}

FluidLoad CalcFluidLoad(const FluidLoadCoefficients& c, const Vector3d& v_WB_W, const Vector3d& w_WB_W,
                        const WaterAtBall& water) {
  FluidLoad load;
  load.weight_W_N = c.weight_W_N;
  load.fluid_acceleration_W_N = (c.displaced_mass_kg + c.added_mass_kg) * water.acceleration_W;
  load.pressure_fall_W_N = c.volume_m3 * water.pressure_fall_W_Pa_m;
  load.drag_W_N = CalcDrag(c, water.bore_radius_m, water.velocity_W - v_WB_W);
  load.spin_torque_W_N_m = CalcSpinTorque(c, water.spin_W - w_WB_W);
  return load;
}

}  // namespace piperun::sim
