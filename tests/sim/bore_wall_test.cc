#include "sim/tube_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::MakePipeLine;
using testing::PipeLine;

constexpr double kBore = 0.075, kBall = 0.03;

PipeLine MakeBend() {
  return MakePipeLine({{0, 0, 0}, {2, 0, 0}, {2, 1.5, 1}, {4, 3, 1}}, {.bend_radius_m = 0.25});
}

/// Distance from the axis by looking everywhere along it.
double BruteDistance(const Route& route, const Vector3d& p_W) {
  double best = 1e9;
  const int n = 400000;
  for (int i = 0; i <= n; ++i) best = std::min(best, (route.Eval(route.length_m() * i / n).p_W - p_W).norm());
  return best;
}

TEST(TubeWall, GapIsTheDistanceToTheNearestWall) {
  const PipeLine line = MakeBend();
  const TubeWall wall(line.route);
  for (const double chainage : {0.4, 1.85, 2.0, 2.9, 3.4, 4.9}) {
    const CentrelinePoint axis = line.route.Eval(chainage);
    const Vector3d side = axis.tangent_W.unitOrthogonal();
    const Vector3d p_W = axis.p_W + 0.031 * side + 0.017 * axis.tangent_W.cross(side);
    const RouteSpot spot = FindRouteSpot(line.route, p_W, line.route.FindPiece(chainage));
    const WallContact contact = wall.Probe(spot, wall.X_FW(spot.piece) * p_W, Vector3d::Zero(), kBall, 1e-3);
    EXPECT_NEAR(contact.gap_m, kBore - kBall - BruteDistance(line.route, p_W), 1e-9) << chainage;
    const Vector3d normal_W = wall.X_WF(spot.piece).q * contact.normal_F;
    EXPECT_NEAR((normal_W - (spot.axis.p_W - p_W).normalized()).norm(), 0, 1e-12);
  }
}

TEST(TubeWall, GapIsPredictedWhereTheStepLeads) {
  // straight pipe: moving sideways by a at distance e from the axis leads to sqrt(e^2 + a^2)
  const PipeLine line = MakePipeLine({{0, 0, 0}, {10, 0, 0}});
  const TubeWall wall(line.route);
  const Vector3d p_W(5, 0, -0.045);
  const RouteSpot spot = FindRouteSpot(line.route, p_W, 0);
  const Vector3d v_W(0.7, 0.4, -0.2);
  const WallContact contact = wall.Probe(spot, wall.X_FW(0) * p_W, wall.X_FW(0).q * v_W, kBall, 0.01);
  EXPECT_NEAR(contact.gap_m, 0.045 - std::hypot(0.045, 0.004), 1e-15);
}

TEST(TubeWall, PredictionCrossesIntoTheBend) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}}, {.bend_radius_m = 0.5});
  const TubeWall wall(line.route);
  const Vector3d p_W(1.4995, 0, -0.045);  // the bend begins at x = 1.5 about (1.5, 0.5)
  const RouteSpot spot = FindRouteSpot(line.route, p_W, 0);
  ASSERT_EQ(spot.piece, 0U);
  const WallContact contact =
      wall.Probe(spot, wall.X_FW(0) * p_W, wall.X_FW(0).q * Vector3d(10, 0, 0), kBall, 1e-3);
  const double outward = std::hypot(0.0095, 0.5) - 0.5;  // p' = (1.5095, 0)
  EXPECT_NEAR(contact.gap_m, 0.045 - std::hypot(outward, 0.045), 1e-14);
}

TEST(TubeWall, SeesNoWallFromTheAxisOrFromAfar) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {10, 0, 0}});
  const TubeWall wall(line.route);
  const auto probe = [&](const Vector3d& p_W, const Vector3d& v_W) {
    return wall.Probe(FindRouteSpot(line.route, p_W, 0), wall.X_FW(0) * p_W, wall.X_FW(0).q * v_W, kBall,
                      1e-3);
  };
  EXPECT_FALSE(probe({5, 0, 0}, {1, 0, 0}).near);
  EXPECT_FALSE(probe({5, 0, -0.042}, {1, 0, 0}).near);
  EXPECT_TRUE(probe({5, 0, -0.0435}, {1, 0, 0}).near);
  EXPECT_TRUE(probe({5, 0, -0.03}, {0, 0, -15}).near) << "fast enough to pass through within the step";
}

}  // namespace
}  // namespace piperun::sim
