#include "scenarios/network_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "scenarios/run.h"
#include "sim/network/inp_reader.h"
#include "tests/support/networks.h"

namespace piperun::scenarios {
namespace {

NetworkOptions WholePeriod() {
  NetworkOptions options;
  options.extended = true;
  return options;
}

sim::HydraulicModel Town() { return piperun::testing::ReadOwnNetwork("town.inp"); }

TEST(NetworkReport, DemandsOfAllNodesAddUpToNothing) {
  const sim::HydraulicModel model = Town();
  const NetworkSolution solution = SolveNetwork(model, WholePeriod());
  ASSERT_TRUE(solution.converged()) << solution.problem;
  ASSERT_EQ(solution.steps.size(), 49u) << "two days, every hour, both ends";
  for (const sim::HydraulicStep& step : solution.steps) {
    double sum = 0, drawn = 0;
    for (const NodeReport& node : ReportNodes(model, step.state)) {
      sum += node.demand_m3_s;
      drawn += std::max(node.demand_m3_s, 0.0);
    }
    EXPECT_NEAR(sum, 0, 1e-9 * 105) << step.time_s;  // 1e-6 L/s at each junction
    EXPECT_GT(drawn, 0.01);
  }
}

TEST(NetworkReport, WhatFillsATankIsItsDemand) {
  const sim::HydraulicModel model = sim::ReadInp(
      "[JUNCTIONS]\nJ 0 2\n[RESERVOIRS]\nR 50\n[TANKS]\nT 20 1 0 9 10\n[PIPES]\nP R J 100 100 120\n"
      "Q J T 100 100 120\n[OPTIONS]\nUnits LPS\nAccuracy 0.00001\n[END]\n",
      "fill.inp");
  const NetworkSolution solution = SolveNetwork(model, {});
  const auto nodes = ReportNodes(model, solution.steps.front().state);
  const auto links = ReportLinks(model, solution.steps.front().state);
  EXPECT_GT(nodes[2].demand_m3_s, 0);
  EXPECT_NEAR(nodes[2].demand_m3_s, links[1].flow_m3_s, 1e-12);
  EXPECT_NEAR(nodes[1].demand_m3_s, -links[0].flow_m3_s, 1e-12);
  EXPECT_DOUBLE_EQ(nodes[2].pressure_m, 1);  // its level
  EXPECT_EQ(nodes[1].pressure_m, 0);
  EXPECT_NEAR(links[0].head_loss_m + links[1].head_loss_m, 50 - 21, 1e-9);
}

TEST(NetworkReport, NotConvergingIsAValueThatNamesTheTime) {
  sim::HydraulicModel model = Town();
  model.options.max_trials = 2;
  model.options.extra_trials = -1;
  const NetworkSolution solution = SolveNetwork(model, WholePeriod());
  EXPECT_FALSE(solution.converged());
  EXPECT_EQ(solution.problem.substr(0, 8), "at 0 s: ");
  EXPECT_EQ(solution.steps.size(), 1u) << "UNBALANCED STOP ends the period";
}

TEST(NetworkReport, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  NetworkOptions options = WholePeriod();
  options.stop = &stop;
  EXPECT_THROW(SolveNetwork(Town(), options), Interrupted);
}

}  // namespace
}  // namespace piperun::scenarios
