#include "sim/fluid_load.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "sim/added_mass.h"
#include "sim/rolling_drag.h"

namespace piperun::sim {
namespace {

constexpr double kMostMagnus = 0.5;

double CalcLogWallFactor(const FluidLoadCoefficients& c, double diameter_ratio, const Reynolds& reynolds) {
  const auto table =
      std::ranges::lower_bound(c.wall_factors, diameter_ratio, {}, &WallFactorTable::diameter_ratio);
  if (table != c.wall_factors.end() && table->diameter_ratio() == diameter_ratio) {
    return table->EvalLog(reynolds);
  }
  return SolveLogWallFactor(c.wall_factor, diameter_ratio, reynolds);
}

/// F/u of the drag: 1/2 rho A C_D |u| u = pi/8 rho nu d (C_D Re) u for the free sphere; in the tube u/f takes
/// the place of u.
double CalcDragOverSlip_N_s_m(const FluidLoadCoefficients& c, const Vector3d& u_rel, double nearness,
                              LoadNumbers& numbers) {
  const double l = numbers.diameter_ratio;
  const Reynolds reynolds = u_rel.norm() * c.diameter_m / c.viscosity_m2_s;
  const double log_f = CalcLogWallFactor(c, l, reynolds), speed_up = std::exp(-log_f);
  const Reynolds free_reynolds(reynolds.value * speed_up, reynolds.log - log_f);
  double drag_times_reynolds = c.drag.TimesReynolds(free_reynolds) * speed_up;
  if (c.rolling_drag) {
    drag_times_reynolds +=
        (nearness - l * l * l) *
        CalcContactDragTimesReynolds(reynolds, c.drag.TimesReynolds(reynolds), c.spin_factor);
  }
  numbers.reynolds = reynolds.value;
  numbers.free_reynolds = free_reynolds.value;
  return c.drag_scale_N_s_m * drag_times_reynolds;
}

Vector3d CalcLift(const FluidLoadCoefficients& c, const Vector3d& u_rel, double nearness,
                  const WaterAtBall& water) {
  const double along = u_rel.dot(water.axis_W);
  const double across_m = 2 * (water.bore_radius_m - c.radius_m) - water.wall_gap_m;
  const double share = nearness - CalcWallNearness(across_m, c.radius_m);
  return c.lift_scale_kg_m * share * along * along * water.from_wall_W;
}

/// With S |v|^2 = r |w| |v| the square root is finite at rest.
Vector3d CalcMagnus(const FluidLoadCoefficients& c, const Vector3d& v_rel, const Vector3d& w_rel) {
  const double spin = c.magnus_m * c.magnus_m * w_rel.squaredNorm(), slip = v_rel.squaredNorm();
  if (slip == 0) return Vector3d::Zero();
  return c.magnus_scale_kg / std::sqrt(1 + spin / slip) * w_rel.cross(v_rel);
}

/// 1/2 rho r^5 C_w |w| w = 1/8 rho nu r^3 (C_w Re_w) w with Re_w = d^2 |w| / nu.
Vector3d CalcSpinTorque(const FluidLoadCoefficients& c, const Vector3d& w_rel, LoadNumbers& numbers) {
  numbers.spin_reynolds = c.diameter_m * c.diameter_m * w_rel.norm() / c.viscosity_m2_s;
  return -c.spin_scale_N_m_s * CalcSpinTorqueTimesReynolds(numbers.spin_reynolds) * w_rel;
}

double CalcAddedMass_kg(const BallParams& ball, double displaced_kg, double bore_radius_m) {
  return displaced_kg *
         ball.added_mass_coefficient.value_or(CalcAddedMassCoefficient(ball.radius_m / bore_radius_m));
}

void SetScales(const BallParams& ball, const ForceParams& forces, const WaterProperties& water,
               FluidLoadCoefficients& c) {
  const double r = ball.radius_m, rho = water.density_kg_m3, nu = water.kinematic_viscosity_m2_s;
  const double half_rho_area = 0.5 * rho * std::numbers::pi * r * r;
  c.spin_factor = forces.spin_torque ? ball.spin_drag_factor : 0;
  c.drag_scale_N_s_m = std::numbers::pi / 8 * rho * nu * 2 * r;
  c.spin_scale_N_m_s = c.spin_factor * rho * nu * r * r * r / 8;
  c.lift_scale_kg_m = forces.lift ? half_rho_area * ball.lift_coefficient : 0;
  c.magnus_scale_kg = forces.magnus ? half_rho_area * ball.magnus_coefficient * r : 0;
  c.magnus_m = ball.magnus_coefficient * r / kMostMagnus;
}

std::vector<WallFactorTable> MakeWallFactors(WallFactorLaw law, double ball_radius_m,
                                             std::span<const double> bore_radii_m) {
  std::vector<double> ratios;
  for (const double radius_m : bore_radii_m) {
    if (ball_radius_m <= kMaxDiameterRatio * radius_m) ratios.push_back(ball_radius_m / radius_m);
  }
  std::ranges::sort(ratios);
  ratios.erase(std::unique(ratios.begin(), ratios.end()), ratios.end());
  std::vector<WallFactorTable> tables;
  for (const double ratio : ratios) tables.emplace_back(law, ratio);
  return tables;
}

}  // namespace

FluidLoadCoefficients CalcFluidLoadCoefficients(const BallParams& ball, const ForceParams& forces,
                                                const WaterProperties& water, const Vector3d& gravity_W,
                                                std::span<const double> bore_radii_m) {
  Demand(!bore_radii_m.empty(), "a ball is in some bore");
  FluidLoadCoefficients c;
  const double displaced_kg = water.density_kg_m3 * ball.volume_m3();
  c.weight_W_N = (ball.mass_kg() - displaced_kg) * gravity_W;
  c.added_mass_kg = CalcAddedMass_kg(ball, displaced_kg, bore_radii_m.front());
  c.inertial_mass_kg = ball.mass_kg() + c.added_mass_kg;
  c.accelerated_mass_kg = forces.fluid_acceleration ? displaced_kg + c.added_mass_kg : 0;
  c.pressed_volume_m3 = forces.pressure_fall ? ball.volume_m3() : 0;
  c.radius_m = ball.radius_m;
  c.diameter_m = 2 * ball.radius_m;
  c.viscosity_m2_s = water.kinematic_viscosity_m2_s;
  c.drag = {FindDragLaw(forces.drag).law, !ball.suppresses_drag_crisis()};
  c.rolling_drag = forces.rolling_drag;
  c.wall_factor = FindWallFactorLaw(forces.wall_factor).law;
  c.wall_factors = MakeWallFactors(c.wall_factor, ball.radius_m, bore_radii_m);
  SetScales(ball, forces, water, c);
  return c;
}

FluidLoad CalcFluidLoad(const FluidLoadCoefficients& c, const Vector3d& v_WB_W, const Vector3d& w_WB_W,
                        const WaterAtBall& water) {
  const Vector3d u_rel = water.velocity_W - v_WB_W, w_rel = w_WB_W - water.spin_W;
  const double nearness = CalcWallNearness(water.wall_gap_m, c.radius_m);
  FluidLoad load;
  load.numbers.diameter_ratio = c.radius_m / water.bore_radius_m;
  load.weight_W_N = c.weight_W_N;
  load.fluid_acceleration_W_N = c.accelerated_mass_kg * water.acceleration_W;
  load.pressure_fall_W_N = c.pressed_volume_m3 * water.pressure_fall_W_Pa_m;
  load.drag_over_slip_N_s_m = CalcDragOverSlip_N_s_m(c, u_rel, nearness, load.numbers);
  load.drag_W_N = load.drag_over_slip_N_s_m * u_rel;
  load.lift_W_N = CalcLift(c, u_rel, nearness, water);
  load.magnus_W_N = CalcMagnus(c, -u_rel, w_rel);
  load.spin_torque_W_N_m = CalcSpinTorque(c, w_rel, load.numbers);
  return load;
}

}  // namespace piperun::sim
