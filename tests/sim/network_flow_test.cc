#include "sim/network/network_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/check.h"
#include "sim/pipe_flow.h"
#include "tests/support/networks.h"

namespace piperun::sim {
namespace {

const WaterProperties kWater{20, 998.2, 1.004e-6, 1482};
constexpr double kGravity = 9.80665;
constexpr double kTenLps = 0.010 * 28.316846592 / 28.317;  // 10 L/s with EPANET's litres per cubic foot

/// A reservoir, a leaking pipe, a valve, and a pipe to a customer whose demand rises by the hour.
HydraulicModel MakeModel() {
  return ReadInp(R"(
[JUNCTIONS]
 A 10 0
 B 10 0
 C 5 10 day
[RESERVOIRS]
 R 60
[PIPES]
 P1 R A 500 200 0.1 0
 P2 B C 300 150 0.1 0
[VALVES]
 V A B 150 TCV 2
[PATTERNS]
 day 1 2 0.5
[TIMES]
 Duration 2:00
 Hydraulic Timestep 1:00
 Pattern Timestep 1:00
[OPTIONS]
 Units LPS
 Headloss D-W
 Accuracy 1e-8
[END]
)",
                 "small.inp");
}

/// Its drawing: link by link.
Network MakeNetwork(double roughness_m = 1e-4) {
  const auto pipe = [&](const char* id, const char* from, const char* to, double diameter_m) {
    PipeSpec p;
    p.id = id;
    p.from = from;
    p.to = to;
    p.diameter_m = diameter_m;
    p.wall_thickness_m = 0.007;
    p.material.roughness_m = roughness_m;
    return p;
  };
  return Network({{"R", {0, 0, 10}}, {"A", {500, 0, 10}}, {"B", {501, 0, 10}}, {"C", {801, 0, 5}}},
                 {pipe("P1", "R", "A", 0.2), pipe("P2", "B", "C", 0.15), pipe("V", "A", "B", 0.15)});
}

struct Day {
  Day() : leaky(InsertLeaks(MakeModel(), std::vector<PipeLeak>{{"L", 0, 200, 2e-5, 0, 0.6}})) {
    SimulatePeriod(leaky.model, [&](const HydraulicStep& step) { steps.push_back(step); });
  }
  FlowTimeline Timeline(std::int64_t launch_s) const {
    return MakeFlowTimeline(leaky, steps, launch_s, network, kWater);
  }

  Network network = MakeNetwork();
  LeakyModel leaky;
  std::vector<HydraulicStep> steps;
};

TrueTime At(double seconds) { return TrueTime{FromSeconds(seconds)}; }

TEST(NetworkFlow, CarriesTheDemandAndTheLeak) {
  const Day day;
  const FlowTimeline flow = day.Timeline(0);
  const double leak = CalcLeakStates(day.leaky, day.steps, 0, At(0), kWater, kGravity)[0].flow_m3_s;
  EXPECT_NEAR(flow.Eval(1, 150, At(0)).flow_m3_s, kTenLps, 1e-9);
  EXPECT_NEAR(flow.Eval(2, 0.5, At(0)).flow_m3_s, kTenLps, 1e-9);  // the valve
  EXPECT_NEAR(flow.Eval(0, 300, At(0)).flow_m3_s, kTenLps, 1e-9);
  EXPECT_NEAR(flow.Eval(0, 100, At(0)).flow_m3_s, kTenLps + leak, 1e-9);
  EXPECT_NEAR(flow.Eval(1, 150, At(3600)).flow_m3_s, 2 * kTenLps, 1e-9);
  EXPECT_NEAR(flow.Eval(1, 150, At(1800)).flow_m3_s, 1.5 * kTenLps, 1e-9);
  EXPECT_NEAR(flow.Eval(1, 150, At(1800)).dflow_dt_m3_s2, kTenLps / 3600, 1e-12);
}

TEST(NetworkFlow, TellsWhatTheLeakTakes) {
  const Day day;
  for (const double t : {0.0, 3600.0, 7200.0}) {
    const LeakState leak = CalcLeakStates(day.leaky, day.steps, 0, At(t), kWater, kGravity)[0];
    // Torricelli at the pressure it lies under; elevation 60 -> 10 over 500 m: the reservoir's is its head
    const double head = day.Timeline(0).Eval(0, 200, At(t)).head_m;
    const double elevation = 60 + (10 - 60) * 0.4;
    EXPECT_NEAR(leak.pressure_drop_Pa, 998.2 * kGravity * (head - elevation), 1e-6);
    EXPECT_NEAR(leak.flow_m3_s, 0.6 * 2e-5 * std::sqrt(2 * kGravity * (head - elevation)), 1e-9);
  }
}

TEST(NetworkFlow, HeadsFallByTheModelsLawAndAreContinuous) {
  const Day day;
  const FlowTimeline flow = day.Timeline(0);
  EXPECT_NEAR(flow.Eval(0, 0, At(0)).head_m, 60, 1e-9);
  EXPECT_NEAR(flow.Eval(0, 200 - 1e-9, At(0)).head_m, flow.Eval(0, 200, At(0)).head_m, 1e-6);
  EXPECT_NEAR(flow.Eval(0, 500, At(0)).head_m, flow.Eval(2, 0, At(0)).head_m, 1e-9);
  // valve: K U^2/(2 g) with K = 2; EPANET's constant stands for g = 32.2 ft/s2, 0.08 % above ours
  const double speed = kTenLps / (std::numbers::pi * 0.075 * 0.075);
  EXPECT_NEAR(flow.Eval(2, 0, At(0)).head_m - flow.Eval(1, 0, At(0)).head_m, speed * speed / (32.2 * 0.3048),
              1e-5);
}

TEST(NetworkFlow, FrictionFollowsFromTheFlow) {
  const Day day;
  const FlowPoint point = day.Timeline(0).Eval(1, 100, At(0));
  const double reynolds = point.velocity_m_s * 0.15 / kWater.kinematic_viscosity_m2_s;
  EXPECT_NEAR(point.friction_factor, CalcFrictionFactor(reynolds, 1e-4 / 0.15), 1e-12);
}

TEST(NetworkFlow, StartsAtTheLaunch) {
  const Day day;
  const FlowTimeline whole = day.Timeline(0), late = day.Timeline(1000);
  for (const double t : {0.0, 10.0, 2600.0, 5000.0}) {
    const FlowPoint a = whole.Eval(0, 100, At(1000 + t)), b = late.Eval(0, 100, At(t));
    EXPECT_NEAR(a.flow_m3_s, b.flow_m3_s, 1e-12) << t;
    EXPECT_NEAR(a.head_m, b.head_m, 1e-9) << t;
  }
  const LeakState a = CalcLeakStates(day.leaky, day.steps, 0, At(1500), kWater, kGravity)[0];
  const LeakState b = CalcLeakStates(day.leaky, day.steps, 1000, At(500), kWater, kGravity)[0];
  EXPECT_EQ(a.flow_m3_s, b.flow_m3_s);
}

TEST(NetworkFlow, RefusesALaunchAfterTheLastInstantAndRoughnessBeyondMoody) {
  const Day day;
  EXPECT_THROW(day.Timeline(7201), InputError);
  EXPECT_THROW(day.Timeline(-1), InputError);
  EXPECT_THROW(MakeFlowTimeline(day.leaky, day.steps, 0, MakeNetwork(0.01), kWater), InputError);
  EXPECT_THROW(MakeFlowTimeline(day.leaky, {}, 0, day.network, kWater), InputError);
}

}  // namespace
}  // namespace piperun::sim
