#include "base/polyline.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

#include "base/check.h"
#include "tests/support/any.h"

namespace piperun {
namespace {

void ExpectAt(const Vector3d& p, const Vector3d& expected) {
  EXPECT_NEAR((p - expected).norm(), 0, 1e-12) << p.transpose();
}

// 13^2 = 12^2 + 5^2, and the plan's direction is (3, 4)/5
TEST(StretchToLength, KeepsTheRiseAndThePlanDirection) {
  const auto line = StretchToLength({{1, 2, 3}, {4, 6, 8}}, 13);
  ExpectAt(line[0], {1, 2, 3});
  ExpectAt(line[1], {1 + 7.2, 2 + 9.6, 8});
}

TEST(StretchToLength, ShortensAsWellAsItLengthens) {
  const auto line = StretchToLength({{0, 0, 0}, {300, 400, 5}}, 13);
  ExpectAt(line[1], {7.2, 9.6, 5});
}

// 3 f + 4 = 10: the level straight takes all of the slack, the riser none
TEST(StretchToLength, ARiserInTheLineKeepsItsLength) {
  const auto line = StretchToLength({{0, 0, 0}, {3, 0, 0}, {3, 0, 4}}, 10);
  ExpectAt(line[1], {6, 0, 0});
  ExpectAt(line[2], {6, 0, 4});
}

TEST(StretchToLength, AVerticalPipeAsLongAsItsRiseStaysVertical) {
  const auto line = StretchToLength({{1, 2, 3}, {1, 2, -4}}, 7);
  ExpectAt(line[1], {1, 2, -4});
}

TEST(StretchToLength, SlackOfAPointInPlanRunsEast) {
  ExpectAt(StretchToLength({{1, 2, 3}, {1, 2, 6}}, 5)[1], {5, 2, 6});
  ExpectAt(StretchToLength({{1, 2, 3}, {1, 2, 3}}, 7)[1], {8, 2, 3});
}

TEST(StretchToLength, ALengthBelowTheRiseIsRefusedWithBoth) {
  try {
    StretchToLength({{0, 0, 0}, {1, 0, 3}, {2, 0, 1}}, 4.5);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(e.problem().find("length 4.5 m is shorter than the rise of 5 m"), std::string::npos)
        << e.what();
  }
}

RC_GTEST_PROP(StretchToLength, HasTheLengthAndChangesNothingElse, ()) {
  std::vector<Vector3d> drawn{1e3 * any::UnitVector()};
  double rise = 0;
  for (int i = 0; i < 5; ++i) {
    drawn.push_back(drawn.back() + any::Between(0.1, 100) * any::UnitVector());
    rise += std::abs(drawn.back().z() - drawn[drawn.size() - 2].z());
  }
  const double length_m = rise + std::pow(10, any::Between(-6, 3));
  const auto line = StretchToLength(drawn, length_m);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    sum += (line[i + 1] - line[i]).norm();
    RC_ASSERT(line[i].z() == drawn[i].z());
    const Vector3d before = drawn[i + 1] - drawn[i], after = line[i + 1] - line[i];
    // positions carry 1e-13 m of rounding at 1 km from the origin
    RC_ASSERT(std::abs(before.x() * after.y() - before.y() * after.x()) <= 1e-11 * before.norm());
  }
  RC_ASSERT(std::abs(sum - length_m) <= 1e-12 * (length_m + 1e3));
}

TEST(CalcTurn, IsTheAngleBetweenDirections) {
  EXPECT_DOUBLE_EQ(CalcTurn_rad(Vector3d::UnitX(), Vector3d::UnitZ()), M_PI / 2);
  EXPECT_EQ(CalcTurn_rad(Vector3d::UnitX(), Vector3d::UnitX()), 0);
  EXPECT_DOUBLE_EQ(CalcTurn_rad(Vector3d::UnitX(), -Vector3d::UnitX()), M_PI);
}

}  // namespace
}  // namespace piperun
