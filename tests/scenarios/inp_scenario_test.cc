#include "scenarios/inp_scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "base/check.h"
#include "scenarios/load.h"
#include "sim/network/simulation.h"
#include "tests/support/networks.h"

namespace piperun::scenarios {
namespace {

const std::string kTown = (testing::RepositoryRoot() / "assets/networks/town.inp").string();

/// A scenario's text with its EPANET file replaced by a network written out, so that all else can be read.
Scenario ReadBack(std::string text, const std::string& inp_path) {
  const std::string inp = "network: {inp: '" + inp_path + "'}";
  const std::size_t at = text.find(inp);
  EXPECT_NE(at, std::string::npos) << text;
  text.replace(at, inp.size(), "network: {nodes: [{id: A, position_m: [0, 0, 0]}]}");
  return ParseScenario(text, "test");
}

TEST(MakeInpScenario, WritesWhatTheStrictReaderReads) {
  InpScenarioPlan plan;
  plan.inp_path = "nets/my town.inp";
  plan.name = "my town";
  plan.launch = "10";  // a number to YAML, an id to us
  plan.retrieve = "~@Pump: #1";
  plan.ball_diameter_m = 0.045;
  plan.time_limit_s = 1234;
  plan.leak_pipe = "P-1";
  plan.leak_s_m = 12.5;
  const Scenario scenario = ReadBack(MakeInpScenario(plan), plan.inp_path);
  EXPECT_EQ(scenario.name, "my town");
  EXPECT_EQ(scenario.mission.launch, "10");
  EXPECT_EQ(scenario.mission.retrieve, "~@Pump: #1");
  EXPECT_EQ(scenario.mission.time_limit_s, 1234);
  EXPECT_DOUBLE_EQ(scenario.ball.radius_m, 0.0225);
  ASSERT_EQ(scenario.leaks.size(), 1u);
  EXPECT_EQ(scenario.leaks[0].pipe, "P-1");
  EXPECT_EQ(scenario.leaks[0].s_m, 12.5);
  EXPECT_EQ(scenario.sensors.size(), 4u);
  EXPECT_EQ(scenario.estimators.size(), 1u);
}

TEST(MakeInpScenario, AnApostropheInAPathSurvives) {
  InpScenarioPlan plan;
  plan.inp_path = "it's.inp";
  plan.ball_diameter_m = 0.06;
  EXPECT_NE(MakeInpScenario(plan).find("{inp: 'it''s.inp'}"), std::string::npos);
}

std::string RefusalOf(const std::string& path, const std::string& from, const std::string& to) {
  try {
    PlanInpScenario(path, from, to);
  } catch (const InputError& e) {
    return e.key_path() + ": " + e.what();
  }
  return "accepted";
}

// L00 - L10 - L20 along the town's southern street
TEST(PlanInpScenario, GoesTheShortestWayWithABallThatFits) {
  const InpScenarioPlan plan = PlanInpScenario(kTown, "L00", "L20");
  const sim::HydraulicModel model = testing::ReadOwnNetwork("town.inp");
  double narrowest_m = 1;
  for (const sim::PipeLink& pipe : model.pipes) {
    if (pipe.id == plan.leak_pipe) {
      EXPECT_NEAR(plan.leak_s_m, pipe.length_m / 2, 0.051);
    }
    narrowest_m = std::min(narrowest_m, pipe.diameter_m);
  }
  EXPECT_FALSE(plan.leak_pipe.empty());
  EXPECT_GE(plan.ball_diameter_m, std::min(0.06, 0.4 * narrowest_m) - 0.001);
  EXPECT_LE(plan.ball_diameter_m, 0.06);
  // water: 134.6 m of 150 mm and 131.7 m of 100 mm, at the flows of the hydraulics themselves
  sim::HydraulicSimulation simulation(model);
  ASSERT_TRUE(simulation.Solve().converged());
  double travel_s = 0;
  for (int i = 0; i < model.first_pump(); ++i) {
    const sim::PipeLink& pipe = model.pipes[static_cast<std::size_t>(i)];
    if (pipe.id != "pL00e" && pipe.id != "pL10e") continue;
    const double area_m2 = std::numbers::pi / 4 * pipe.diameter_m * pipe.diameter_m;
    travel_s += pipe.length_m * area_m2 / simulation.state().flow_m3_s[i];
  }
  EXPECT_NEAR(plan.time_limit_s, 600 + 3 * travel_s, 1);
}

TEST(PlanInpScenario, AnUnknownNodeIsAnsweredWithTheNearest) {
  EXPECT_NE(RefusalOf(kTown, "L0O", "L20").find("there is no node 'L0O'; did you mean 'L00'?"),
            std::string::npos);
  EXPECT_EQ(RefusalOf(kTown, "L00", "nowhere at all").substr(0, 17), "mission.retrieve:");
}

TEST(PlanInpScenario, AnUnreadableFileIsNamed) {
  EXPECT_NE(RefusalOf("no/such.inp", "A", "B").find("no/such.inp"), std::string::npos);
}

}  // namespace
}  // namespace piperun::scenarios
