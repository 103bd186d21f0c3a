#include "sim/rolling_drag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace piperun::sim {
namespace {

double RollingDrag(double re) { return CalcRollingDragTimesReynolds(re) / re; }

TEST(RollingDrag, IsJanAndChens) {
  // worked by hand from the printed law: 10^(3.02 - 1.89 L + 0.411 L^2 - 0.033 L^3)
  EXPECT_NEAR(RollingDrag(1), 322, 0.2);
  EXPECT_NEAR(RollingDrag(100), std::pow(10, 0.62), 1e-12);    // 4.17
  EXPECT_NEAR(RollingDrag(1e3), std::pow(10, 0.158), 1e-12);   // 1.44
  EXPECT_NEAR(RollingDrag(1e4), std::pow(10, -0.076), 1e-12);  // 0.84
  EXPECT_EQ(RollingDrag(1e5), 0.74);
}

TEST(RollingDrag, HasNoJump) {
  double before = RollingDrag(1e-2);
  for (double re = 1e-2 * 1.0001; re < 1e6; re *= 1.0001) {
    const double now = RollingDrag(re);
    EXPECT_NEAR(now / before, 1, 1.2e-4) << re;  // steepest at Re = 10: -1.89 + 0.822 - 0.099 = -1.17
    before = now;
  }
}

TEST(ContactDrag, IsNeverLessThanNothing) {
  // in the crisis of a smooth sphere as little as with a full spin torque in creeping flow
  for (double re = 1e-3; re < 1e6; re *= 1.1) EXPECT_GE(CalcContactDragTimesReynolds(re, 24, 1), 0) << re;
  EXPECT_EQ(CalcContactDragTimesReynolds(1e3, 1e4, 1), 0);
}

TEST(ContactDrag, LeavesTheTorqueOfTheSpinToTheSpin) {
  // free + contact + torque/r = Jan & Chen: with Re_w = 2 Re, T/r over 1/2 rho pi r^2 V^2 is k C_w/pi
  const double re = 5e3, k = 0.6, free = 0.41 * re;
  const double c_w = 12.9 / std::sqrt(2 * re) + 128.4 / (2 * re);
  const double sum = (free + CalcContactDragTimesReynolds(re, free, k)) / re + k * c_w / std::numbers::pi;
  EXPECT_NEAR(sum, RollingDrag(re), 1e-12);
}

TEST(WallNearness, FallsWithTheCubeOfTheDistance) {
  EXPECT_EQ(CalcWallNearness(0, 0.03), 1);
  EXPECT_DOUBLE_EQ(CalcWallNearness(0.03, 0.03), 0.125);
}

}  // namespace
}  // namespace piperun::sim
