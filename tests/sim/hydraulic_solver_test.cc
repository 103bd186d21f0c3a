#include "sim/network/solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/random.h"
#include "sim/network/drained_part.h"
#include "sim/network/head_loss.h"
#include "sim/network/inp_reader.h"
#include "sim/network/pipe_leak.h"
#include "sim/network/simulation.h"
#include "tests/support/networks.h"

namespace piperun::sim {
namespace {

using std::numbers::pi;

constexpr double kFoot_m = 0.3048;
constexpr double kCubicFoot_m3 = kFoot_m * kFoot_m * kFoot_m;
constexpr double kLitre_m3 = kCubicFoot_m3 / 28.317;  // what EPANET takes a litre for
constexpr double kGravity_m_s2 = 32.2 * kFoot_m;
constexpr double kViscosity_m2_s = 1.1e-5 * kFoot_m * kFoot_m;

/// A network at time 0: its model, its water, and how it was found.
struct Solved {
  HydraulicModel model;
  HydraulicState state;
  SolveReport report;

  std::size_t Node(const std::string& id) const {
    for (int i = 0; i < model.node_count(); ++i) {
      if (model.NodeId(i) == id) return static_cast<std::size_t>(i);
    }
    ADD_FAILURE() << "no node " << id;
    return 0;
  }
  std::size_t Link(const std::string& id) const {
    for (int i = 0; i < model.link_count(); ++i) {
      if (model.LinkId(i) == id) return static_cast<std::size_t>(i);
    }
    ADD_FAILURE() << "no link " << id;
    return 0;
  }
  double Head_m(const std::string& id) const { return state.head_m[Node(id)]; }
  double Flow_L_s(const std::string& id) const { return state.flow_m3_s[Link(id)] / kLitre_m3; }
  LinkStatus Status(const std::string& id) const { return state.status[Link(id)]; }
  double Loss_m(const std::string& id) const {
    const int link = static_cast<int>(Link(id));
    return state.head_m[static_cast<std::size_t>(model.From(link))] -
           state.head_m[static_cast<std::size_t>(model.To(link))];
  }
};

Solved SolveModel(HydraulicModel model) {
  Solved solved{std::move(model), {}, {}};
  HydraulicSimulation simulation(solved.model);
  solved.report = simulation.Solve();
  solved.state = simulation.state();
  EXPECT_TRUE(solved.report.converged()) << Describe(solved.report, solved.model);
  return solved;
}

/// In litres per second and metres, to the last digit.
Solved SolveText(const std::string& text, const std::string& options = "Headloss H-W\n") {
  return SolveModel(
      ReadInp(text + "[OPTIONS]\nUnits LPS\nAccuracy 1e-10\n" + options + "[END]\n", "test.inp"));
}

/// One link from reservoir R (head 50 m) to junction J (elevation 0), which takes `demand`.
Solved SolveOnePipe(const std::string& pipe, const std::string& options, double demand_L_s) {
  return SolveText("[JUNCTIONS]\nJ 0 " + std::to_string(demand_L_s) +
                       "\n[RESERVOIRS]\nR 50\n[PIPES]\nP R J " + pipe + "\n",
                   options);
}

TEST(HydraulicSolver, PipeLosesHeadByHazenAndWilliams) {
  // h = 10.667 L q^1.852 / (C^1.852 d^4.871) in SI (Rossman 2020, table 3.1 in feet: 4.727)
  const Solved s = SolveOnePipe("800 200 110", "Headloss H-W\n", 30);
  const double q = 30 * kLitre_m3;
  const double loss = 4.727 * (800 / kFoot_m) * std::pow(q / kCubicFoot_m3, 1.852) /
                      (std::pow(110, 1.852) * std::pow(0.2 / kFoot_m, 4.871)) * kFoot_m;
  EXPECT_NEAR(s.Loss_m("P"), loss, 1e-9);
  EXPECT_NEAR(s.Loss_m("P"),
              10.667 * 800 * std::pow(q, 1.852) / (std::pow(110, 1.852) * std::pow(0.2, 4.871)), 1e-4 * loss);
}

TEST(HydraulicSolver, PipeLosesHeadByManning) {
  // v = (1.49/n) R^0.6665 S^0.5 in feet; Manning's own constants, 1.4859 and 2/3, differ by 0.6 %
  const Solved s = SolveOnePipe("500 150 0.012", "Headloss C-M\n", 12);
  const double v = 12 * kLitre_m3 / (pi * 0.15 * 0.15 / 4), radius = 0.15 / 4;
  const double feet =
      500 / kFoot_m * std::pow(v / kFoot_m * 0.012 / 1.49, 2) / std::pow(radius / kFoot_m, 1.333);
  EXPECT_NEAR(s.Loss_m("P"), feet * kFoot_m, 1e-9);
  EXPECT_NEAR(s.Loss_m("P"), 500 * v * v * 0.012 * 0.012 / std::pow(radius, 4.0 / 3), 0.007 * s.Loss_m("P"));
}

TEST(HydraulicSolver, LaminarFlowLosesHeadByHagenAndPoiseuille) {
  // Re = 4 q/(pi nu d) = 1245: h = 128 nu L q / (pi g d^4)
  const Solved s = SolveOnePipe("60 50 0.1", "Headloss D-W\n", 0.05);
  const double loss =
      128 * kViscosity_m2_s * 60 * 0.05 * kLitre_m3 / (pi * kGravity_m_s2 * std::pow(0.05, 4));
  EXPECT_NEAR(s.Loss_m("P"), loss, 1e-9 * loss);
}

TEST(HydraulicSolver, TurbulentFlowLosesHeadBySwameeAndJain) {
  const Solved s = SolveOnePipe("300 200 0.4", "Headloss D-W\n", 40);
  const double v = 40 * kLitre_m3 / (pi * 0.04 / 4), reynolds = v * 0.2 / kViscosity_m2_s;
  const double log = std::log10(0.4e-3 / (3.7 * 0.2) + 5.74 / std::pow(reynolds, 0.9));
  const double loss = 0.25 / (log * log) * 300 / 0.2 * v * v / (2 * kGravity_m_s2);
  EXPECT_NEAR(s.Loss_m("P"), loss, 1e-9 * loss);
}

TEST(HydraulicSolver, MinorLossIsSpeedHeads) {
  // K v^2/(2 g), g = 32.2 ft/s2; EPANET's 0.02517 rounds 8/(pi^2 g) by 1e-4
  const double with = SolveOnePipe("10 100 150 25", "Headloss H-W\n", 10).Loss_m("P");
  const double without = SolveOnePipe("10 100 150 0", "Headloss H-W\n", 10).Loss_m("P");
  const double v = 10 * kLitre_m3 / (pi * 0.01 / 4);
  EXPECT_NEAR(with - without, 25 * v * v / (2 * kGravity_m_s2), 2e-4 * (with - without));
}

/// The slope of a loss by a central difference.
double DifferenceSlope(double flow, const PipeResistance& pipe) {
  const double step = 1e-6 * flow;
  return (CalcDarcyWeisbachLoss(flow + step, pipe).loss_m - CalcDarcyWeisbachLoss(flow - step, pipe).loss_m) /
         (2 * step);
}

TEST(HeadLoss, DarcyWeisbachSlopeIsTheDerivativeInAllThreeRegimes) {
  PipeLink pipe;
  pipe.length_m = 100;
  pipe.diameter_m = 0.1;
  pipe.roughness = 2e-4;
  pipe.minor_loss = 3;
  HydraulicOptions options;
  options.law = HeadLossLaw::kDarcyWeisbach;
  options.viscosity_m2_s = kViscosity_m2_s;
  const PipeResistance resistance = CalcPipeResistance(pipe, options);
  for (const double reynolds : {500.0, 1900.0, 2500.0, 3900.0, 5000.0, 1e5, 1e7}) {
    const double flow = reynolds * pi / 4 * kViscosity_m2_s * 0.1;
    const double slope = CalcDarcyWeisbachLoss(flow, resistance).slope_s_m2;
    EXPECT_NEAR(DifferenceSlope(flow, resistance) / slope, 1, 1e-7) << "Re " << reynolds;
    EXPECT_EQ(CalcDarcyWeisbachLoss(-flow, resistance).loss_m,
              -CalcDarcyWeisbachLoss(flow, resistance).loss_m);
  }
}

TEST(HeadLoss, DunlopsCubicMeetsLaminarAndTurbulentFlow) {
  // f(2000) = 64/2000; at 4000 it is Swamee and Jain's
  const PipeResistance pipe{1, 0, 2e-3, 1e-6};
  const double laminar = 2000 * pi / 4 * 1e-6, turbulent = 4000 * pi / 4 * 1e-6;
  EXPECT_NEAR(CalcTurbulentFriction(laminar * (1 + 1e-12), pipe).value, 0.032, 1e-8);
  EXPECT_NEAR(CalcTurbulentFriction(turbulent * (1 - 1e-12), pipe).value,
              CalcTurbulentFriction(turbulent * (1 + 1e-12), pipe).value, 1e-8);
}

TEST(HydraulicSolver, ParallelPipesShareTheFlowAtEqualHeadLoss) {
  // q ~ C (d^4.871 / L)^(1/1.852)
  const Solved s =
      SolveText("[JUNCTIONS]\nJ 0 50\n[RESERVOIRS]\nR 50\n[PIPES]\nA R J 500 200 100\nB R J 900 150 130\n");
  const double ratio = 100.0 / 130 * std::pow(std::pow(200.0 / 150, 4.871) * 900 / 500, 1 / 1.852);
  EXPECT_NEAR(s.Flow_L_s("A") / s.Flow_L_s("B"), ratio, 1e-9);
  EXPECT_NEAR(s.Flow_L_s("A") + s.Flow_L_s("B"), 50, 1e-9);
}

/// A pump from reservoir R (head 10 m) to J (elevation 0), which takes `demand`.
Solved SolvePump(const std::string& pump, const std::string& more, double demand_L_s) {
  return SolveText("[JUNCTIONS]\nJ 0 " + std::to_string(demand_L_s) +
                   "\n[RESERVOIRS]\nR 10\n[PUMPS]\nU R J " + pump + "\n" + more);
}

TEST(HydraulicSolver, OnePointPumpRunsFromFourThirdsOfItsHeadToTwiceItsFlow) {
  // H = 4/3 h0 - (1/3) h0 (q/q0)^2 with EPANET's 1.33334
  const std::string curve = "[CURVES]\nc 20 30\n";
  EXPECT_NEAR(SolvePump("HEAD c", curve, 20).Head_m("J"), 10 + 30, 1e-9);
  EXPECT_NEAR(SolvePump("HEAD c", curve, 10).Head_m("J"),
              10 + 1.33334 * 30 - 0.33334 * 30 / std::pow(2, 1.99998), 1e-3);
  EXPECT_NEAR(SolvePump("HEAD c", curve, 40).Head_m("J"), 10, 1e-9);
}

TEST(HydraulicSolver, ThreePointPumpPassesThroughItsPoints) {
  const std::string curve = "[CURVES]\nc 0 50\nc 15 42\nc 30 20\n";
  EXPECT_NEAR(SolvePump("HEAD c", curve, 15).Head_m("J"), 52, 1e-9);
  EXPECT_NEAR(SolvePump("HEAD c", curve, 30).Head_m("J"), 30, 1e-9);
  // in between H = 50 - 8 (q/15)^n, n = ln(30/8)/ln 2
  EXPECT_NEAR(SolvePump("HEAD c", curve, 20).Head_m("J"), 60 - 8 * std::pow(20.0 / 15, std::log2(30.0 / 8)),
              1e-9);
}

TEST(HydraulicSolver, ManyPointPumpFollowsItsLines) {
  const std::string curve = "[CURVES]\nc 0 50\nc 10 46\nc 20 36\nc 40 10\n";
  EXPECT_NEAR(SolvePump("HEAD c", curve, 15).Head_m("J"), 10 + 41, 1e-9);
  EXPECT_NEAR(SolvePump("HEAD c", curve, 30).Head_m("J"), 10 + 23, 1e-9);
}

TEST(HydraulicSolver, PumpSpeedFollowsTheAffinityLaws) {
  // H(q, s) = s^2 H(q/s)
  const std::string three = "[CURVES]\nc 0 50\nc 15 42\nc 30 20\n",
                    many = "[CURVES]\nc 0 50\nc 10 46\nc 20 36\nc 40 10\n";
  for (const std::string& curve : {three, many}) {
    const double full = SolvePump("HEAD c", curve, 20).Head_m("J") - 10;
    EXPECT_NEAR(SolvePump("HEAD c SPEED 0.8", curve, 16).Head_m("J") - 10, 0.64 * full, 1e-9);
  }
}

TEST(HydraulicSolver, ConstantPowerPumpGivesItsPowerToTheWater) {
  // P = rho g q h with rho g = 62.4 lb/ft3: EPANET's 8.814 hp
  const Solved s = SolvePump("POWER 5", "", 12);
  const double head = s.Head_m("J") - 10, q = 12 * kLitre_m3;
  EXPECT_NEAR(head, 8.814 * (5 / 0.7457) / (q / kCubicFoot_m3) * kFoot_m, 1e-9);
  EXPECT_NEAR(1000 * 9.80665 * q * head, 5000, 10);
}

TEST(HydraulicSolver, PumpThatIsTooWeakStandsStill) {
  const Solved s = SolveText(
      "[JUNCTIONS]\nJ 0 4\n[RESERVOIRS]\nR 10\nH 80\n[PIPES]\nP H J 100 200 120\n[PUMPS]\nU R J HEAD c\n"
      "[CURVES]\nc 20 30\n");
  EXPECT_EQ(s.Status("U"), LinkStatus::kPumpTooWeak);
  EXPECT_EQ(s.Flow_L_s("U"), 0);
  EXPECT_NEAR(s.Flow_L_s("P"), 4, 1e-7);
}

TEST(HydraulicSolver, CheckValveLetsNothingBack) {
  const std::string pipes =
      "[JUNCTIONS]\nJ 0 1\n[RESERVOIRS]\nhigh 60\nlow 40\n[PIPES]\nA high J 100 100 100\nB J low 100 100 "
      "100 ";
  EXPECT_GT(SolveText(pipes + "0 Open\n").Flow_L_s("B"), 1);
  EXPECT_GT(SolveText(pipes + "0 CV\n").Flow_L_s("B"), 1);
  const std::string back =
      "[JUNCTIONS]\nJ 0 1\n[RESERVOIRS]\nhigh 60\nlow 40\n[PIPES]\nA high J 100 100 100\nB low J 100 100 100 "
      "0 CV\n";
  const Solved s = SolveText(back);
  EXPECT_EQ(s.Flow_L_s("B"), 0);
  EXPECT_NEAR(s.Flow_L_s("A"), 1, 1e-9);
}

/// Reservoir R (60 m), pipe, valve V from A to B (both at 5 m), pipe, demand at C; a weak second supply W so
/// that nothing depends on the valve alone.
Solved SolveValve(const std::string& valve, const std::string& more = "", double demand_L_s = 20) {
  return SolveText(
      "[JUNCTIONS]\nA 5\nB 5\nC 3 " + std::to_string(demand_L_s) +
      "\n[RESERVOIRS]\nR 60\nW 25\n[PIPES]\nP R A 300 200 110\nQ B C 200 200 110\nS W C 900 80 110\n"
      "[VALVES]\nV A B 150 " +
      valve + "\n" + more);
}

TEST(HydraulicSolver, ReducingValveHoldsThePressureBehindIt) {
  const Solved s = SolveValve("PRV 31");
  EXPECT_EQ(s.Status("V"), LinkStatus::kActive);
  EXPECT_NEAR(s.Head_m("B"), 5 + 31, 1e-8);  // pinned with 9e6 m2/s against 0.02 m3/s
  EXPECT_NEAR(s.Flow_L_s("V"), s.Flow_L_s("Q"), 1e-7);
  EXPECT_NEAR(s.Flow_L_s("P"), s.Flow_L_s("V"), 1e-7);
}

TEST(HydraulicSolver, ReducingValveOpensWhenItsSettingIsOutOfReachAndClosesAgainstTheFlow) {
  const Solved open = SolveValve("PRV 70");
  EXPECT_EQ(open.Status("V"), LinkStatus::kOpen);
  EXPECT_NEAR(open.Loss_m("V"), 0, 1e-6);
  const Solved closed = SolveValve("PRV 5", "", 0.5);  // W keeps C above the setting
  EXPECT_EQ(closed.Status("V"), LinkStatus::kClosed);
  EXPECT_EQ(closed.Flow_L_s("V"), 0);
}

TEST(HydraulicSolver, SustainingValveHoldsThePressureBeforeIt) {
  const Solved s = SolveValve("PSV 54.5");
  EXPECT_EQ(s.Status("V"), LinkStatus::kActive);
  EXPECT_NEAR(s.Head_m("A"), 5 + 54.5, 1e-8);
  EXPECT_NEAR(s.Flow_L_s("V"), s.Flow_L_s("P"), 1e-7);
  EXPECT_EQ(SolveValve("PSV 20").Status("V"), LinkStatus::kOpen);
}

TEST(HydraulicSolver, BreakerValveLosesItsSetting) {
  EXPECT_NEAR(SolveValve("PBV 12").Loss_m("V"), 12, 1e-7);
}

TEST(HydraulicSolver, FlowControlPassesItsSettingAtMost) {
  const Solved s = SolveValve("FCV 17");
  EXPECT_EQ(s.Status("V"), LinkStatus::kActive);
  const double trickle_L_s = 1e-8 * (kFoot_m * kFoot_m) * s.Loss_m("V") / kLitre_m3;  // as EPANET's does
  EXPECT_NEAR(s.Flow_L_s("V"), 17 + trickle_L_s, 1e-8);
  EXPECT_NEAR(s.Flow_L_s("S"), 3 - trickle_L_s, 1e-7);
  const Solved open = SolveValve("FCV 35");
  EXPECT_LT(open.Flow_L_s("V"), 35);
}

TEST(HydraulicSolver, ThrottleLosesItsCoefficient) {
  const Solved s = SolveValve("TCV 80");
  const double v = s.Flow_L_s("V") * kLitre_m3 / (pi * 0.15 * 0.15 / 4);
  EXPECT_NEAR(s.Loss_m("V"), 80 * v * v / (2 * kGravity_m_s2), 2e-4 * s.Loss_m("V"));
}

TEST(HydraulicSolver, GeneralPurposeValveFollowsItsCurve) {
  const Solved s = SolveValve("GPV c", "[CURVES]\nc 0 0\nc 10 4\nc 20 12\nc 40 50\n");
  const double q = s.Flow_L_s("V");
  ASSERT_GT(q, 10);
  EXPECT_NEAR(s.Loss_m("V"), q < 20 ? 4 + (q - 10) * 0.8 : 12 + (q - 20) * 1.9, 1e-6);
}

TEST(HydraulicSolver, PositionalValveGrowsItsLossAsItCloses) {
  // K = K_open / (Kv/Kvo)^2: at 50 % of a straight characteristic four times the loss of the open valve
  const auto coefficient = [](const Solved& s) {
    const double v = s.Flow_L_s("V") * kLitre_m3 / (pi * 0.15 * 0.15 / 4);
    return s.Loss_m("V") / (v * v / (2 * kGravity_m_s2));
  };
  EXPECT_NEAR(coefficient(SolveValve("PCV 50 6")), 24, 0.01);
  EXPECT_NEAR(coefficient(SolveValve("PCV 100 6")), 6, 0.01);
  EXPECT_NEAR(coefficient(SolveValve("PCV 30 6 c", "[CURVES]\nc 20 10\nc 40 30\nc 80 75\n")), 6 / 0.04, 0.1);
}

TEST(HydraulicSolver, EmitterIsAnOrifice) {
  // facts of the engine: a 5 mm hole, Cd 0.6: C = 1000 Cd A sqrt(2 g) = 0.0521743; at 39.42676 m 0.3276061
  // L/s
  const double coefficient = 1000 * 0.6 * pi * 0.005 * 0.005 / 4 * std::sqrt(2 * 9.80665);
  EXPECT_NEAR(coefficient, 0.0521743, 1e-7);
  const Solved s =
      SolveText("[JUNCTIONS]\nJ 0\n[RESERVOIRS]\nR 39.5\n[PIPES]\nP R J 1000 50 100\n[EMITTERS]\nJ " +
                std::to_string(coefficient) + "\n");
  EXPECT_NEAR(s.Flow_L_s("P"), 0.052174 * std::sqrt(s.Head_m("J")), 1e-8);
}

TEST(HydraulicSolver, EmitterFlowsInwardOnlyWhereBackflowIsAllowed) {
  const std::string text =
      "[JUNCTIONS]\nJ 60\nK 0 3\n[RESERVOIRS]\nR 50\n[PIPES]\nP R J 100 100 100\nQ J K 100 100 "
      "100\n[EMITTERS]\nJ 0.5\n";
  EXPECT_LT(SolveText(text).state.emitter_m3_s[0], -1e-4);
  EXPECT_NEAR(SolveText(text, "BACKFLOW ALLOWED NO\n").state.emitter_m3_s[0], 0, 1e-9);
}

TEST(HydraulicSolver, LeakageOfAPipeIsSharedByItsEnds) {
  // FAVAD with 0.6 sqrt(2 g), g = 32.2 ft/s2: half of 200 mm2 and 3 mm2/m per 100 m of 1000 m at each end
  const Solved s = SolveText(
      "[JUNCTIONS]\nA 10\nB 25\n[RESERVOIRS]\nR 80\n[PIPES]\nS R A 100 400 130\nP A B 1000 300 130\n"
      "[LEAKAGE]\nP 20 0.3\n");
  for (const char* id : {"A", "B"}) {
    const std::size_t node = s.Node(id);
    const double h = s.state.head_m[node] - s.model.junctions[node].elevation_m;
    const double area = 10 * (20e-6 + 0.3e-6 * h) / 2;
    const double flow = 0.6 * std::sqrt(2 * kGravity_m_s2 * h) * area;
    EXPECT_NEAR(s.state.Outflow_m3_s(static_cast<int>(node)), flow, 3e-6 * flow);  // EPANET's constant: 2e-6
  }
}

TEST(HydraulicSolver, LeakAlongAPipeTakesItsOrificeFlowThere) {
  HydraulicModel model = ReadInp(
      "[JUNCTIONS]\nJ 30 10\n[RESERVOIRS]\nR 70\n[PIPES]\nP R J 1000 150 120 4\n[OPTIONS]\nUnits "
      "LPS\nAccuracy 1e-10\n",
      "leak.inp");
  const std::vector<PipeLeak> leaks{{"far", 0, 700, 5e-5, 1e-6, 0.7}, {"near", 0, 100, 2e-5}};
  LeakyModel leaky = InsertLeaks(model, leaks);
  const Solved s = SolveModel(leaky.model);
  double taken = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const int node = leaky.leaks[i].junction;
    const double elevation = 70 + (30 - 70) * leaks[i].s_m / 1000;  // R lies at its head
    EXPECT_NEAR(s.model.Elevation_m(node), elevation, 1e-12);
    const double h = s.state.head_m[static_cast<std::size_t>(node)] - elevation;
    const double area = leaks[i].area_m2 + leaks[i].head_area_slope_m * h;
    const double flow = leaks[i].discharge_coefficient * std::sqrt(2 * 9.80665 * h) * area;
    EXPECT_NEAR(s.state.Outflow_m3_s(node), flow, 1e-6 * flow);
    taken += flow;
  }
  EXPECT_NEAR(s.state.flow_m3_s[0], 10 * kLitre_m3 + taken, 1e-8);
  ASSERT_EQ(leaky.pipes[0].size(), 3u);
  EXPECT_EQ(leaky.pipes[0][1].s_begin_m, 100);
  EXPECT_EQ(leaky.pipes[0][1].s_end_m, 700);
  EXPECT_NEAR(s.model.pipes[static_cast<std::size_t>(leaky.pipes[0][1].link)].minor_loss, 2.4, 1e-12);
}

TEST(InsertLeaks, RefusesLeaksOutsideThePipeOrOnTopOfEachOther) {
  const HydraulicModel model = ReadInp(
      "[JUNCTIONS]\nJ 0\n[RESERVOIRS]\nR 9\n[PIPES]\nP R J 100 100 100\n[OPTIONS]\nUnits LPS\n", "leak.inp");
  const auto key_of = [&](std::vector<PipeLeak> leaks) {
    try {
      InsertLeaks(model, leaks);
    } catch (const InputError& error) {
      return error.key_path();
    }
    return std::string("none");
  };
  EXPECT_EQ(key_of({{"a", 0, 100, 1e-5}}), "leaks[0].s_m");
  EXPECT_EQ(key_of({{"a", 0, 50, 1e-5}, {"b", 0, 50, 1e-5}}), "leaks[1].s_m");
  EXPECT_EQ(key_of({{"a", 1, 50, 1e-5}}), "leaks[0].pipe");
  EXPECT_EQ(key_of({{"a", 0, 50, 0}}), "leaks[0].area_m2");
  EXPECT_EQ(key_of({{"a", 0, 50, -1}}), "leaks[0].area_m2");
  EXPECT_EQ(key_of({{"a", 0, 50, 1e-5, 0, 1.5}}), "leaks[0].discharge_coefficient");
}

TEST(InsertLeaks, ControlsAndRulesStillMeanTheSameLinksAndNodes) {
  const HydraulicModel model = piperun::testing::ReadOwnNetwork("rules.inp");
  const PipeLeak leak{"L", 2, 200, 1e-5};
  const LeakyModel leaky = InsertLeaks(model, {&leak, 1});
  for (std::size_t i = 0; i < model.rules.size(); ++i) {
    for (std::size_t k = 0; k < model.rules[i].premises.size(); ++k) {
      const RulePremise &old = model.rules[i].premises[k], &now = leaky.model.rules[i].premises[k];
      if (old.subject == RulePremise::Subject::kNode) {
        EXPECT_EQ(leaky.model.NodeId(now.index), model.NodeId(old.index));
      } else if (old.subject == RulePremise::Subject::kLink) {
        EXPECT_EQ(leaky.model.LinkId(now.index), model.LinkId(old.index));
      }
    }
    EXPECT_EQ(leaky.model.LinkId(leaky.model.rules[i].then_actions[0].link),
              model.LinkId(model.rules[i].then_actions[0].link));
  }
  EXPECT_EQ(leaky.model.NodeId(leaky.model.From(leaky.model.first_pump())), "src");
}

TEST(HydraulicSolver, PressureDrivenDemandFollowsWagnersCurve) {
  // D = D_full ((p - p0)/(p1 - p0))^n between p0 = 5 and p1 = 40 m
  const Solved s = SolveText(
      "[JUNCTIONS]\nA 30 8\nB 60 8\nC 5 8\n[RESERVOIRS]\nR 55\n[PIPES]\nP R A 500 200 120\nQ A B 500 200 "
      "120\n"
      "S A C 500 200 120\n",
      "Demand Model PDA\nMinimum Pressure 5\nRequired Pressure 40\nPressure Exponent 0.6\n");
  const double p = s.Head_m("A") - 30;
  EXPECT_NEAR(s.state.delivered_m3_s[0] / kLitre_m3, 8 * std::pow((p - 5) / 35, 0.6), 1e-4);
  EXPECT_NEAR(s.state.delivered_m3_s[1], 0, 1e-9);              // above the water
  EXPECT_NEAR(s.state.delivered_m3_s[2] / kLitre_m3, 8, 1e-4);  // pressure to spare
}

TEST(HydraulicSolver, NegativeDemandIsAnInflow) {
  const Solved s = SolveText("[JUNCTIONS]\nJ 0 -4\n[RESERVOIRS]\nR 10\n[PIPES]\nP R J 100 100 100\n");
  EXPECT_NEAR(s.Flow_L_s("P"), -4, 1e-9);
  EXPECT_GT(s.Head_m("J"), 10);
}

TEST(HydraulicSolver, CutOffJunctionsAreNamed) {
  const Solved s = SolveText(
      "[JUNCTIONS]\nA 0 1\nB 0 0\n[RESERVOIRS]\nR 10\n[PIPES]\nP R A 100 100 100\nQ A B 100 100 100 0 "
      "Closed\n");
  EXPECT_EQ(FindSupplied(s.model, s.state), (std::vector<bool>{true, false, true}));
}

// A reservoir at 10 m feeds A, which takes 1 L/s; behind a closed pipe lie B (demand given) and C.
Solved SolveCutOff(const std::string& demand_L_s, double leak_m25_s) {
  HydraulicModel model = ReadInp(
      "[JUNCTIONS]\nA 0 1\nB 2 " + demand_L_s +
          "\nC 3 0\n[RESERVOIRS]\nR 10\n[PIPES]\nP R A 100 100 100\n"
          "Q A B 100 100 100 0 Closed\nS B C 100 100 100\n[OPTIONS]\nUnits LPS\nAccuracy 1e-6\n[END]\n",
      "test.inp");
  model.junctions[1].leak.fixed_m25_s = leak_m25_s;
  return SolveModel(std::move(model));
}

TEST(HydraulicSolver, ALeakBehindAClosedPipeRunsDry) {
  // 2 mm: 0.6 pi/4 d^2 sqrt(2 g)
  const double leak_m25_s = 0.6 * pi / 4 * 0.002 * 0.002 * std::sqrt(2 * kGravity_m_s2);
  for (const char* demand_L_s : {"0", "0.7"}) {
    Solved s = SolveCutOff(demand_L_s, leak_m25_s);
    ASSERT_TRUE(s.report.converged()) << demand_L_s << ": " << Describe(s.report, s.model);
    const std::vector<bool> drained = FindDrained(s.model, s.state);
    EXPECT_EQ(drained, (std::vector<bool>{false, true, true}));
    const bool wants_water = std::string(demand_L_s) != "0";
    EXPECT_EQ(DropDrainedDemands(drained, s.state), wants_water ? std::vector<int>{1} : std::vector<int>{});
    HydraulicSolver solver(s.model);
    ASSERT_TRUE(solver.Solve(s.state).converged());
    // what is left of the way: 1 L/s to A, none of it through the closed pipe but its trickle
    EXPECT_NEAR(s.Flow_L_s("P"), 1, 1e-5) << demand_L_s;
    SettleDrained(s.model, drained, s.state);
    EXPECT_EQ(s.Flow_L_s("Q"), 0);
    EXPECT_EQ(s.Flow_L_s("S"), 0);
    EXPECT_EQ(s.Head_m("B"), 2);
    EXPECT_EQ(s.Head_m("C"), 3);
    EXPECT_EQ(s.state.fixed_leak_m3_s[1], 0);
  }
}

TEST(HydraulicSolver, WaterShutInWithNoWayOutIsNotDrained) {
  const Solved s = SolveCutOff("0", 0);
  EXPECT_EQ(FindDrained(s.model, s.state), (std::vector<bool>{false, false, false}));
  const Solved fed = SolveCutOff("-0.7", 1e-6);
  EXPECT_EQ(FindDrained(fed.model, fed.state), (std::vector<bool>{false, false, false}));
}

TEST(HydraulicSolver, AWarmStartFromTheSolutionTakesOneIteration) {
  HydraulicModel model = piperun::testing::ReadOwnNetwork("town.inp");
  HydraulicSimulation simulation(model);
  ASSERT_TRUE(simulation.Solve().converged());
  const HydraulicState cold = simulation.state();
  EXPECT_EQ(simulation.Solve().iterations, 1);
  for (std::size_t i = 0; i < cold.head_m.size(); ++i)
    EXPECT_NEAR(simulation.state().head_m[i], cold.head_m[i], 1e-6);
}

TEST(HydraulicSolver, TheSameStartGivesTheSameBitsWhateverWasSolvedBefore) {
  const HydraulicModel model = piperun::testing::ReadOwnNetwork("town.inp");
  HydraulicSimulation simulation(model);
  const HydraulicState start = simulation.state();
  simulation.Solve();
  const HydraulicState first = simulation.state();
  for (int i = 0; i < 20 && simulation.Advance(); ++i) simulation.Solve();
  HydraulicSimulation other(model);
  other.state() = start;
  other.Solve();
  EXPECT_EQ(other.state().head_m, first.head_m);
  EXPECT_EQ(other.state().flow_m3_s, first.flow_m3_s);
  HydraulicState again = start;  // what the solver still holds of the 20th instant must not matter
  again.demand_m3_s = first.demand_m3_s;
  again.delivered_m3_s = first.demand_m3_s;
  HydraulicState fresh = again;
  simulation.solver().Solve(again);
  HydraulicSolver(model).Solve(fresh);
  EXPECT_EQ(again.head_m, fresh.head_m);
  EXPECT_EQ(again.flow_m3_s, fresh.flow_m3_s);
}

TEST(HydraulicSolver, AChangedLeakMeansTheSameWarmAsCold) {
  const HydraulicModel model = piperun::testing::ReadOwnNetwork("town.inp");
  PipeLeak leak{"L", 12, 50, 3e-5};
  const LeakyModel before = InsertLeaks(model, {&leak, 1});
  HydraulicSimulation warm(before.model);
  warm.Solve();
  leak.area_m2 = 9e-5;
  leak.head_area_slope_m = 1e-7;
  warm.solver().SetLeak(before.leaks[0].junction, CalcLeakCoefficients(leak), warm.state());
  ASSERT_TRUE(warm.solver().Solve(warm.state()).converged());
  const LeakyModel after = InsertLeaks(model, {&leak, 1});
  HydraulicSimulation cold(after.model);
  ASSERT_TRUE(cold.Solve().converged());
  for (std::size_t i = 0; i < cold.state().head_m.size(); ++i) {
    EXPECT_NEAR(warm.state().head_m[i], cold.state().head_m[i], 2e-4) << i;  // both stop at 1e-5 of the flow
  }
}

TEST(HydraulicSolver, FailingToConvergeIsAValueThatNamesTheWorstLink) {
  HydraulicModel model = piperun::testing::ReadOwnNetwork("town.inp");
  model.options.max_trials = 2;
  model.options.extra_trials = 0;
  HydraulicSimulation simulation(model);
  const SolveReport report = simulation.Solve();
  EXPECT_FALSE(report.converged());
  ASSERT_GE(report.worst_link, 0);
  EXPECT_GT(report.max_head_error_m, 0.01);
  const std::string text = Describe(report, model);
  EXPECT_NE(text.find(model.LinkId(report.worst_link)), std::string::npos) << text;
}

/// A random town: side x side junctions, reservoirs at two corners, streets missing here and there.
HydraulicModel RandomTown(std::uint64_t run) {
  const RandomStream stream(7, "towns", run);
  const int side = 3 + static_cast<int>(run % 5);
  std::string junctions = "[JUNCTIONS]\n", pipes = "[PIPES]\n";
  const auto id = [](int i, int j) { return "J" + std::to_string(i) + "-" + std::to_string(j); };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const auto u = stream.Uniforms(static_cast<std::uint64_t>(i * side + j), 0);
      const auto v = stream.Uniforms(static_cast<std::uint64_t>(i * side + j), 1);
      junctions += id(i, j) + " " + std::to_string(20 * u[0]) + " " + std::to_string(3 * u[1]) + "\n";
      const std::string rest = " " + std::to_string(50 + 400 * u[2]) + " " + std::to_string(60 + 240 * u[3]) +
                               " 0.3 " + std::to_string(3 * v[2]);
      if (i + 1 < side) pipes += "E" + id(i, j) + " " + id(i, j) + " " + id(i + 1, j) + rest + "\n";
      if (j + 1 < side && (i == 0 || v[0] < 0.7))
        pipes += "N" + id(i, j) + " " + id(i, j) + " " + id(i, j + 1) + rest + "\n";
    }
  }
  pipes += "R1 R " + id(0, 0) + " 20 400 0.3\nS1 S " + id(side - 1, 0) + " 20 400 0.3\n";
  return ReadInp(junctions + "[RESERVOIRS]\nR 60\nS 58\n" + pipes +
                     "[OPTIONS]\nUnits LPS\nHeadloss D-W\nAccuracy 1e-6\n",
                 "random.inp");
}

