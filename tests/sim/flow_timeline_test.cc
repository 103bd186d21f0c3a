#include "sim/flow_timeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

constexpr double kViscosity = 1e-6, kRoughness = 1e-3;  // e/D
const double kArea = std::numbers::pi * 0.05 * 0.05;

TrueTime At(double seconds) { return TrueTime{FromSeconds(seconds)}; }

/// One pipe of 10 m, cut at 4 m; `leak` leaves there.
FlowState MakeState(double flow, double leak, double head) {
  return {{{{0, 4, flow, head, head - 1, 0.03}, {4, 10, flow - leak, head - 1, head - 4, 0.04}}}};
}

FlowTimeline MakeTimeline() {
  return FlowTimeline({kArea}, {At(0), At(100), At(400)},
                      {MakeState(0.01, 0, 50), MakeState(0.02, 0.004, 60), MakeState(-0.01, 0, 30)},
                      {{kRoughness}, kViscosity});
}

TEST(FlowTimeline, HoldsOneStateForEver) {
  const FlowTimeline flow({kArea}, {At(0)}, {MakeState(0.01, 0.002, 50)});
  for (const double t : {-1.0, 0.0, 1e6}) {
    const FlowPoint point = flow.Eval(0, 7, At(t));
    EXPECT_EQ(point.flow_m3_s, 0.01 - 0.002);
    EXPECT_EQ(point.friction_factor, 0.04);
    EXPECT_EQ(point.head_m, 47.5);
    EXPECT_EQ(point.dflow_dt_m3_s2, 0);
  }
}

TEST(FlowTimeline, GoesOverLinearlyBetweenInstants) {
  const FlowPoint point = MakeTimeline().Eval(0, 7, At(25));
  // a quarter of the way: 0.01 -> 0.016, head in the middle of the second reach 47.5 -> 57.5
  EXPECT_NEAR(point.flow_m3_s, 0.0115, 1e-17);
  EXPECT_NEAR(point.velocity_m_s, 0.0115 / kArea, 1e-14);
  EXPECT_NEAR(point.head_m, 50, 1e-13);
  EXPECT_NEAR(point.dflow_dt_m3_s2, 6e-5, 1e-18);
}

TEST(FlowTimeline, WorksFrictionOutFromTheFlowOfTheMoment) {
  const FlowPoint point = MakeTimeline().Eval(0, 2, At(50));
  const double reynolds = 0.015 / kArea * 0.1 / kViscosity;
  EXPECT_NEAR(point.friction_factor, CalcFrictionFactor(reynolds, kRoughness), 1e-15);
}

TEST(FlowTimeline, PassesThroughZeroWhereTheFlowTurnsRound) {
  const FlowTimeline flow = MakeTimeline();
  // 0.02 at 100 s, -0.01 at 400 s: zero at 300 s
  EXPECT_NEAR(flow.Eval(0, 1, At(300)).flow_m3_s, 0, 1e-17);
  double before = flow.Eval(0, 1, At(290)).flow_m3_s;
  for (double t = 290.5; t <= 310; t += 0.5) {
    const FlowPoint point = flow.Eval(0, 1, At(t));
    EXPECT_NEAR(point.flow_m3_s - before, -0.5e-4, 1e-15) << t;
    EXPECT_TRUE(std::isfinite(point.friction_factor));
    before = point.flow_m3_s;
  }
}

TEST(FlowTimeline, IsContinuousAtItsInstantsAndStaysAfterTheLast) {
  const FlowTimeline flow = MakeTimeline();
  EXPECT_NEAR(flow.Eval(0, 6, At(99.999999999)).flow_m3_s, flow.Eval(0, 6, At(100)).flow_m3_s, 1e-12);
  EXPECT_EQ(flow.Eval(0, 6, At(400)).flow_m3_s, -0.01);
  EXPECT_EQ(flow.Eval(0, 6, At(1e5)).flow_m3_s, -0.01);
  EXPECT_EQ(flow.Eval(0, 6, At(1e5)).dflow_dt_m3_s2, 0);
}

TEST(FlowTimelineDeathTest, RefusesReachesThatMove) {
  FlowState moved = MakeState(0.01, 0, 50);
  moved.pipes[0][0].s_end_m = moved.pipes[0][1].s_begin_m = 5;
  EXPECT_DEATH(FlowTimeline({kArea}, {At(0), At(1)}, {MakeState(0.01, 0, 50), moved}, {{0.0}, 1e-6}),
               "same places");
}

}  // namespace
}  // namespace piperun::sim
