#include "sim/bend_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/hydraulics.h"
#include "sim/pipe_flow.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::MakePipeLine;
using testing::MakePipeSpec;
using testing::PipeLine;

constexpr double kGravity = 9.81;
const WaterProperties kWater{20, 998.2, 1.004e-6, 1482};

double Rad(double degrees) { return degrees * std::numbers::pi / 180; }

TEST(BendLoss, GivesItosRightAngleWorkedOutByHand) {
  // R/r = 3, Re = 1e5: alpha = 0.95 + 17.2 x 3^-1.96 = 2.94696, Re^-0.17 = 0.141254, 3^0.84 = 2.516413
  // K = 0.00241 x 2.94696 x 90 x 0.141254 x 2.516413 = 0.22720
  EXPECT_NEAR(CalcBendLoss({Rad(90), 3}, 1e5), 0.22720, 2e-5);
}

TEST(BendLoss, EqualsBlevinsFormInDiameters) {
  // Blevins (1984) prints Ito's law with R/D; his constants are rounded to three digits
  struct Case {
    double degrees, alpha;
  };
  for (const double ratio : {1.0, 1.5, 3.0, 6.0}) {
    for (const Case& c :
         {Case{45, 1 + 5.13 * std::pow(ratio, -1.47)}, Case{90, 0.95 + 4.42 * std::pow(ratio, -1.96)},
          Case{180, 1 + 5.06 * std::pow(ratio, -4.52)}}) {
      for (const double re : {2e4, 1e5, 4e5}) {
        const double printed = 0.00431 * c.alpha * c.degrees * std::pow(re, -0.17) * std::pow(ratio, 0.84);
        EXPECT_NEAR(CalcBendLoss({Rad(c.degrees), 2 * ratio}, re) / printed, 1, 3e-3) << ratio << c.degrees;
      }
    }
  }
}

TEST(BendLoss, LiesInThePublishedBandOfLongElbows) {
  // smooth 90 degree elbows of R = 1.5 D: K = 0.2 to 0.3
  for (const double re : {3e4, 1e5, 2e5}) {
    EXPECT_GT(CalcBendLoss({Rad(90), 3}, re), 0.2);
    EXPECT_LT(CalcBendLoss({Rad(90), 3}, re), 0.3);
  }
}

TEST(BendLoss, BranchesMeetWithinAPercent) {
  for (const double ratio : {3.0, 10.0, 60.0}) {
    const double re = 91 * ratio * ratio;
    if (re < 2300) continue;
    const double below = CalcBendLoss({Rad(90), ratio}, re * (1 - 1e-9));
    EXPECT_NEAR(CalcBendLoss({Rad(90), ratio}, re * (1 + 1e-9)) / below, 1, 0.01) << ratio;
  }
}

TEST(BendLoss, CostsNothingExtraWhereThePipeIsAllButStraight) {
  const double ratio = 2000;  // Re (r/R)^2 = 0.025 < 0.034
  EXPECT_NEAR(CalcExcessBendLoss({Rad(90), ratio}, 1e5), 0, 1e-9 * CalcBendLoss({Rad(90), ratio}, 1e5));
}

TEST(BendLoss, NeverGivesHeadBack) {
  for (double turn = 1; turn <= 180; turn += 7) {
    for (double ratio = 1.05; ratio < 3000; ratio *= 1.5) {
      for (double re = 10; re < 1e7; re *= 2) {
        const double excess = CalcExcessBendLoss({Rad(turn), ratio}, re);
        EXPECT_GE(excess, -1e-12 * CalcBendLoss({Rad(turn), ratio}, re)) << turn << ' ' << ratio << ' ' << re;
      }
    }
  }
}

TEST(BendLoss, IsLinearInTheSpeedOfLaminarFlow) {
  const BendShape bend{Rad(90), 3};
  EXPECT_NEAR(CalcBendLoss(bend, 100) * 100, CalcBendLoss(bend, 2000) * 2000, 1e-9);
  EXPECT_NEAR(CalcBendLoss(bend, 2299.999) / CalcBendLoss(bend, 2300), 1, 1e-6);
}

TEST(BendLoss, ABendAcrossANodeIsOneBend) {
  // two pipes in line around a corner of 90 degrees at their node, the second drawn against the route
  const Network network({{"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {10, 10, 0}}},
                        {MakePipeSpec("P", "A", "B"), MakePipeSpec("Q", "C", "B")});
  const auto bends = FindBends(network, FindRoute(network, 0, 2));
  ASSERT_EQ(bends.size(), 2u);
  ASSERT_EQ(bends[0].size(), 1u);
  ASSERT_EQ(bends[1].size(), 1u);
  for (const auto& leg : bends) {
    EXPECT_NEAR(leg[0].turn_rad, Rad(90), 1e-9);
    EXPECT_NEAR(leg[0].share, 0.5, 1e-9);
    EXPECT_NEAR(leg[0].radius_m, 0.3, 1e-12);
    EXPECT_NEAR(leg[0].end_m - leg[0].begin_m, 0.3 * Rad(45), 1e-9);
  }
  EXPECT_NEAR(bends[0][0].end_m, network.pipe(0).length_m, 1e-9) << "the first ends at the node";
  EXPECT_NEAR(bends[1][0].begin_m, 0, 1e-9) << "the second begins there";
}

TEST(BendLoss, ABendAndOneBackAreTwo) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {10, 5, 0}});
  const auto bends = FindBends(line.network, line.route);
  ASSERT_EQ(bends[0].size(), 2u);
  for (const BendPart& bend : bends[0]) {
    EXPECT_NEAR(bend.turn_rad, Rad(90), 1e-9);
    EXPECT_EQ(bend.share, 1);
  }
}