TEST(HydraulicSolver, RandomTownsObeyMassAndEnergy) {
  for (std::uint64_t run = 0; run < 200; ++run) {
    SCOPED_TRACE(run);
    const Solved s = SolveModel(RandomTown(run));
    std::vector<double> excess(s.state.head_m.size());
    for (int link = 0; link < s.model.link_count(); ++link) {
      const auto k = static_cast<std::size_t>(link);
      excess[static_cast<std::size_t>(s.model.From(link))] -= s.state.flow_m3_s[k];
      excess[static_cast<std::size_t>(s.model.To(link))] += s.state.flow_m3_s[k];
      const double loss =
          CalcDarcyWeisbachLoss(s.state.flow_m3_s[k], CalcPipeResistance(s.model.pipes[k], s.model.options))
              .loss_m;
      EXPECT_NEAR(s.Loss_m(s.model.LinkId(link)), loss, 1e-4);
    }
    for (std::size_t i = 0; i < s.model.junctions.size(); ++i) {
      EXPECT_NEAR(excess[i], s.model.junctions[i].demands[0].base_m3_s, 1e-9);
    }
  }
}

struct Reference {
  const char* id;
  double value;
};

/// Reference values of the engine (2.3.5, accuracy 1e-5), in feet and gallons per minute.
void ExpectReference(const std::string& file, const std::vector<Reference>& heads,
                     const std::vector<Reference>& flows) {
  auto model = piperun::testing::FindPublicNetwork(file);
  if (!model) GTEST_SKIP() << file << " is not at hand";
  model->options.accuracy = 1e-5;
  const Solved s = SolveModel(*std::move(model));
  for (const Reference& head : heads) EXPECT_NEAR(s.Head_m(head.id) / kFoot_m, head.value, 1e-3) << head.id;
  for (const Reference& flow : flows) {
    EXPECT_NEAR(s.state.flow_m3_s[s.Link(flow.id)] / (kCubicFoot_m3 / 448.831), flow.value, 0.01) << flow.id;
  }
}

TEST(HydraulicSolver, Net1AgreesWithTheReferenceAtTheStart) {
  ExpectReference("Net1.inp",
                  {{"10", 1004.3474}, {"11", 985.2304}, {"12", 970.0698}, {"22", 969.0784}, {"32", 965.6893}},
                  {{"9", 1866.1758}, {"110", -766.1758}, {"31", 40.8105}, {"122", 59.1895}});
}

TEST(HydraulicSolver, Net2AgreesWithTheReferenceAtTheStart) {
  ExpectReference("Net2.inp", {{"1", 309.8845}, {"11", 295.9705}, {"36", 291.7435}, {"26", 291.7}}, {});
}

TEST(HydraulicSolver, Net3AgreesWithTheReferenceAtTheStart) {
  ExpectReference("Net3.inp", {{"10", 145.5234}, {"15", 125.8112}, {"105", 146.8294}, {"123", 165.4675}},
                  {{"60", 13157.8743}});
}

}  // namespace
}  // namespace piperun::sim
