#include "sim/ball.h"

#include <Eigen/Eigenvalues>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun::sim {

double BallParams::volume_m3() const { return 4.0 / 3.0 * std::numbers::pi * radius_m * radius_m * radius_m; }

double BallParams::mass_kg() const { return given_mass_kg.value_or(density_kg_m3 * volume_m3()); }

Matrix3d BallParams::Inertia_B_kg_m2() const {
  if (inertia_kg_m2.empty()) return inertia_factor * mass_kg() * radius_m * radius_m * Matrix3d::Identity();
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(inertia_kg_m2.data());
}

void BallParams::Check() const {
  if (center_of_mass_B_m.norm() >= radius_m) {
    throw InputError("the centre of mass lies " + FormatNumber(center_of_mass_B_m.norm()) +
                         " m from the centre of a ball of radius " + FormatNumber(radius_m) +
                         " m; it must lie inside",
                     "ball.center_of_mass_m");
  }
  if (foam_thickness_m >= radius_m) {
    throw InputError("a foam shell of " + FormatNumber(foam_thickness_m) +
                         " m leaves no core in a ball of radius " + FormatNumber(radius_m) +
                         " m; it must be thinner",
                     "ball.foam_thickness_m");
  }
  if (inertia_kg_m2.empty()) return;
  if (inertia_kg_m2.size() != 9) {
    throw InputError("the inertia tensor has " + std::to_string(inertia_kg_m2.size() / 3) +
                         " rows; give three rows of three numbers, or none",
                     "ball.inertia_kg_m2");
  }
  const Matrix3d inertia = Inertia_B_kg_m2();
  const Vector3d principal = Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia).eigenvalues();
  const double scale = inertia.norm();
  if (!inertia.isApprox(inertia.transpose(), 1e-9) || !(principal.x() > 0) ||
      principal.z() > principal.x() + principal.y() + 1e-9 * scale) {
    throw InputError(
        "this is no body's inertia tensor: it must be symmetric, its principal moments positive and each at "
        "most "
        "the sum of the other two; they are " +
            FormatNumber(principal.x()) + ", " + FormatNumber(principal.y()) + ", " +
            FormatNumber(principal.z()) + " kg m2",
        "ball.inertia_kg_m2");
  }
}

void BallParams::Visit(ParamVisitor& v) {
  v.Number({"radius_m", "Radius of the ball."}, {.min = 0, .max = 1, .min_open = true}, radius_m);
  v.Number({"density_kg_m3", "Mean density: mass over volume."}, Range::Between(100, 20000), density_kg_m3);
  v.NumberOr({"mass_kg", "Mass, instead of the density."}, {.min = 1e-6, .max = 1e5}, "from_density",
             given_mass_kg);
  v.Number({"inertia_factor", "Moment of inertia over m r^2: 0.4 for a solid ball, 2/3 for a thin shell."},
           {.min = 0, .max = 2.0 / 3.0, .min_open = true}, inertia_factor);
  v.Table(
      {"inertia_kg_m2",
       "Inertia tensor about the centre of mass, three rows along the ball's axes; empty: inertia_factor m "
       "r^2 about every axis."},
      Range::Any(), 3, inertia_kg_m2);
  v.Vector({"center_of_mass_m", "Centre of mass seen from the ball's centre, along the ball's axes."},
           Range::Between(-1, 1), center_of_mass_B_m);
  v.Number({"roughness_m", "Height of the surface's roughness; from 1e-3 of the diameter on no drag crisis."},
           Range::Between(0, 0.1), roughness_m);
  v.Number({"foam_thickness_m", "Thickness of a soft shell inside the radius; 0: none."},
           Range::Between(0, 1), foam_thickness_m);
  v.Number({"friction", "Coulomb coefficient of the ball sliding on the wet wall."}, Range::Between(0, 2),
           friction);
  v.Number(
      {"rolling_resistance",
       "c_rr: rolling is resisted by the torque c_rr r N; hard plastic 0.002-0.005, soft foam 0.01-0.05."},
      Range::Between(0, 0.5), rolling_resistance);
  v.Number(
      {"spinning_resistance", "c_sp: spinning about the wall's normal is resisted by the torque c_sp r N."},
      Range::Between(0, 0.5), spinning_resistance);
  v.Number({"restitution",
            "Normal speed after an impact over the one before; 0 in water at the speeds of a pipe run."},
           Range::Between(0, 1), restitution);
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
  v.NumberOr({"added_mass_coefficient",
              "Water that moves with the ball, as a fraction of what it displaces: 0.5 far from walls, 0.62 "
              "along one, more in a narrow bore."},
             Range::Between(0, 5), "by_bore", added_mass_coefficient);
  v.Number(
      {"spin_drag_factor", "k_spin: share of a free sphere's spin torque that acts on a ball at the wall."},
      Range::Between(0, 2), spin_drag_factor);
  v.Number(
      {"lift_coefficient",
       "C_L of the lift away from a wall the ball touches, with the slip's part along the pipe; 0.1-0.3."},
      Range::Between(0, 1), lift_coefficient);
  v.Number({"magnus_coefficient", "C_M of the Magnus force per spin parameter w r / |u - v|; 0.1-0.4."},
           Range::Between(0, 2), magnus_coefficient);
  v.Number({"clock_offset_s", "What the robot's clock shows at the instant of release."},
           Range::Between(-1e6, 1e6), clock_offset_s);
  v.Number({"clock_drift_ppm", "How much faster than true time the robot's clock runs."},
           Range::Between(-1000, 1000), clock_drift_ppm);
}

}  // namespace piperun::sim
