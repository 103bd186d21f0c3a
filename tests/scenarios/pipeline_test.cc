#include "scenarios/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/check.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

/// EPANET's litre: a cubic foot is 28.317 of them.
constexpr double kLitre_m3 = 0.3048 * 0.3048 * 0.3048 / 28.317;

/// A mission on one of our own networks.
Scenario MakeMission(const std::string& inp, const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"network={inp: '" + inp + "'}"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return ParseScenario("schema: piperun.scenario/1\nname: mission\n", "mission.yaml", all);
}

Pipeline Build(const Scenario& scenario) {
  return BuildPipeline(scenario, CalcWater(scenario.water.temperature_C));
}

std::string PlanText(const Pipeline& pipeline) {
  std::string text;
  for (const RouteLeg& leg : pipeline.plan) {
    text +=
        (text.empty() ? "" : " ") + std::string(leg.reversed ? "-" : "") + pipeline.network.pipe(leg.pipe).id;
  }
  return text;
}

std::string RefusalOf(const Scenario& scenario) {
  try {
    return "accepted: " + PlanText(Build(scenario));
  } catch (const InputError& e) {
    return e.key_path() + ": " + e.problem();
  }
}

Scenario MakeNeighbourhood(std::vector<std::string> overrides = {}) {
  overrides.insert(overrides.begin(), "mission={launch: LAUNCH, retrieve: CATCH}");
  return MakeMission("neighbourhood", overrides);
}

double FlowIn(const Pipeline& pipeline, const std::string& pipe, double s_m, TrueTime t = TrueTime{}) {
  return pipeline.flow.Eval(*pipeline.network.FindPipe(pipe), s_m, t).flow_m3_s;
}

// A reservoir at 48 m and a pipe of 60 mm to a hydrant that is far too thirsty for it, over a looped street.
constexpr const char* kStiff = R"([JUNCTIONS]
A 10 0
B 10 5
C 10 40
[RESERVOIRS]
R 48
[PIPES]
feed R A 500 60 0.1 0 Open
one A B 300 100 0.1 0 Open
two B C 300 40 0.1 0 Open
three A C 300 150 0.1 0 Open
[OPTIONS]
Units LPS
Headloss D-W
Trials 1
Unbalanced Stop
[COORDINATES]
R -500 0
A 0 0
B 150 250
C 300 0
[END]
)";

TEST(Pipeline, ALeakInAnEpanetFileFlowsAsTorricelliSays) {
  const Pipeline pipeline =
      Build(MakeNeighbourhood({"leaks=[{id: L1, pipe: M1, s_m: 46.3, hole_diameter_mm: 2}, "
                               "{id: L2, pipe: S3, s_m: 20, hole_diameter_mm: 5, cd: 0.8}]"}));
  ASSERT_EQ(pipeline.leak_states.size(), 2u);
  // LAUNCH 12.05, TEE 12.45, 80 m apart; B1 12.75, TAP2 12.70, 54 m apart
  const double z[] = {12.05 + 0.4 * 46.3 / 80, 12.75 - 0.05 * 20 / 54};
  const double hole_m[] = {0.002, 0.005}, cd[] = {0.6, 0.8};
  for (std::size_t i = 0; i < 2; ++i) {
    const Leak& leak = pipeline.leaks[i];
    const double head_m = pipeline.flow.Eval(leak.pipe, leak.s_m, TrueTime{}).head_m - z[i];
    const double area_m2 = std::numbers::pi / 4 * hole_m[i] * hole_m[i];
    const double flow_m3_s = cd[i] * area_m2 * std::sqrt(2 * 9.80665 * head_m);
    EXPECT_NEAR(pipeline.leak_states[i].flow_m3_s / flow_m3_s, 1, 1e-4) << leak.id;
    const double density = CalcWater(10).density_kg_m3;
    EXPECT_NEAR(pipeline.leak_states[i].pressure_drop_Pa / (density * 9.80665 * head_m), 1, 1e-4) << leak.id;
  }
}

TEST(Pipeline, ALeakFlowsAsTheScenariosGravityLetsIt) {
  const std::string leak = "leaks=[{id: L1, pipe: M1, s_m: 46.3, hole_diameter_mm: 2}]";
  const Pipeline here = Build(MakeNeighbourhood({leak})),
                 there = Build(MakeNeighbourhood({leak, "gravity_m_s2=1.62"}));
  // Cd A sqrt(2 g h); the head notices less than 1e-3 of it
  EXPECT_NEAR(there.leak_states[0].flow_m3_s / here.leak_states[0].flow_m3_s, std::sqrt(1.62 / 9.80665),
              1e-3);
}

