#include "sim/hydraulics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "sim/pipe_flow.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

constexpr double kGravity = 9.81;
const WaterProperties kWater{20, 998.2, 1.004e-6, 1482};

/// A to B to C in line, 100 m each, rising 2 m per pipe; the second pipe is drawn against the route.
struct TwoPipes {
  Network network;
  Route route;
};

TwoPipes MakeTwoPipes() {
  const auto pipe = [](const char* id, const char* from, const char* to) {
    PipeSpec p;
    p.id = id;
    p.from = from;
    p.to = to;
    p.diameter_m = 0.15;
    p.wall_thickness_m = 0.007;
    p.material.roughness_m = 1e-4;
    return p;
  };
  Network network({{"A", {0, 0, 10}}, {"B", {100, 0, 12}}, {"C", {200, 0, 14}}, {"D", {100, 50, 3}}},
                  {pipe("AB", "A", "B"), pipe("CB", "C", "B"), pipe("BD", "B", "D")});
  Route route = FindRoute(network, 0, 2);
  return {std::move(network), std::move(route)};
}

SteadyFlow Solve(const TwoPipes& pipes, std::vector<Leak> leaks, InletCondition inlet = {0.0176, 5e5}) {
  return SolveSteadyFlow(pipes.network, pipes.route, inlet, leaks, kWater, kGravity);
}

void ExpectInputError(const std::string& key, const std::vector<Leak>& leaks,
                      InletCondition inlet = {0.0176, 5e5}) {
  try {
    Solve(MakeTwoPipes(), leaks, inlet);
    FAIL() << "no error at " << key;
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), key) << e.what();
  }
}

TEST(Hydraulics, HeadFallsByDarcyAndWeisbach) {
  // U = 0.0176 / 0.0176715 = 0.99595 m/s, Re = 148 800, Colebrook at e/D = 6.667e-4: f = 0.02012;
  // h_f = 0.02012 * (100.02/0.15) * U^2/(2 * 9.81) = 0.6783 m per pipe
  const TwoPipes pipes = MakeTwoPipes();
  const SteadyFlow flow = Solve(pipes, {});
  const double head_0 = 10 + 5e5 / (998.2 * 9.81);
  EXPECT_NEAR(flow.timeline.Eval(0, 0, {}).head_m, head_0, 1e-9);
  EXPECT_NEAR(flow.timeline.Eval(0, 100.019998, {}).head_m, head_0 - 0.6783, 3e-4);
  EXPECT_NEAR(flow.timeline.Eval(1, 0, {}).head_m, head_0 - 2 * 0.6783, 6e-4);
  EXPECT_NEAR(flow.timeline.Eval(0, 50, {}).velocity_m_s, 0.0176 / (std::numbers::pi * 0.075 * 0.075), 1e-12);
}

TEST(Hydraulics, RefusesAWaterColumnThatWouldPart) {
  // 4 m up and 1.357 m of friction: the end stands 5.357 m of water, 52.46 kPa, below the inlet
  const double fall_Pa = (4 + 2 * 0.6783) * 998.2 * 9.81;
  EXPECT_NO_THROW(Solve(MakeTwoPipes(), {}, {0.0176, fall_Pa - 1e5 + 50}));
  ExpectInputError("flow.inlet_pressure_Pa", {}, {0.0176, fall_Pa - 1e5 - 50});
}

TEST(Hydraulics, OrificeTakesTheTorricellianFlow) {
  // 5 mm, Cd 0.6 under 39.42676 m at g = 9.80665: EPANET 2.3.5 gives 0.3276061363 L/s;
  // half a digit of the head is 6e-8 of the flow, 2e-11 m3/s
  const TwoPipes pipes = MakeTwoPipes();
  const std::vector<Leak> leaks{{"L", 0, 0, 0.005, 0.6}};
  const double pressure_Pa = 998.2 * 9.80665 * 39.42676;
  const SteadyFlow flow =
      SolveSteadyFlow(pipes.network, pipes.route, {0.0176, pressure_Pa}, leaks, kWater, 9.80665);
  EXPECT_NEAR(flow.leaks[0].flow_m3_s, 0.3276061363e-3, 2e-11);
  EXPECT_NEAR(flow.leaks[0].pressure_drop_Pa, pressure_Pa, 1e-6);
}

