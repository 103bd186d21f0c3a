#include "sim/ball.h"

#include <numbers>

namespace piperun::sim {

double BallParams::volume_m3() const { return 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m; }

double BallParams::mass_kg() const { return density_kg_m3 * volume_m3(); }

void BallParams::Visit(ParamVisitor& v) {
  v.Number({"radius_m", "Radius of the ball."}, {.min = 0, .max = 1, .min_open = true}, radius_m);
  v.Number({"density_kg_m3", "Mean density: mass over volume."}, Range::Between(100, 20000), density_kg_m3);
  v.Number({"inertia_factor", "Moment of inertia over m r^2: 0.4 for a solid ball, 2/3 for a thin shell."},
           {.min = 0, .max = 2.0 / 3.0, .min_open = true}, inertia_factor);
  v.Number({"friction", "Coulomb coefficient of the ball sliding on the wet wall."}, Range::Between(0, 2),
           friction);
  v.Number(
      {"rolling_resistance",
       "c_rr: rolling is resisted by the torque c_rr r N; hard plastic 0.002-0.005, soft foam 0.01-0.05."},
      Range::Between(0, 0.5), rolling_resistance);
  v.NumberOr(
      {"contact_stiffness_N_m",
       "Force over overlap of ball and wall: soft foam 2000-10000; rigid: walls stop the ball within one "
       "step of the physics."},
      Range::Between(100, 1e9), "rigid", contact_stiffness_N_m);
  v.Number(
      {"contact_damping_N_s_m",
       "Force over the speed of the overlap, where the contact has a stiffness; 2 sqrt(k m) lets nothing "
       "bounce."},
      Range::Between(0, 1e5), contact_damping_N_s_m);
  v.Number({"added_mass_coefficient",
            "Water that moves with the ball, as a fraction of what it displaces: 0.5 far from walls, 0.62 "
            "along one."},
           Range::Between(0, 1), added_mass_coefficient);
  v.Number(
      {"spin_drag_factor", "k_spin: share of a free sphere's spin torque that acts on a ball at the wall."},
      Range::Between(0, 2), spin_drag_factor);
  v.Number({"clock_offset_s", "What the robot's clock shows at the instant of release."},
           Range::Between(-1e6, 1e6), clock_offset_s);
  v.Number({"clock_drift_ppm", "How much faster than true time the robot's clock runs."},
           Range::Between(-1000, 1000), clock_drift_ppm);
}

}  // namespace piperun::sim
