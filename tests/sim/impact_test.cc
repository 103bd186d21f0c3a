#include "sim/impact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kDt = 1e-3, kGravity = 9.80665;

TEST(Impact, ClosingSpeedIsThatOfTheFallOntoTheWall) {
  // 20 mm of fall in all, of which 0.1 mm are left
  const double v = std::sqrt(2 * kGravity * 0.0199);
  EXPECT_NEAR(CalcClosingSpeed_m_s({1e-4, -v, -kGravity}, kDt), std::sqrt(2 * kGravity * 0.02), 1e-15);
}

TEST(Impact, NothingClosesThatDoesNotReachTheWallWithinTheStep) {
  EXPECT_EQ(CalcClosingSpeed_m_s({4e-4, -0.3, 0}, kDt), 0);
  EXPECT_GT(CalcClosingSpeed_m_s({2.9e-4, -0.3, 0}, kDt), 0);
  EXPECT_EQ(CalcClosingSpeed_m_s({0, 0.3, -kGravity}, kDt), 0);
}

TEST(Impact, FollowingAWallIsNone) {
  // at rest, pressed on: loads alone would have it half a step's gain into the wall
  EXPECT_EQ(CalcClosingSpeed_m_s({0, -0.5 * kGravity * kDt, -kGravity}, kDt), 0);
  EXPECT_EQ(CalcReboundGap_m({0, -0.5 * kGravity * kDt, -kGravity}, 1, kDt), 0);
}

TEST(Impact, ReboundHasTheSquareOfTheRestitutionOfTheEnergy) {
  const double e = 0.6, z = 3e-4, v = -0.5;
  const double height = z + v * v / (2 * kGravity);
  const double after = CalcReboundGap_m({z, v, -kGravity}, e, kDt);
  const double v_start = (after - z) / kDt + 0.5 * kGravity * kDt;  // of the parabola through z and `after`
  EXPECT_NEAR((z + v_start * v_start / (2 * kGravity)) / (e * e * height), 1, 1e-12);
}

TEST(Impact, SlowOnesStayOnTheWall) {
  EXPECT_EQ(CalcReboundGap_m({1e-6, -0.0099, 0}, 0.9, kDt), 0);
  EXPECT_NEAR(CalcReboundGap_m({1e-6, -0.0101, 0}, 0.9, kDt), 1e-6 + 0.9 * 0.0101 * kDt, 1e-18);
  EXPECT_EQ(CalcReboundGap_m({1e-5, -0.013, -kGravity}, 0.9, kDt), 0);  // gravity adds 9.8 mm/s a step
  EXPECT_EQ(CalcReboundGap_m({1e-5, -0.3, -kGravity}, 0, kDt), 0);
}

}  // namespace
}  // namespace piperun::sim
