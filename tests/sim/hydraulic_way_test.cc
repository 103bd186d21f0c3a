#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "sim/network/inp_reader.h"
#include "sim/network/simulation.h"
#include "sim/network/water_way.h"
#include "tests/support/networks.h"

namespace piperun::sim {
namespace {

struct Solved {
  HydraulicModel model;
  HydraulicState state;
  int Node(const std::string& id) const {
    for (int i = 0; i < model.node_count(); ++i)
      if (model.NodeId(i) == id) return i;
    throw std::out_of_range(id);
  }
  int Link(const std::string& id) const {
    for (int i = 0; i < model.link_count(); ++i)
      if (model.LinkId(i) == id) return i;
    throw std::out_of_range(id);
  }
  WaterWays Ways(double ball_diameter_m = 0) const { return {model, state, ball_diameter_m}; }
};

Solved Solve(HydraulicModel model) {
  model.options.accuracy = 1e-8;
  HydraulicSimulation simulation(model);
  EXPECT_TRUE(simulation.Solve().converged());
  return {model, simulation.state()};
}

/// R feeds A; from A to B a short narrow pipe and, over C, a long wide one; D hangs on B; Q leads on to a
/// tank, nobody drinks at the end of the spur.
Solved Diamond() {
  return Solve(ReadInp(
      "[JUNCTIONS]\nA 0 0\nB 0 2\nC 0 1\nD 0 3\nSPUR 0 0\n[RESERVOIRS]\nR 50\n[TANKS]\nT 5 1 0 3 "
      "10\n[PIPES]\n"
      "in R A 100 200 130\nshort A B 100 80 130\nwide1 A C 200 200 130\nwide2 B C 200 200 130\n"
      "out B D 40 100 130\nspur D SPUR 10 100 130\nfill B T 60 100 130\n[OPTIONS]\nUnits LPS\n[END]\n",
      "diamond.inp"));
}

double PipeTime_s(const Solved& s, const std::string& id) {
  const PipeLink& pipe = s.model.pipes[s.Link(id)];
  const double area = std::numbers::pi / 4 * pipe.diameter_m * pipe.diameter_m;
  return pipe.length_m * area / std::abs(s.state.flow_m3_s[s.Link(id)]);  // volume over flow
}

TEST(WaterWays, TakeTheTimeThatTheirPipesTakeToEmpty) {
  const Solved s = Diamond();
  const auto way = s.Ways().FindFastest(s.Node("R"), s.Node("D"));
  ASSERT_TRUE(way.has_value());
  const double narrow = PipeTime_s(s, "short"), wide = PipeTime_s(s, "wide1") + PipeTime_s(s, "wide2");
  EXPECT_NEAR(way->points.back().time_s, PipeTime_s(s, "in") + std::min(narrow, wide) + PipeTime_s(s, "out"),
              1e-9);
  EXPECT_EQ(way->points.back().distance_m, narrow < wide ? 240 : 540);
}

TEST(WaterWays, GoAgainstTheDirectionAPipeIsDrawnIn) {
  const Solved s = Diamond();
  ASSERT_LT(s.state.flow_m3_s[s.Link("wide2")], 0);
  const WaterWay way = s.Ways().FollowMainFlow(s.Node("A"), s.Node("B"));
  ASSERT_EQ(way.points.size(), 3u);
  EXPECT_EQ(way.points[1].node, s.Node("C"));
  EXPECT_EQ(way.end, WayEnd::kArrived);
}

TEST(WaterWays, EndInTanksAtDeadEndsAndWhereTheBallIsTooWide) {
  const Solved s = Diamond();
  const WaterWay into_tank = s.Ways().FollowMainFlow(s.Node("R"));
  EXPECT_EQ(into_tank.end, WayEnd::kLeavesNetwork);
  EXPECT_EQ(into_tank.points.back().node, s.Node("T"));
  const WaterWay to_spur = s.Ways().FollowMainFlow(s.Node("D"));
  EXPECT_EQ(to_spur.end, WayEnd::kDeadEnd);
  EXPECT_EQ(to_spur.points.size(), 1u) << "still water takes nobody into the spur";
  const WaterWay stuck = s.Ways(0.15).FollowMainFlow(s.Node("R"));
  EXPECT_EQ(stuck.end, WayEnd::kBlocked);
  EXPECT_EQ(stuck.points.back().node, s.Node("B"));
}

TEST(WaterWays, FindNoWayUpstream) {
  const Solved s = Diamond();
  EXPECT_FALSE(s.Ways().FindFastest(s.Node("D"), s.Node("R")).has_value());
  EXPECT_EQ(s.Ways().FindReachable(s.Node("T")).size(), 1u);
}

// Independent of Dijkstra: relax every stretch until nothing changes (Bellman 1958).
TEST(WaterWays, AreTheFastestThereAre) {
  const Solved s = Solve(piperun::testing::ReadOwnNetwork("town.inp"));
  std::vector<double> time(static_cast<std::size_t>(s.model.node_count()), INFINITY);
  const int from = s.Node("L03");
  time[from] = 0;
  for (int round = 0; round < s.model.node_count(); ++round) {
    for (int i = 0; i < s.model.first_pump(); ++i) {
      const double flow = s.state.flow_m3_s[i], speed = CalcSpeed_m_s(s.model, s.state, i);
      const int up = flow > 0 ? s.model.From(i) : s.model.To(i);
      const int down = flow > 0 ? s.model.To(i) : s.model.From(i);
      if (speed < kLeastSpeed_m_s || s.model.pipes[i].check_valve || up >= s.model.junction_count()) continue;
      time[down] = std::min(time[down], time[up] + s.model.pipes[i].length_m / speed);
    }
  }
  std::set<int> reached;
  for (const WayPoint& point : s.Ways().FindReachable(from)) {
    reached.insert(point.node);
    EXPECT_NEAR(point.time_s, time[point.node], 1e-9 * time[point.node]) << s.model.NodeId(point.node);
  }
  for (int i = 0; i < s.model.node_count(); ++i)
    EXPECT_EQ(reached.count(i) == 1, std::isfinite(time[i])) << i;
  EXPECT_GT(reached.size(), 20u);
}

TEST(Obstacles, AreWhatStandsInTheWay) {
  const Solved s = Solve(
      ReadInp("[JUNCTIONS]\nA 0 0\nB 0 1\nC 0 1\nD 0 1\nE 0 1\nF 0 1\n[RESERVOIRS]\nR 50\n[PIPES]\nopen R A "
              "10 100 130\n"
              "shut A B 10 100 130 0 Closed\ncheck A B 10 100 130 0 CV\n[PUMPS]\npump A C POWER 1\n[VALVES]\n"
              "prv A D 100 PRV 20\ngate A E 100 TCV 0\ngpv A F 100 TCV 5\n[STATUS]\ngate "
              "Open\n[OPTIONS]\nUnits LPS\n",
              "obstacles.inp"));
  const auto obstacle = [&](const std::string& id, double diameter_m) {
    return FindObstacle(s.model, s.state, s.Link(id), diameter_m);
  };
  EXPECT_EQ(obstacle("open", 0.0949), Obstacle::kNone);
  EXPECT_EQ(obstacle("open", 0.0951), Obstacle::kTooNarrow);
  EXPECT_EQ(obstacle("shut", 0.01), Obstacle::kClosed);
  EXPECT_EQ(obstacle("check", 0.01), Obstacle::kCheckValve);
  EXPECT_EQ(obstacle("pump", 0.01), Obstacle::kPump);
  EXPECT_EQ(obstacle("prv", 0.01), Obstacle::kControlValve);
  EXPECT_EQ(obstacle("gate", 0.01), Obstacle::kNone);
  EXPECT_EQ(obstacle("gpv", 0.01), Obstacle::kControlValve);
}

}  // namespace
}  // namespace piperun::sim