TEST(Pipeline, FlowsBalanceAtLeaksTeesAndTheFeed) {
  const Pipeline pipeline =
      Build(MakeNeighbourhood({"leaks=[{id: L1, pipe: M1, s_m: 46.3, hole_diameter_mm: 2}, "
                               "{id: L2, pipe: S3, s_m: 20, hole_diameter_mm: 5}]"}));
  const double l1 = pipeline.leak_states[0].flow_m3_s, l2 = pipeline.leak_states[1].flow_m3_s;
  const double balance = 1e-9;  // an accuracy of 1e-6 of 10 L/s leaves 1e-8; Newton's last step squares it
  EXPECT_NEAR(FlowIn(pipeline, "M1", 46.2) - FlowIn(pipeline, "M1", 46.4), l1, balance);
  EXPECT_NEAR(FlowIn(pipeline, "S3", 19.9) - FlowIn(pipeline, "S3", 20.1), l2, balance);
  EXPECT_NEAR(FlowIn(pipeline, "S3", 54), 0.55 * kLitre_m3, balance);
  EXPECT_NEAR(FlowIn(pipeline, "S1", 0), (0.40 + 0.70 + 0.55) * kLitre_m3 + l2, balance);
  EXPECT_NEAR(FlowIn(pipeline, "M1", 80), FlowIn(pipeline, "M2", 0) + FlowIn(pipeline, "S1", 0), balance);
  EXPECT_NEAR(FlowIn(pipeline, "M6", 13), 7.20 * kLitre_m3, balance);
  EXPECT_NEAR(FlowIn(pipeline, "FALL", 0), (0.15 + 0.20 + 7.20 + 0.40 + 0.70 + 0.55) * kLitre_m3 + l1 + l2,
              balance);
}

TEST(Pipeline, PlansTheWayAlongTheWater) {
  const Pipeline pipeline = Build(MakeNeighbourhood());
  EXPECT_EQ(PlanText(pipeline), "M1 M2 M3 M4 M5 RISE M6");
  EXPECT_NEAR(Route(pipeline.network, pipeline.plan).length_m(), 80 + 50 + 64 + 26 + 26 + 1.8 + 26, 1e-9);
  EXPECT_EQ(pipeline.network.nodes()[static_cast<std::size_t>(pipeline.launch_node)].id, "LAUNCH");
  EXPECT_EQ(pipeline.network.nodes()[static_cast<std::size_t>(pipeline.retrieve_node)].id, "CATCH");
}

TEST(Pipeline, WithoutRetrievalThePlanFollowsTheMainFlow) {
  // 7.55 L/s go on at the tee, 1.65 L/s to the side; there 0.70 and 0.55 L/s
  EXPECT_EQ(PlanText(Build(MakeMission("neighbourhood", {"mission={launch: LAUNCH}"}))),
            "M1 M2 M3 M4 M5 RISE M6");
  const Pipeline side = Build(MakeMission("neighbourhood", {"mission={launch: LAUNCH, via: [{node: B1}]}"}));
  EXPECT_EQ(PlanText(side), "M1 S1 S2");
  EXPECT_EQ(side.retrieve_node, -1);
}

TEST(Pipeline, ABallTooLargeForAPipeIsPlannedPastIt) {
  // 80 mm let 76 mm through
  const auto to_tap = [](const char* radius) {
    return MakeMission("neighbourhood",
                       {"mission={launch: LAUNCH, retrieve: TAP2}", std::string("ball.radius_mm=") + radius});
  };
  EXPECT_EQ(RefusalOf(to_tap("37.9")), "accepted: M1 S1 S3");
  EXPECT_NE(RefusalOf(to_tap("38.1"))
                .find("mission.retrieve: at the launch no water leads from 'LAUNCH' to "
                      "'TAP2' through pipes that a ball of 76.2 mm passes"),
            std::string::npos)
      << RefusalOf(to_tap("38.1"));
}

TEST(Pipeline, NoWayAgainstTheWaterIsRefused) {
  const std::string refusal =
      RefusalOf(MakeMission("neighbourhood", {"mission={launch: CATCH, retrieve: LAUNCH}"}));
  EXPECT_NE(refusal.find("mission.retrieve: at the launch no water leads from 'CATCH' to 'LAUNCH'"),
            std::string::npos)
      << refusal;
  EXPECT_NE(RefusalOf(MakeMission("neighbourhood", {"mission={launch: TAP1, retrieve: TAP2}"}))
                .find("no water leads"),
            std::string::npos);
  const std::string nowhere = RefusalOf(MakeMission("neighbourhood", {"mission={launch: TAP1}"}));
  EXPECT_NE(nowhere.find("mission.launch: at the launch no water leaves this node"), std::string::npos)
      << nowhere;
  EXPECT_NE(RefusalOf(MakeMission("neighbourhood",
                                  {"mission={launch: LAUNCH, retrieve: CATCH, via: [{node: TAP1}]}"}))
                .find("no water leads from 'TAP1' to 'CATCH'"),
            std::string::npos);
}

