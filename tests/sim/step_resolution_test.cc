#include "sim/step_resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/pose.h"

namespace piperun::sim {
namespace {

bool Says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(StepResolution, SaysNothingOfAUsualRun) {
  // a ball of 60 mm that rolls at 1 m/s through a bend of 1.5 bores of 150 mm, 1000 steps a second: it spins
  // at 33 rad/s and turns by 1/0.225 rad/s
  StepResolution steps(Rate(1000), 0.07);
  steps.AddMotion(1 / 0.03, 1, 1 / 0.225);
  EXPECT_EQ(steps.HoldDrag(1e-3), 1);
  EXPECT_TRUE(steps.Warnings().empty());
}

TEST(StepResolution, WarnsOfSpinWithFigureLimitAndRate) {
  // 40 rad/s at 100 steps a second are 0.4 rad, twice what is allowed: 200 steps would do
  StepResolution steps(Rate(100), 0);
  steps.AddMotion(40, 0, 0);
  steps.AddMotion(1, 0, 0);
  const auto warnings = steps.Warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings[0], "0.4 rad in a step; beyond 0.2 rad")) << warnings[0];
  EXPECT_TRUE(Says(warnings[0], "raise motion.rate_Hz to 200 at least")) << warnings[0];
}

TEST(StepResolution, TheLimitOfSpinIsWhatItsReasonSays) {
  // a vector that turns by phi in a step has a mean over it that is short by 1 - sin(phi/2)/(phi/2)
  const double half = 0.5 * kMaxSpinPerStep_rad;
  EXPECT_LT(1 - std::sin(half) / half, 0.002);
  EXPECT_GT(1 - std::sin(half) / half, 0.0015);
}

TEST(StepResolution, ASpinAxisThatTurnsKeepsTheAttitudeAtTheLimit) {
  // a ball spins about an axis that turns about the vertical, as in a bend; in the turning frame it spins
  // steadily: q = Exp(turn z) Exp((w - turn z) t). Steps with w of their middle stay within 2e-4 rad.
  const double dt = 1e-3, spin = kMaxSpinPerStep_rad / dt, turn = 5;
  const Vector3d w(0, spin, 0), z(0, 0, turn);
  Quaterniond q = Quaterniond::Identity();
  for (int k = 0; k * dt < 0.5 * std::numbers::pi / turn; ++k) {
    q = ExpSO3(ExpSO3(z * ((k + 0.5) * dt)) * w * dt) * q;
    const Quaterniond exact = ExpSO3(z * ((k + 1) * dt)) * ExpSO3((w - z) * ((k + 1) * dt));
    ASSERT_LT(q.angularDistance(exact), 2e-4) << k;
  }
}

TEST(StepResolution, WarnsOfBendsThatPassInAFewSteps) {
  // 3 m/s through a bend of 0.15 m at 100 steps a second: 0.2 rad a step, a right angle in 7.85; 0.05 needs
  // 400
  StepResolution steps(Rate(100), 0);
  steps.AddMotion(0, 3, 1 / 0.15);
  const auto warnings = steps.Warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings[0], "0.2 rad in a step, a right angle in 7.85 steps")) << warnings[0];
  EXPECT_TRUE(Says(warnings[0], "raise motion.rate_Hz to 400 at least")) << warnings[0];
}

TEST(StepResolution, WarnsOfAContactTheStepDamps) {
  const auto warnings = StepResolution(Rate(1000), 0.4).Warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings[0], "after 7.85 steps, and the step adds 0.2 of the critical")) << warnings[0];
  EXPECT_TRUE(Says(warnings[0], "raise motion.rate_Hz to 2000 at least")) << warnings[0];
}

TEST(StepResolution, TheDampingOfTheStepIsThatOfAnImplicitSpring) {
  // v+ = v - w^2 dt (x + dt v+), x+ = x + dt v+: the state shrinks by 1/sqrt(1 + phi^2) a step and swings by
  // atan(phi); its damping ratio is their logarithmic quotient, phi/2 for small phi
  const double phi = kMaxContactPhase_rad, dt = 1e-3, w2 = phi * phi / (dt * dt);
  double x = 1e-3, v = 0, turn = 0;
  const double begin = w2 * x * x;
  for (int i = 0; i < 100; ++i) {
    v = (v - w2 * dt * x) / (1 + w2 * dt * dt);
    x += dt * v;
    turn += std::atan(phi);
  }
  // w^2 x^2 + v^2 wavers by 1 + phi within a swing: 0.5 log(1.2)/turn = 0.005 after 100 steps
  const double shrink = 0.5 * std::log((w2 * x * x + v * v) / begin) / turn;
  EXPECT_NEAR(-shrink, 0.5 * phi, 0.05 * phi);
}

TEST(StepResolution, HoldsDragBackWhereAStepCannotFollow) {
  StepResolution steps(Rate(1000), 0);
  EXPECT_EQ(steps.HoldDrag(0.5), 1);
  EXPECT_LT(steps.HoldDrag(1.7) * 1.7, 0.9);  // the scheme's own limit is 1
  EXPECT_LT(steps.HoldDrag(1e6) * 1e6, 0.9 + 1e-9);
  const auto warnings = steps.Warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings[0], "drag was held back in 2 steps")) << warnings[0];
  EXPECT_TRUE(Says(warnings[0], "a motion.rate_Hz of 2000000000, beyond the 10000 allowed") ||
              Says(warnings[0], "a motion.rate_Hz of 2e+09, beyond the 10000 allowed"))
      << warnings[0];
}

TEST(StepResolution, RefusesAContactWithinThreeSteps) {
  // M = 0.18 kg, k = 10 kN/m: w_c = 235.7 rad/s, so 236 steps a second are the fewest
  EXPECT_NEAR(CalcContactPhase_rad(1e4, 0.18, Rate(1000)), 0.2357, 1e-4);
  EXPECT_NO_THROW(RequireResolvedContact(1e4, 0.18, Rate(236)));
  try {
    RequireResolvedContact(1e4, 0.18, Rate(200));
    FAIL() << "half a period of 13.3 ms in steps of 5 ms";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), "ball.contact_stiffness_N_m");
    EXPECT_TRUE(Says(e.problem(), "raise motion.rate_Hz to 236 at least")) << e.problem();
    EXPECT_TRUE(Says(e.problem(), "up to 7.2e+03 N/m at this rate")) << e.problem();
  }
}

}  // namespace
}  // namespace piperun::sim
