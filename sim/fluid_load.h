#pragma once

#include <span>
#include <vector>

#include "base/water.h"
#include "sim/ball.h"
#include "sim/drag.h"
#include "sim/flow_field.h"
#include "sim/force_params.h"
#include "sim/wall_factor.h"

namespace piperun::sim {

/// What the loads need to know of ball and water, worked out once; a law that is switched off has a factor
/// of zero.
struct FluidLoadCoefficients {
  Vector3d weight_W_N = Vector3d::Zero();  ///< (m - rho V) g
  double added_mass_kg = 0;                ///< m_a = C_a rho V, for the mass matrix
  double inertial_mass_kg = 0;             ///< m + m_a
  double accelerated_mass_kg = 0;          ///< rho V + m_a
  double pressed_volume_m3 = 0;            ///< V
  double radius_m = 0;
  double diameter_m = 0;
  double viscosity_m2_s = 0;
  double drag_scale_N_s_m = 0;  ///< pi/8 rho nu d
  double spin_scale_N_m_s = 0;  ///< k_spin rho nu r^3 / 8
  double lift_scale_kg_m = 0;   ///< 1/2 rho A C_L
  double magnus_scale_kg = 0;   ///< 1/2 rho A C_M r
  double magnus_m = 0;          ///< C_M r / 0.5: spin over slip at which the Magnus force saturates
  SphereDrag drag;              ///< of the free sphere
  bool rolling_drag = false;
  double spin_factor = 0;  ///< k_spin
  WallFactorLaw wall_factor = WallFactorLaw::kNone;
  std::vector<WallFactorTable> wall_factors;  ///< one per bore, by increasing d/D
};

/// For a ball in a network of these bores. The first is the one whose added mass counts, when the ball has
/// none of its own (sim/added_mass.h): the mass of a ball does not change on its way. In bores not named
/// (cones, joints) the wall factor is solved for at every evaluation, which is slower and gives the same.
FluidLoadCoefficients CalcFluidLoadCoefficients(const BallParams& ball, const ForceParams& forces,
                                                const WaterProperties& water, const Vector3d& gravity_W,
                                                std::span<const double> bore_radii_m);

/// The dimensionless numbers that the laws' ranges are given in.
struct LoadNumbers {
  double free_reynolds = 0;   ///< at which the drag law was taken, |u-v| d / (nu f)
  double reynolds = 0;        ///< |u-v| d / nu
  double spin_reynolds = 0;   ///< d^2 |w_u-w| / nu
  double diameter_ratio = 0;  ///< d/D
};

/// The loads on the ball one by one. They act at its centre; the added mass itself belongs into the mass
/// matrix (a point mass m_a at the centre), never here: as a force it is unstable when m_a > m.
struct FluidLoad {
  Vector3d weight_W_N = Vector3d::Zero();  ///< less buoyancy
  Vector3d fluid_acceleration_W_N = Vector3d::Zero();
  Vector3d pressure_fall_W_N = Vector3d::Zero();
  Vector3d drag_W_N = Vector3d::Zero();
  double drag_over_slip_N_s_m = 0;  ///< of what drag_W_N began as: F = this (u - v)
  Vector3d lift_W_N = Vector3d::Zero();
  Vector3d magnus_W_N = Vector3d::Zero();
  Vector3d spin_torque_W_N_m = Vector3d::Zero();
  LoadNumbers numbers;

  Vector3d Force_W_N() const {
    return weight_W_N + fluid_acceleration_W_N + pressure_fall_W_N + drag_W_N + lift_W_N + magnus_W_N;
  }
};

/// Loads of the water on a ball with velocity v and angular velocity w, after Maxey & Riley (Phys. Fluids 26,
/// 883 (1983)) with drag for finite Reynolds numbers and without the history force (it slows an impact by 1-4
/// %):
///
///   weight and buoyancy  (m - rho V) g
///   fluid acceleration   (rho V + m_a) Du/Dt       pressure gradient of the turning flow, and added mass
///   pressure fall        V f_D/D rho U^2/2         of pipe friction, once, along the flow
///   drag                 1/2 rho A (C_D(Re/f) / f^2 + (n - l^3) dC_D(Re)) |u-v| (u-v),   Re = |u-v| d/nu
///   lift                 1/2 rho A C_L (n - n') (u-v)_t^2 from the wall,   (u-v)_t along the pipe's axis
///   Magnus               1/2 rho A C_M r w_rel x v_rel / sqrt(1 + (C_M S / 0.5)^2),   S = r |w_rel|/|v_rel|
///   spin torque          k_spin 1/2 rho r^5 C_w |w_rel| (-w_rel),   w_rel = w - 1/2 curl u,  v_rel = v - u
///
/// f: wall factor of a tube of l = d/D (WaterAtBall::bore_radius_m > 0) at this Re. dC_D: what touching a
/// plane adds; n: nearness of the wall, n' of the wall across (sim/rolling_drag.h). f is measured on the
/// axis, where the wall's nearness is l^3 already: off the axis there is n - l^3 more of it, nothing on the
/// axis, all of dC_D on a plane. Blockage and contact add up: one is felt through the whole bore, the other
/// in the wedge between ball and wall, where the bore's far side plays no part. Other ways: docs/physics.md.
/// The lifts off opposite walls cancel on the axis.
///
/// The Magnus force saturates at a coefficient of 0.5, which no measurement on spheres exceeds (Tsuji,
/// Morikawa & Mizuno, J. Fluids Eng. 107, 484 (1985), from memory): a ball that rolls along with the water
/// has S of 10 and more.
///
/// u, Du/Dt, curl u are averages over the frontal disc (sim/flow_field.h). C_D, f and C_w: sim/drag.h and
/// sim/wall_factor.h, with sources and ranges; every speed from rest up is allowed. Left out: Saffman's lift
/// (for Re < 100 only), history force.
FluidLoad CalcFluidLoad(const FluidLoadCoefficients& c, const Vector3d& v_WB_W, const Vector3d& w_WB_W,
                        const WaterAtBall& water);

}  // namespace piperun::sim
