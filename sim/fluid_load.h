#pragma once

#include "base/water.h"
#include "sim/ball.h"
#include "sim/flow_field.h"

namespace piperun::sim {

/// What the loads need to know of ball and water, worked out once.
struct FluidLoadCoefficients {
  Vector3d weight_W_N = Vector3d::Zero();  ///< (m - rho V) g
  double displaced_mass_kg = 0;            ///< rho V
  double added_mass_kg = 0;                ///< m_a = C_a rho V
  double volume_m3 = 0;
  double diameter_m = 0;
  double viscosity_m2_s = 0;
  double drag_scale_N_s_m = 0;  ///< pi/8 rho nu d
  double spin_scale_N_m_s = 0;  ///< k_spin rho nu r^3 / 8
};

FluidLoadCoefficients CalcFluidLoadCoefficients(const BallParams& ball, const WaterProperties& water,
                                                const Vector3d& gravity_W);

/// The loads on the ball one by one. They act at its centre; the added mass itself belongs into the mass
/// matrix (a point mass m_a at the centre), never here: as a force it is unstable when m_a > m.
struct FluidLoad {
  Vector3d weight_W_N = Vector3d::Zero();  ///< less buoyancy
  Vector3d fluid_acceleration_W_N = Vector3d::Zero();
  Vector3d pressure_fall_W_N = Vector3d::Zero();
  Vector3d drag_W_N = Vector3d::Zero();
  Vector3d spin_torque_W_N_m = Vector3d::Zero();

  Vector3d Force_W_N() const { return weight_W_N + fluid_acceleration_W_N + pressure_fall_W_N + drag_W_N; }
};

/// Loads of the water on a ball with velocity v and angular velocity w, after Maxey & Riley (Phys. Fluids 26,
/// 883 (1983)) with drag for finite Reynolds numbers and without the history force (it slows an impact by 1-4
/// %):
///
///   weight and buoyancy  (m - rho V) g
///   fluid acceleration   (rho V + m_a) Du/Dt       pressure gradient of the turning flow, and added mass
///   pressure fall        V f/D rho U^2/2           of pipe friction, once, along the flow
///   drag                 1/2 rho A C_D(Re/f) |u-v| (u-v) / f^2,  Re = |u-v| d/nu
///   spin torque          k_spin 1/2 rho r^5 C_w |w_u-w| (w_u-w), w_u = 1/2 curl u
///
/// with f = CalcWallFactor(d/D, Re), D the bore around the ball (WaterAtBall::bore_radius_m > 0).
///
/// u, Du/Dt, curl u are averages over the frontal disc (sim/flow_field.h). C_D, f and C_w: sim/drag.h, with
/// sources and ranges; every speed from rest up is allowed. f is measured for a sphere on the axis; k_spin is
/// calibrated on balls rolling along the wall (sim/ball.h). Left out: lift, Magnus force, turbulence.
FluidLoad CalcFluidLoad(const FluidLoadCoefficients& c, const Vector3d& v_WB_W, const Vector3d& w_WB_W,
                        const WaterAtBall& water);

}  // namespace piperun::sim