/// 1 m/s through a pipe of 150 mm with one bend of 300 mm after 4.7 m.
constexpr double kFlow_m3_s = 0.0176714586764425870;

SteadyFlow Solve(const PipeLine& line, const LocalLosses& losses, std::vector<Leak> leaks = {}) {
  return SolveSteadyFlow(line.network, line.route, {kFlow_m3_s, 3e5}, leaks, kWater, kGravity, losses);
}

double Head_m(const SteadyFlow& flow, double s_m) { return flow.timeline.Eval(0, s_m, {}).head_m; }

TEST(Hydraulics, ABendCostsItsExcessLossAndNoMore) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}});
  const SteadyFlow without = Solve(line, {}), with = Solve(line, {{}, true});
  const double reynolds = 0.15 / 1.004e-6, velocity_head_m = 1 / (2 * kGravity);
  // Re = 149 402, R/r = 4: alpha = 0.95 + 17.2 x 4^-1.96 = 2.086294
  // K = 0.00241 alpha 90 Re^-0.17 4^0.84 = 0.452517 x 0.131935 x 3.204280 = 0.191304
  // its straight smooth pipe: 0.3164 Re^-1/4 x pi/2 x 2 = 0.0160934 x 3.141593 = 0.050559
  const double excess_m = (0.191304 - 0.050559) * velocity_head_m;
  EXPECT_NEAR(CalcExcessBendLoss({Rad(90), 4}, reynolds), 0.191304 - 0.050559, 2e-6);
  const double begin_m = 4.7, end_m = 4.7 + 0.3 * Rad(90), total_m = line.network.pipe(0).length_m;
  EXPECT_NEAR(Head_m(without, begin_m), Head_m(with, begin_m), 1e-12) << "before the bend nothing changes";
  EXPECT_NEAR(Head_m(without, 0.5 * (begin_m + end_m)) - Head_m(with, 0.5 * (begin_m + end_m)),
              0.5 * excess_m, 1e-7);
  EXPECT_NEAR(Head_m(without, end_m) - Head_m(with, end_m), excess_m, 2e-7);
  EXPECT_NEAR(Head_m(without, total_m) - Head_m(with, total_m), excess_m, 2e-7);
  EXPECT_EQ(with.timeline.Eval(0, 4.9, {}).friction_factor, without.timeline.Eval(0, 4.9, {}).friction_factor)
      << "what drives the ball on is friction alone";
  EXPECT_TRUE(with.warnings.empty());
}

TEST(Hydraulics, ALeakBehindABendFeelsItsLoss) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}});
  const std::vector<Leak> leaks{{"L", 0, 8, 0.002, 0.6}};
  const double drop_Pa = Solve(line, {}, leaks).leaks[0].pressure_drop_Pa -
                         Solve(line, {{}, true}, leaks).leaks[0].pressure_drop_Pa;
  EXPECT_NEAR(drop_Pa, 0.140745 * 0.5 * 998.2, 0.01);
}

TEST(Hydraulics, AMinorLossIsSpreadAlongItsPipe) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {10, 0, 0}});
  const SteadyFlow without = Solve(line, {}), with = Solve(line, {{5}, false});
  for (const double s_m : {2.5, 5.0, 10.0}) {
    EXPECT_NEAR(Head_m(without, s_m) - Head_m(with, s_m), 5 * s_m / 10 / (2 * kGravity), 1e-9) << s_m;
  }
}

TEST(Hydraulics, WhatBendsCostDoesNotDependOnHowThePipeIsDrawn) {
  const auto total_m = [](bool against) {
    const Network network(
        {{"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {10, 10, 0}}},
        {MakePipeSpec("P", "A", "B"), against ? MakePipeSpec("Q", "C", "B") : MakePipeSpec("Q", "B", "C")});
    const LocalLosses losses{{1, 2}, true};
    const SteadyFlow flow =
        SolveSteadyFlow(network, FindRoute(network, 0, 2), {kFlow_m3_s, 3e5}, {}, kWater, kGravity, losses);
    return flow.timeline.Eval(1, against ? 0 : network.pipe(1).length_m, {}).head_m;
  };
  EXPECT_NEAR(total_m(false), total_m(true), 1e-12);
}

TEST(Hydraulics, SaysWhereBendLossesAreExtrapolated) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, {.bend_radius_m = 0.12});
  const LocalLosses losses{{}, true};
  const auto solve = [&](double flow_m3_s) {
    return SolveSteadyFlow(line.network, line.route, {flow_m3_s, 3e6}, {}, kWater, kGravity, losses).warnings;
  };
  ASSERT_EQ(solve(kFlow_m3_s).size(), 1u);
  EXPECT_EQ(
      solve(kFlow_m3_s)[0],
      "bend losses (Ito 1960) are extrapolated to R/r = 1.6; they were measured for R/r >= 2 (bend over "
      "bore radius)");
  ASSERT_EQ(solve(4 * kFlow_m3_s).size(), 2u);
  EXPECT_NE(solve(4 * kFlow_m3_s)[0].find("Re = 5.98e+05"), std::string::npos);
  EXPECT_TRUE(solve(0).empty()) << "still water loses nothing";
}

}  // namespace
}  // namespace piperun::sim
