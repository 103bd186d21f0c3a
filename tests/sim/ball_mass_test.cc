#include "sim/ball_mass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace piperun::sim {
namespace {

BallParams EccentricBall() {
  BallParams ball;
  ball.given_mass_kg = 0.13;
  ball.center_of_mass_B_m = {2e-3, -1e-3, -4e-3};
  ball.inertia_kg_m2 = {5e-5, 3e-6, -2e-6, 3e-6, 4e-5, 1e-6, -2e-6, 1e-6, 6e-5};
  return ball;
}

TEST(BallMass, HasTheKineticEnergyOfTheBallAndOfAPointMassOfWaterAtItsCentre) {
  const BallParams ball = EccentricBall();
  const double added_kg = 0.07;
  const BallMass mass = CalcBallMass(ball, added_kg);
  const RandomStream random(1, "velocities", 0);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto a = random.Normals(i, 0), b = random.Normals(i, 1);
    const Vector3d v(a[0], a[1], a[2]), w = 30 * Vector3d(b[0], b[1], b[2]);
    const Vector3d v_C = v + w.cross(ball.center_of_mass_B_m), v_M = v + w.cross(mass.p_BM_B);
    const double parts = 0.5 * added_kg * v.squaredNorm() + 0.5 * ball.mass_kg() * v_C.squaredNorm() +
                         0.5 * w.dot(ball.Inertia_B_kg_m2() * w);
    const double whole = 0.5 * mass.mass_kg * v_M.squaredNorm() + 0.5 * w.dot(mass.inertia_B_kg_m2 * w);
    EXPECT_NEAR(whole / parts, 1, 1e-15);
  }
}

TEST(BallMass, HasTheMomentumOfBothAboutTheCentre) {
  const BallParams ball = EccentricBall();
  const BallMass mass = CalcBallMass(ball, 0.07);
  const Vector3d v(0.4, -0.3, 0.2), w(10, -20, 15), r = ball.center_of_mass_B_m;
  const Vector3d parts = r.cross(0.13 * (v + w.cross(r))) + ball.Inertia_B_kg_m2() * w;
  const Vector3d whole =
      mass.p_BM_B.cross(mass.mass_kg * (v + w.cross(mass.p_BM_B))) + mass.inertia_B_kg_m2 * w;
  EXPECT_LT((whole - parts).norm(), 1e-15 * parts.norm());
}

TEST(BallMass, OfAHomogeneousSphereIsIsotropicToTheBit) {
  const BallMass mass = CalcBallMass(BallParams{}, 0.07);
  const double moment = mass.inertia_B_kg_m2(0, 0);
  EXPECT_EQ(mass.inertia_B_kg_m2, Matrix3d(moment * Matrix3d::Identity()));
  EXPECT_TRUE(mass.p_BM_B.isZero(0));
}

TEST(ContactFrequency, OfAFoamBallGivesItsKnownContactTime) {
  // 0.18 kg on 2 to 10 kN/m: half a period is 13 to 30 ms
  EXPECT_NEAR(std::acos(-1) / CalcContactFrequency_rad_s(2000, 0.18), 0.0298, 5e-5);
  EXPECT_NEAR(std::acos(-1) / CalcContactFrequency_rad_s(10000, 0.18), 0.0133, 5e-5);
}

}  // namespace
}  // namespace piperun::sim