TEST(Pipeline, AnUnknownNodeIsAnsweredWithTheNearest) {
  const auto refusal = [](const char* mission) {
    return RefusalOf(MakeMission("neighbourhood", {std::string("mission=") + mission}));
  };
  EXPECT_EQ(refusal("{launch: LANCH, retrieve: CATCH}"),
            "mission.launch: there is no node 'LANCH'; did you mean 'LAUNCH'?");
  EXPECT_EQ(refusal("{launch: LAUNCH, retrieve: CACTH}"),
            "mission.retrieve: there is no node 'CACTH'; did you mean 'CATCH'?");
  EXPECT_EQ(refusal("{launch: LAUNCH, via: [{node: TAP1}, {node: TA2}]}"),
            "mission.via[1].node: there is no node 'TA2'; did you mean 'TAP2'?");
  EXPECT_NE(refusal("{retrieve: CATCH}").find("mission.launch: the node is missing"), std::string::npos);
}

/// The town's western end: L06 feeds D1 through 80 mm and nothing else does. D1 takes 0.3 L/s of the pattern
/// `home`, nine tenths of it (Demand Multiplier).
Scenario MakeTown(const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"mission={launch: L06, retrieve: D1}"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return MakeMission("town", all);
}

TEST(Pipeline, TheLaunchIsAtItsHourOfTheExtendedPeriod) {
  const double base_m3_s = 0.3 * 0.9 * kLitre_m3;
  const Pipeline seven = Build(MakeTown({"flow.launch_time_s=25200"}));  // `home`: 1.65 from 7, 1.45 from 8
  EXPECT_NEAR(FlowIn(seven, "old", 50) / (1.65 * base_m3_s), 1, 1e-5);
  EXPECT_NEAR(FlowIn(seven, "old", 50, TrueTime{FromSeconds(3600)}) / (1.45 * base_m3_s), 1, 1e-5);
  EXPECT_EQ(PlanText(seven), "old");
  const Pipeline midnight = Build(MakeTown({}));
  EXPECT_NEAR(FlowIn(midnight, "old", 50) / (0.45 * base_m3_s), 1, 1e-5);
}

TEST(Pipeline, ALaunchBetweenInstantsOrBeyondThePeriodIsRefused) {
  EXPECT_EQ(RefusalOf(MakeTown({"flow.launch_time_s=25200.5"})).substr(0, 19), "flow.launch_time_s:");
  const std::string late = RefusalOf(MakeTown({"flow.launch_time_s=200000"}));  // the period: 172800 s
  EXPECT_NE(late.find("flow.launch_time_s: the launch is at 200000 s"), std::string::npos) << late;
  EXPECT_NE(late.find("172800"), std::string::npos) << late;
}

TEST(Pipeline, ALeakOnAPumpOrValveIsRefused) {
  for (const char* link : {"well1", "prv"}) {
    const std::string refusal = RefusalOf(
        MakeTown({"leaks=[{id: L1, pipe: " + std::string(link) + ", s_m: 0.05, hole_diameter_mm: 2}]"}));
    EXPECT_EQ(refusal,
              "leaks[0].pipe: '" + std::string(link) + "' is a pump or valve; a leak lies in a pipe");
  }
}

TEST(Pipeline, DrawnLeaksLieOnTheWayAndFlow) {
  const Pipeline pipeline = Build(MakeNeighbourhood(
      {"random_leaks={count: 3, min_spacing_m: 5, min_hole_diameter_mm: 1, max_hole_diameter_mm: 3}"}));
  ASSERT_EQ(pipeline.leaks.size(), 3u);
  ASSERT_EQ(pipeline.leak_states.size(), 3u);
  const Route way(pipeline.network, pipeline.plan);
  double sum_m3_s = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(way.Chainage(pipeline.leaks[i].pipe, pipeline.leaks[i].s_m));
    EXPECT_GT(pipeline.leak_states[i].flow_m3_s, 0);
    sum_m3_s += pipeline.leak_states[i].flow_m3_s;
  }
  EXPECT_NEAR(FlowIn(pipeline, "FALL", 0), 9.2 * kLitre_m3 + sum_m3_s, 1e-9);
}

