#include "sim/ball_mass.h"

#include <cmath>

namespace piperun::sim {

BallMass CalcBallMass(const BallParams& ball, double added_mass_kg) {
  const double m = ball.mass_kg(), total = m + added_mass_kg;
  const Vector3d& r = ball.center_of_mass_B_m;
  BallMass mass{total, m / total * r, ball.Inertia_B_kg_m2()};
  if (!r.isZero(0)) {
    mass.inertia_B_kg_m2 +=
        m * added_mass_kg / total * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  }
  return mass;
}

double CalcContactFrequency_rad_s(double stiffness_N_m, double mass_kg) {
  return std::sqrt(stiffness_N_m / mass_kg);
}

}  // namespace piperun::sim
