#include "sim/flow_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/hydraulics.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::MakePipeLine;
using testing::PipeLine;

const WaterProperties kWater{20, 1000, 1e-6, 1482};
constexpr double kGravity = 9.81;

SteadyFlow Solve(const PipeLine& line, double speed_m_s) {
  const double flow = speed_m_s * line.network.pipe(0).area_m2();
  return SolveSteadyFlow(line.network, line.route, {flow, 2e5}, {}, kWater, kGravity);
}

/// The spot of a point that lies in a given pipe.
NetworkSpot SpotIn(const Network& network, int pipe, const Vector3d& p_W) {
  const auto& pieces = network.pipe(pipe).centreline;
  NetworkSpot spot{pipe, 0, 0, {}};
  double nearest = 1e300;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double s = std::clamp(FindNearest(pieces[i], p_W), pieces[i].s_begin_m, pieces[i].s_end_m());
    const CentrelinePoint axis = EvalCentreline(pieces[i], s);
    if ((axis.p_W - p_W).norm() >= nearest) continue;
    nearest = (axis.p_W - p_W).norm();
    spot = {pipe, i, s, axis};
  }
  return spot;
}

WaterAtBall EvalAt(const PipeLine& line, const SteadyFlow& flow, const Vector3d& p_W) {
  const Bore bore(line.network);
  const FlowField field(bore, flow.timeline, kWater, kGravity, 0.03);
  return field.Eval(SpotIn(line.network, 0, p_W), p_W, {});
}

TEST(FlowField, OnTheInvertOfAStraightPipe) {
  const PipeLine line = MakePipeLine({{0, 0, 5}, {100, 0, 5}}, {.roughness_m = 1e-4});
  const SteadyFlow flow = Solve(line, 1);
  const WaterAtBall water = EvalAt(line, flow, {10, 0, 5 - 0.045});
  // f = 0.02011: n = 7.05, u_eff/U between 1.035 (n = 7) and 1.031 (n = 8)
  EXPECT_NEAR(water.velocity_W.x(), 1.0348, 5e-4);
  EXPECT_EQ(water.velocity_W.tail<2>().norm(), 0);
  EXPECT_EQ(water.acceleration_W.norm(), 0);
  // slower towards the wall, that is downwards: the shear turns things about +y, like rolling
  EXPECT_GT(water.spin_W.y(), 1);
  EXPECT_NEAR(water.spin_W.x(), 0, 1e-15);
  // -dp/ds = f/D rho U^2/2 = 0.02011/0.15 * 500 = 67.0 Pa/m; REF: 7.6 mN on the ball
  EXPECT_NEAR(water.pressure_fall_W_Pa_m.x(), 67.03, 0.02);
  EXPECT_NEAR(water.pressure_Pa, 2e5 - 67.03 * 10 + 1000 * kGravity * 0.045, 0.3);
  EXPECT_DOUBLE_EQ(water.bulk_speed_m_s, 1);
}

TEST(FlowField, TurnsAsAFreeVortexInABend) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, {.bend_radius_m = 0.5});
  const SteadyFlow flow = Solve(line, 1);
  // middle of the bend; its centre is (9.5, 0.5); outward is (1, -1)/sqrt(2)
  const Vector3d outward = Vector3d(1, -1, 0).normalized(), centre(9.5, 0.5, 0);
  const WaterAtBall outer = EvalAt(line, flow, centre + 0.54 * outward);
  const WaterAtBall inner = EvalAt(line, flow, centre + 0.46 * outward);
  EXPECT_NEAR(outer.velocity_W.norm() * 0.54, inner.velocity_W.norm() * 0.46, 1e-12);
  EXPECT_NEAR((outer.acceleration_W + outer.velocity_W.squaredNorm() / 0.54 * outward).norm(), 0, 1e-12);
  EXPECT_NEAR((inner.acceleration_W + inner.velocity_W.squaredNorm() / 0.46 * outward).norm(), 0, 1e-12);
}

TEST(FlowField, RunsAgainstThePipeWhereTheFlowDoes) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {50, 0, 0}});
  const Route back = FindRoute(line.network, 1, 0);
  const SteadyFlow flow = SolveSteadyFlow(line.network, back, {0.01, 2e5}, {}, kWater, kGravity);
  const WaterAtBall water = EvalAt(line, flow, {30, 0, -0.045});
  EXPECT_LT(flow.timeline.Eval(0, 30, {}).flow_m3_s, 0);
  EXPECT_LT(water.bulk_speed_m_s, 0);
  EXPECT_LT(water.velocity_W.x(), 0);
  EXPECT_LT(water.pressure_fall_W_Pa_m.x(), 0);
}

TEST(FlowField, IsAtRestInStillWater) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {50, 0, 0}});
  const WaterAtBall water = EvalAt(line, Solve(line, 0), {20, 0.01, 0});
  EXPECT_EQ(water.velocity_W.norm(), 0);
  EXPECT_EQ(water.spin_W.norm(), 0);
  EXPECT_NEAR(water.pressure_Pa, 2e5, 1e-9);
}

TEST(FlowField, AConeTowardsAPipeTooNarrowForTheBallHasFlowWhereItFits) {
  // 150 to 80 mm over 140 mm: the bore's radius falls by a quarter of the way; a ball of 78 mm fits to a bore
  // of 78/0.95 mm. It sees more than the mean speed, for it is in the middle, and no more than if all the
  // water went through its disc.
  std::vector<PipeSpec> pipes{testing::MakePipeSpec("P", "A", "M"),
                              testing::MakePipeSpec("Q", "M", "B", {.diameter_m = 0.08})};
  const Network network({{"A", {0, 0, 0}}, {"M", {2, 0, 0}}, {"B", {5, 0, 0}}}, pipes);
  const double flow_m3_s = 0.3 * network.pipe(0).area_m2(), ball_m = 0.039;
  const FlowState state{{{{0, 2, flow_m3_s, 50, 50, 0.02}}, {{0, 3, flow_m3_s, 50, 50, 0.02}}}};
  const FlowTimeline timeline({network.pipe(0).area_m2(), network.pipe(1).area_m2()}, {TrueTime{}}, {state});
  const Bore bore(network);
  const FlowField field(bore, timeline, kWater, kGravity, ball_m);
  double last = 0.3;
  for (const double s_m : {0.02, 0.06, 0.1, 4 * (0.075 - ball_m / 0.95) - 1e-9}) {
    const Vector3d p(2 + s_m, 0, 0);
    const double radius_m = 0.075 - s_m / 4, mean = flow_m3_s / (M_PI * radius_m * radius_m);
    const double speed = field.Eval(SpotIn(network, 1, p), p, {}).velocity_W.x();
    EXPECT_GT(speed, last) << s_m;
    EXPECT_GT(speed, mean) << s_m;
    EXPECT_LT(speed, mean * std::pow(radius_m / ball_m, 2)) << s_m;
    last = speed;
  }
}

}  // namespace
}  // namespace piperun::sim