Scenario MakeStiff() {
  Scenario scenario = MakeMission("neighbourhood", {"mission={launch: A, retrieve: C}"});
  scenario.network.inp = "stiff.inp";
  scenario.network.inp_text = kStiff;
  return scenario;
}

TEST(Pipeline, HydraulicsThatDoNotConvergeNameTheWorstLink) {
  try {
    Build(MakeStiff());
    FAIL() << "one iteration from a guess is no solution";
  } catch (const HydraulicsDiverged& e) {
    EXPECT_NE(std::string(e.what()).find("at 0 s did not converge in 1 iterations"), std::string::npos)
        << e.what();
    EXPECT_NE(std::string(e.what()).find("the head loss of link '"), std::string::npos) << e.what();
  }
}

TEST(Run, HydraulicsThatDoNotConvergeAreAStatusOfARunFolderThatIsKept) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(MakeStiff(), folder / "run");
  EXPECT_EQ(result.status, "hydraulics_diverged");
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_NE(result.notes[0].find("link '"), std::string::npos) << result.notes[0];
  const std::string json = FileText(folder / "run/run.json");
  EXPECT_NE(json.find("\"hydraulics_diverged\""), std::string::npos);
  EXPECT_NE(json.find("link '"), std::string::npos);
  EXPECT_EQ(FileText(folder / "run/network.inp"), kStiff);
  EXPECT_EQ(LoadScenario((folder / "run/scenario.yaml").string()).network.inp_text, kStiff);
}

/// The neighbourhood with its dead end S2 closed at B1, its tap wanting `demand_L_s`.
Scenario MakeClosedDeadEnd(const std::string& demand_L_s) {
  Scenario scenario =
      MakeNeighbourhood({"leaks=[{id: L1, pipe: S2, s_m: 30, hole_diameter_mm: 2}]", "mission.time_limit_s=2",
                         "sensors={hydrophone0: {kind: hydrophone, rate_Hz: 16000}}"});
  std::string& inp = scenario.network.inp_text;
  const auto replace = [&](const std::string& line, const std::string& by) {
    const std::size_t at = inp.find(line);
    Demand(at != std::string::npos, "the line is in the file");
    inp.replace(at, line.size(), by);
  };
  replace(" S2     B1      TAP1    75.00   100   0.01       0      Open",
          " S2     B1      TAP1    75.00   100   0.01       0      Closed");
  replace(" TAP1      13.00     0.70", " TAP1      13.00     " + demand_L_s);
  return scenario;
}

TEST(Pipeline, ALeakOnAClosedDeadPipeHasNoPressureAndNoFlow) {
  for (const char* demand_L_s : {"0", "0.70"}) {
    const Pipeline pipeline = Build(MakeClosedDeadEnd(demand_L_s));
    ASSERT_EQ(pipeline.leak_states.size(), 1u);
    EXPECT_EQ(pipeline.leak_states[0].flow_m3_s, 0);
    EXPECT_EQ(pipeline.leak_states[0].pressure_drop_Pa, 0);
    EXPECT_EQ(FlowIn(pipeline, "S2", 10), 0);
    EXPECT_EQ(FlowIn(pipeline, "S2", 60), 0);
    // the rest of the network carries its demands and nothing for the tap
    EXPECT_NEAR(FlowIn(pipeline, "S1", 30), (0.40 + 0.55) * kLitre_m3, 1e-8) << demand_L_s;
  }
}

TEST(Run, ALeakOnAClosedDeadPipeIsSilentAndTheRunSaysSo) {
  const TemporaryFolder folder;
  const RunResult dead = RunInto(MakeClosedDeadEnd("0.70"), folder / "dead");
  EXPECT_EQ(dead.status, "time_limit");
  for (const char* warning : {"node TAP1: closed off from all water: its demand is not served",
                              "leak L1: closed dead pipe with no pressure: no sound"}) {
    EXPECT_EQ(std::ranges::count(dead.warnings, warning), 1) << warning;
    EXPECT_NE(FileText(folder / "dead/run.json").find(warning), std::string::npos);
  }
  Scenario without = MakeClosedDeadEnd("0.70");
  without.leaks.clear();
  RunInto(without, folder / "without");
  const std::string audio = "mav0/hydrophone0/audio.wav";
  EXPECT_TRUE(FileText(folder / "dead" / audio) == FileText(folder / "without" / audio))
      << "the leak is heard";
}

}  // namespace
}  // namespace piperun::scenarios
