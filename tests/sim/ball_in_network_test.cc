// How runs end, through the motion that tells it: small networks with water given by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/bore.h"
#include "sim/motion.h"
#include "tests/support/pipes.h"
#include "tests/support/set_params.h"

namespace piperun::sim {
namespace {

using testing::MakePipeSpec;
using testing::PipeShape;

constexpr double kBore = 0.15, kBall = 0.03, kOffset = 0.5 * kBore - kBall;
constexpr double kStep_s = 1e-3;

/// Steady water with these mean speeds in the pipes, positive from `from` to `to`.
FlowTimeline MakeWater(const Network& network, const std::vector<double>& speeds_m_s) {
  std::vector<double> areas_m2;
  FlowState state;
  for (std::size_t i = 0; i < speeds_m_s.size(); ++i) {
    const Pipe& pipe = network.pipes()[i];
    areas_m2.push_back(pipe.area_m2());
    state.pipes.push_back({{0, pipe.length_m, speeds_m_s[i] * pipe.area_m2(), 50, 50, 0.02}});
  }
  return FlowTimeline(std::move(areas_m2), {TrueTime{}}, {std::move(state)});
}

/// A network with water in it, and a ball of 60 mm to send through from its first pipe's `from` node.
struct Water {
  Network network;
  Bore bore;
  FlowTimeline flow;
  MotionContext context;

  Water(Network made, const std::vector<double>& speeds_m_s, std::vector<bool> open = {})
      : network(std::move(made)), bore(network, std::move(open)), flow(MakeWater(network, speeds_m_s)) {
    context.water = CalcWater(15);
    context.network = &network;
    context.bore = &bore;
    context.flow = &flow;
    context.stuck_after_s = 20;
  }
  Water(const Water&) = delete;
  Water& operator=(const Water&) = delete;

  std::unique_ptr<Motion> Launch() const {
    const MotionKind& kind = testing::FindKind(MotionKinds(), "ball_in_pipe");
    return kind.make(*testing::MakeParamsOf(kind, {}), context);
  }
  /// Launches a ball and follows it to its end.
  std::unique_ptr<Motion> Run() const {
    auto motion = Launch();
    while (motion->status() == MotionStatus::kRunning) motion->Step();
    return motion;
  }
};

/// Two pipes in line along x, or with a corner: A - M - B, 2 m and 3 m.
Network MakeTwoPipes(const Vector3d& second_m = {3, 0, 0}, double second_diameter_m = kBore) {
  const Vector3d m(2, 0, 0);
  return Network(
      {{"A", {0, 0, 0}}, {"M", m}, {"B", m + second_m}},
      {MakePipeSpec("P", "A", "M", {.bend_radius_m = 0}),
       MakePipeSpec("Q", "M", "B", PipeShape{.diameter_m = second_diameter_m, .bend_radius_m = 0})});
}

TEST(BallInNetwork, ArrivesAtANodeAmidTheNetwork) {
  Water water(MakeTwoPipes(), {0.5, 0.5});
  water.context.retrieve_node = 1;
  const auto motion = water.Run();
  EXPECT_EQ(motion->status(), MotionStatus::kArrived);
  EXPECT_EQ(motion->state().pipe, 1) << "just across the node";
  EXPECT_GE(motion->state().chainage_m, 2);
  EXPECT_LE(motion->state().chainage_m, 2 + motion->state().v_step_W.x() * kStep_s);
}

TEST(BallInNetwork, LeavesTheNetworkWhereItComesToOpenWater) {
  for (const int open_node : {1, 2}) {
    std::vector<NodeSpec> nodes{{"A", {0, 0, 0}}, {"M", {2, 0, 0}}, {"B", {5, 0, 0}}};
    nodes[static_cast<std::size_t>(open_node)].open_water = true;
    Water water(Network(nodes, {MakePipeSpec("P", "A", "M"), MakePipeSpec("Q", "M", "B")}), {0.5, 0.5});
    const auto motion = water.Run();
    EXPECT_EQ(motion->status(), MotionStatus::kLeftNetwork);
    const double node_m = nodes[static_cast<std::size_t>(open_node)].position_m.x();
    EXPECT_GE(motion->state().chainage_m, node_m);
    EXPECT_LE(motion->state().chainage_m, node_m + motion->state().v_step_W.x() * kStep_s);
  }
}

TEST(BallInNetwork, ATankItIsToBeTakenOutOfIsAnArrival) {
  Water water(Network({{"A", {0, 0, 0}}, {"T", {2, 0, 0}, true}}, {MakePipeSpec("P", "A", "T")}), {0.5});
  water.context.retrieve_node = 1;
  EXPECT_EQ(water.Run()->status(), MotionStatus::kArrived);
}

TEST(BallInNetwork, WithoutFlowItIsInADeadEnd) {
  for (const PipeEnd launch : {PipeEnd{0, false}, PipeEnd{1, false}, PipeEnd{1, true}}) {
    Water water(MakeTwoPipes(), {0, 0});
    water.context.launch = launch;
    const auto motion = water.Run();
    EXPECT_EQ(motion->status(), MotionStatus::kDeadEnd);
    EXPECT_EQ(motion->state().time, TrueTime{FromSeconds(20)});
  }
}

TEST(BallInNetwork, RollsDownAStillPipeToItsClosedEnd) {
  // there the bore ends in a hemisphere around the node: the ball lies straight below it, but for the angle
  // at which rolling resistance holds it
  constexpr double kFall = 0.6, kRun = 3;
  Water water(Network({{"A", {0, 0, 0}}, {"B", {kRun, 0, -kFall}}}, {MakePipeSpec("P", "A", "B")}), {0});
  const auto motion = water.Run();
  EXPECT_EQ(motion->status(), MotionStatus::kDeadEnd);
  const double length = std::hypot(kRun, kFall);
  EXPECT_NEAR(motion->state().chainage_m, length + kOffset * kFall / length,
              kOffset * water.context.ball.rolling_resistance);
  EXPECT_NEAR((motion->state().X_WB.p - Vector3d(kRun, 0, -kFall)).norm(), kOffset, 1e-9);
}

TEST(BallInNetwork, ABallThatNearlyFillsItsBoreStaysInItWhereTheWaterRaces) {
  // drag takes the slip off in 2F/(M slip) = 1,700 a second: more than a step of a millisecond can follow
  Water water(Network({{"A", {0, 0, 0}}, {"B", {3, 0, 0}}},
                      {MakePipeSpec("P", "A", "B", {.diameter_m = 0.052, .bend_radius_m = 0})}),
              {9.8});
  for (const double radius_m : {0.022, 0.0246}) {
    water.context.ball.radius_m = radius_m;
    const auto motion = water.Run();
    EXPECT_EQ(motion->status(), MotionStatus::kDeadEnd) << radius_m;
    EXPECT_NEAR(motion->state().chainage_m, 3, 0.026) << radius_m;
    EXPECT_LT(motion->state().v_WB_W.norm(), 0.1) << radius_m;
    const std::vector<std::string> warnings = motion->warnings();
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("raise motion.rate_Hz") != std::string::npos;
    })) << "that drag was held back is said";
  }
}