TEST(Hydraulics, LeaksBalanceTheMassAndSplitTheReach) {
  const std::vector<Leak> leaks{
      {"L1", 0, 60, 0.004, 0.6}, {"L2", 1, 30, 0.006, 0.6}, {"L3", 1, 80, 0.003, 0.6}};
  const SteadyFlow flow = Solve(MakeTwoPipes(), leaks);
  const auto at = [&](int pipe, double s) { return flow.timeline.Eval(pipe, s, {}).flow_m3_s; };
  const double q1 = flow.leaks[0].flow_m3_s, q2 = flow.leaks[1].flow_m3_s, q3 = flow.leaks[2].flow_m3_s;
  EXPECT_DOUBLE_EQ(at(0, 59.99), 0.0176);
  EXPECT_DOUBLE_EQ(at(0, 60.01), 0.0176 - q1);
  // pipe CB is passed from its end: s = 80 comes before s = 30, and the flow is negative
  EXPECT_DOUBLE_EQ(at(1, 90), -(0.0176 - q1));
  EXPECT_DOUBLE_EQ(at(1, 50), -(0.0176 - q1 - q3));
  EXPECT_DOUBLE_EQ(at(1, 10), -(0.0176 - q1 - q3 - q2));
}

TEST(Hydraulics, HeadIsContinuousAtLeaksAndNodes) {
  const SteadyFlow flow = Solve(MakeTwoPipes(), {{"L1", 0, 60, 0.004, 0.6}});
  const auto& reaches = flow.timeline.state({}).pipes;
  ASSERT_EQ(reaches[0].size(), 2U);
  EXPECT_EQ(reaches[0][0].head_end_m, reaches[0][1].head_begin_m);
  EXPECT_EQ(reaches[0][1].head_end_m, reaches[1][0].head_end_m);  // CB ends at B
  EXPECT_GT(reaches[1][0].head_end_m, reaches[1][0].head_begin_m);
}

TEST(Hydraulics, SidePipesStandStillUnderTheirNodesHead) {
  const SteadyFlow flow = Solve(MakeTwoPipes(), {});
  const FlowPoint side = flow.timeline.Eval(2, 20, {});
  EXPECT_EQ(side.flow_m3_s, 0);
  EXPECT_EQ(side.head_m, flow.timeline.state({}).pipes[0].back().head_end_m);
}

TEST(Hydraulics, StillWaterIsHydrostatic) {
  const SteadyFlow flow = Solve(MakeTwoPipes(), {}, {0, 1e5});
  EXPECT_EQ(flow.timeline.Eval(0, 0, {}).head_m, flow.timeline.Eval(1, 0, {}).head_m);
}

TEST(Hydraulics, RefusesWhatCannotFlow) {
  ExpectInputError("flow.inlet_m3_s", {}, {-0.01, 5e5});
  ExpectInputError("flow.inlet_m3_s", {}, {std::nan(""), 5e5});
  ExpectInputError("leaks[0]", {{"L", 0, 50, 0.005, 0.6}}, {1e-4, 5e5});     // takes more than flows
  ExpectInputError("leaks[0]", {{"L", 0, 50, 0.005, 0.6}}, {0.0176, -1e5});  // pressure below the outside
  ExpectInputError("leaks[1].s_m", {{"L", 0, 50, 0.005, 0.6}, {"M", 0, 101, 0.005, 0.6}});
  ExpectInputError("leaks[0].pipe", {{"L", 2, 5, 0.005, 0.6}});
  ExpectInputError("leaks[0].hole_diameter_m", {{"L", 0, 5, 0, 0.6}});
  ExpectInputError("leaks[0].cd", {{"L", 0, 5, 0.005, 1.5}});
}

}  // namespace
}  // namespace piperun::sim
