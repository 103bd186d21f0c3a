#include "sim/drag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace piperun::sim {
namespace {

TEST(Drag, BrownAndLawlerMatchesTheTable) {
  // Re and the correlation's value, rounded to four decimals (the first to three)
  constexpr double kTable[][2] = {{1, 27.600},   {10, 4.1275},  {100, 1.0731}, {1e3, 0.4634},
                                  {1e4, 0.4106}, {1e5, 0.4661}, {2e5, 0.4635}, {3e5, 0.4600}};
  for (const auto& [re, cd] : kTable) EXPECT_NEAR(CalcDragCoefficient(re), cd, re == 1 ? 5e-4 : 5.1e-5) << re;
}

TEST(Drag, AgreesWithCliftAndGauvinsRefitWithinOnePercent) {
  for (double re = 10; re < 2e5; re *= 1.1) {
    const double clift_gauvin =
        24 / re * (1 + 0.152 * std::pow(re, 0.677)) + 0.417 / (1 + 5070 * std::pow(re, -0.94));
    EXPECT_NEAR(CalcDragCoefficient(re) / clift_gauvin, 1, 0.01) << re;
  }
}

TEST(Drag, IsStokesDragAtRest) { EXPECT_EQ(CalcDragTimesReynolds(0), 24); }

TEST(Drag, GrowsWithoutJumpsUpToAMillion) {
  double before = CalcDragTimesReynolds(1e-2);
  for (double re = 1e-2 * 1.001; re < 1e6; re *= 1.001) {
    const double now = CalcDragTimesReynolds(re);
    EXPECT_GT(now, before);
    EXPECT_LT(now / before, 1.0025) << re;  // force grows at most as Re^2
    before = now;
  }
}

TEST(WallFactor, MatchesTheHighReynoldsTable) {
  // Re -> infinity: l0 = 1.2, p = 2.3; at l = 0.6 (1 - 0.30886)/(1 + 0.20306) = 0.57449
  constexpr double kTable[][2] = {{0.1, 0.992}, {0.2, 0.960},   {0.3, 0.900}, {0.4, 0.813},
                                  {0.5, 0.703}, {0.6, 0.57449}, {0.8, 0.288}};
  for (const auto& [l, f] : kTable) EXPECT_NEAR(CalcWallFactor(l, 1e12), f, 5.1e-4) << l;
}

TEST(WallFactor, IsNewtonsAtHighReynolds) {
  for (double l = 0.05; l <= 0.6; l += 0.05) {
    const double newton = (1 - l * l) * std::sqrt(1 - 0.5 * l * l);
    EXPECT_NEAR(CalcWallFactor(l, 1e12) / newton, 1, 0.015) << l;
  }
}

TEST(WallFactor, IsNearHabermanAndSayreInStokesFlow) { EXPECT_NEAR(CalcWallFactor(0.1, 0), 0.792, 0.005); }

TEST(WallFactor, HasNoJumpWhereItsExponentChanges) {
  for (double l = 0.05; l < 0.95; l += 0.05) {
    EXPECT_NEAR(CalcWallFactor(l, 35.0000001) / CalcWallFactor(l, 35), 1, 2e-3) << l;
  }
}

TEST(SpinTorque, IsStokesTorqueWhenSlow) {
  // T = 8 pi mu r^3 w = 1/8 rho nu r^3 (C_w Re_w) w
  EXPECT_DOUBLE_EQ(CalcSpinTorqueTimesReynolds(1) / 8, 8 * std::numbers::pi);
}

TEST(SpinTorque, BranchesMeet) {
  EXPECT_NEAR(CalcSpinTorqueTimesReynolds(32.000001) / CalcSpinTorqueTimesReynolds(32), 1, 2e-3);
}

TEST(SpinTorque, IsSawatzkisBoundaryLayerLawOnTheRadius) {
  // C_w = 6.45 Re_r^-1/2 + 32.1 / Re_r with Re_r = r^2 w / nu = Re_w / 4
  const double re_r = 3e4;
  const double sawatzki = 6.45 / std::sqrt(re_r) + 32.1 / re_r;
  EXPECT_NEAR(CalcSpinTorqueTimesReynolds(4 * re_r) / (4 * re_r) / sawatzki, 1, 1e-12);
}

}  // namespace
}  // namespace piperun::sim