TEST(BallInNetwork, AnEndWhereWaterIsDrawnIsADeadEndToTheBall) {
  Water water(MakeTwoPipes(), {0.5, 0.5});
  const auto motion = water.Run();
  EXPECT_EQ(motion->status(), MotionStatus::kDeadEnd);
  EXPECT_GT(motion->state().chainage_m, 5);
  EXPECT_LE(motion->state().chainage_m, 5 + kOffset);
}

TEST(BallInNetwork, IsTooLargeWhereAReducerIsAsNarrowAsItself) {
  // 150 to 80 mm: the bore's radius falls by a quarter of the way, from 75 mm on; a ball of r fits to r/0.95
  Water water(MakeTwoPipes({3, 0, 0}, 0.08), {0.3, 0.3 * kBore * kBore / (0.08 * 0.08)});
  water.context.ball.radius_m = 0.039;
  const auto motion = water.Run();
  EXPECT_EQ(motion->status(), MotionStatus::kTooLarge);
  EXPECT_EQ(motion->state().pipe, 1);
  const double narrow_m = 4 * (0.075 - 0.039 / 0.95);
  EXPECT_LT(narrow_m, 2 * (kBore - 0.08)) << "within the cone";
  // the world runs a step ahead
  EXPECT_NEAR(motion->state().s_m, narrow_m, 1.5 * motion->state().v_step_W.x() * kStep_s);
}

TEST(BallInNetwork, IsTooLargeWhereWaterTurnsIntoANarrowerPipe) {
  Water water(MakeTwoPipes({0, 3, 0}, 0.08), {0.3, 0.3 * kBore * kBore / (0.08 * 0.08)});
  water.context.ball.radius_m = 0.045;
  const auto motion = water.Run();
  EXPECT_EQ(motion->status(), MotionStatus::kTooLarge);
  EXPECT_NEAR(motion->state().chainage_m, 2, 0.075) << "it stopped at the mouth";
}

/// P0 from A to the hub H, P1 straight on to B, P2 from C, aside, to H.
Network MakeTee() {
  return Network({{"A", {-2, 0, 0}}, {"H", {0, 0, 0}}, {"B", {4, 0, 0}}, {"C", {0, 3, 0}}},
                 {MakePipeSpec("P0", "A", "H"), MakePipeSpec("P1", "H", "B"), MakePipeSpec("P2", "C", "H")});
}

TEST(BallInNetwork, ChainageFollowsTheWayTakenThroughATee) {
  Water water(MakeTee(), {0.4, 0, -0.4}, {true, false, true});
  water.context.retrieve_node = 3;
  const auto motion = water.Run();
  ASSERT_EQ(motion->status(), MotionStatus::kArrived);
  ASSERT_EQ(motion->way()->legs().size(), 2u);
  EXPECT_EQ(motion->way()->legs()[0].pipe, 0);
  EXPECT_EQ(motion->way()->legs()[1].pipe, 2);
  EXPECT_TRUE(motion->way()->legs()[1].reversed);
  const TruthState& end = motion->state();
  EXPECT_TRUE(end.reversed);
  EXPECT_NEAR(end.water_speed_m_s, 0.4, 1e-12) << "positive the way chainage rises";
  EXPECT_LE(end.s_m, 0);
  EXPECT_NEAR(end.chainage_m, 2 + 3 - end.s_m, 1e-12);
  EXPECT_NEAR(end.X_WB.p.y(), 3 - end.s_m, 1e-12);
}

TEST(BallInNetwork, StraightOnThroughATeeChainageIsTheDistanceRolled) {
  // while it is in the mouth of the branch it may count along that
  Water water(MakeTee(), {0.4, 0.4, 0});
  water.context.retrieve_node = 2;
  const auto motion = water.Launch();
  while (motion->status() == MotionStatus::kRunning) {
    motion->Step();
    const double x = motion->state().X_WB.p.x();
    EXPECT_NEAR(motion->state().chainage_m, x + 2, std::abs(x) < kBore ? kBore : 1e-12);
  }
  EXPECT_EQ(motion->status(), MotionStatus::kArrived);
  ASSERT_EQ(motion->way()->legs().size(), 2u);
  EXPECT_EQ(motion->way()->leg().pipe, 1);
}

TEST(BallInNetwork, StallsAtATeeWhoseWaterCannotLiftIt) {
  // c_D A rho u^2/2 = 0.03 N at 0.2 m/s; the ball weighs 0.11 N in water
  const Network riser(
      {{"A", {-2, 0, 0}}, {"H", {0, 0, 0}}, {"U", {0, 0, 2}}, {"V", {2, 0, 2}}},
      {MakePipeSpec("P0", "A", "H"), MakePipeSpec("P1", "H", "U"), MakePipeSpec("P2", "H", "V")});
  Water water(riser, {0.2, 0.2, 0});
  water.context.retrieve_node = 2;
  const auto motion = water.Run();
  EXPECT_EQ(motion->status(), MotionStatus::kStalledAtTee);
  EXPECT_LT(motion->state().X_WB.p.norm(), kBore);
}

TEST(BallInNetwork, RollsAwayFromTwoPumpsSideBySide) {
  // as EPANET draws them: both from the well W to H, one over the other; the pipe goes on in their line
  const Vector3d well(-0.6, 0, 0);
  const PipeShape sharp{.bend_radius_m = 0};
  std::vector<PipeSpec> pipes{MakePipeSpec("P", "H", "B", sharp), MakePipeSpec("PUMP1", "W", "H", sharp),
                              MakePipeSpec("PUMP2", "W", "H", sharp)};
  pipes[1].passable = pipes[2].passable = false;
  Water water(Network({{"H", {0, 0, 0}}, {"B", {4, 0, 0}}, {"W", well, true}}, pipes), {0.4, 0.4, 0});
  water.context.retrieve_node = 1;
  const auto motion = water.Launch();
  double last_m = motion->state().chainage_m;
  while (motion->status() == MotionStatus::kRunning) {
    motion->Step();
    EXPECT_GE(motion->state().chainage_m, last_m);
    last_m = motion->state().chainage_m;
    if (last_m < 3.9) {
      EXPECT_NEAR(motion->state().f_WB_B.norm(), 9.80665, 1) << "at " << last_m;
    }
  }
  EXPECT_EQ(motion->status(), MotionStatus::kArrived);
}

TEST(BallInNetwork, PositionGoesOnThroughAJointWhoseDrawingDoesNotClose) {
  // drawn 2 m long, but 2.5 m: the second pipe begins where the first one ends
  std::vector<PipeSpec> pipes{MakePipeSpec("P", "A", "M"), MakePipeSpec("Q", "M", "B")};
  pipes[0].length_m = 2.5;
  Water water(Network({{"A", {0, 0, 0}}, {"M", {2, 0, 0}}, {"B", {5, 0, 0}}}, pipes), {0.5, 0.5});
  water.context.retrieve_node = 2;
  const auto motion = water.Launch();
  while (motion->status() == MotionStatus::kRunning) {
    const Vector3d before = motion->state().X_WB.p;
    motion->Step();
    EXPECT_NEAR((motion->state().X_WB.p - before - kStep_s * motion->state().v_step_W).norm(), 0, 1e-14);
    EXPECT_NEAR(motion->state().chainage_m, motion->state().X_WB.p.x(), 1e-12);
  }
  EXPECT_EQ(motion->status(), MotionStatus::kArrived);
  EXPECT_NEAR(motion->state().X_WB.p.x(), 2.5 + 3, kStep_s);
}

}  // namespace
}  // namespace piperun::sim
