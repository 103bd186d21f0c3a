// Compares our hydraulics with the EPANET engine's, network by network and step by step.
//
//   test_oracle INP_FOLDER[:INP_FOLDER...] RESULT_FOLDER
//
// RESULT_FOLDER holds what solve.mjs wrote.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "sim/network/inp_reader.h"
#include "sim/network/simulation.h"

namespace piperun::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kHeadTolerance_m = 1e-3;
constexpr double kFlowTolerance = 1e-4;  // of the network's greatest flow
constexpr std::int64_t kTimeTolerance_s = 1;
constexpr double kImbalanceTolerance_m3_s = 1e-9;  // 1e-6 L/s
constexpr int kMoreIterations = 2;

std::vector<fs::path> inp_folders;
fs::path result_folder;

std::string ReadFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The worst of a whole period.
struct Comparison {
  std::size_t steps = 0, their_steps = 0;
  double head_m = 0;
  double flow = 0;  ///< relative to the greatest flow
  std::int64_t time_s = 0;
  double imbalance_m3_s = 0;
  int iterations = 0, their_iterations = 0;  ///< of the first step
  int more_iterations = -100;                ///< at the worst step
  int status_differences = 0;
  int not_converged = 0;
  std::string where;
};

class Comparer {
 public:
  Comparer(const HydraulicModel& model, const nlohmann::json& engine) : model_(model), engine_(engine) {
    for (int i = 0; i < model.node_count(); ++i) nodes_[model.NodeId(i)] = i;
    for (int i = 0; i < model.link_count(); ++i) links_[model.LinkId(i)] = i;
    result_.their_steps = engine["steps"].size();
  }

  void Add(const HydraulicStep& step) {
    if (result_.steps < result_.their_steps) Compare(step, engine_["steps"][result_.steps]);
    ++result_.steps;
  }

  const Comparison& result() const { return result_; }

 private:
  void Compare(const HydraulicStep& ours, const nlohmann::json& theirs) {
    const int more = ours.report.iterations - theirs["iterations"].get<int>();
    if (result_.steps == 0) {
      result_.iterations = ours.report.iterations;
      result_.their_iterations = theirs["iterations"].get<int>();
    }
    result_.more_iterations = std::max(result_.more_iterations, more);
    result_.time_s = std::max(result_.time_s, std::abs(ours.time_s - theirs["time"].get<std::int64_t>()));
    result_.imbalance_m3_s = std::max(result_.imbalance_m3_s, ours.report.max_imbalance_m3_s);
    result_.not_converged += ours.report.converged() ? 0 : 1;
    CompareHeads(ours, theirs);
    CompareFlows(ours, theirs);
  }

  void CompareHeads(const HydraulicStep& ours, const nlohmann::json& theirs) {
    const double unit_m = model_.options.metric ? 1 : 0.3048;
    const std::vector<bool> supplied = FindSupplied(model_, ours.state);
    for (std::size_t i = 0; i < engine_["nodes"].size(); ++i) {
      const int node = nodes_.at(engine_["nodes"][i]);
      if (!supplied[static_cast<std::size_t>(node)]) continue;
      const double error = std::abs(ours.state.head_m[static_cast<std::size_t>(node)] -
                                    unit_m * theirs["heads"][i].get<double>());
      if (!(error <= result_.head_m)) {
        result_.head_m = error;
        result_.where = "node " + model_.NodeId(node) + " at " + std::to_string(ours.time_s) + " s";
      }
    }
  }

  void CompareFlows(const HydraulicStep& ours, const nlohmann::json& theirs) {
    double greatest = 1e-9, worst = 0;
    for (std::size_t i = 0; i < engine_["links"].size(); ++i) {
      const auto link = static_cast<std::size_t>(links_.at(engine_["links"][i]));
      const bool open = !IsClosed(ours.state.status[link]);
      const double flow = open ? ours.state.flow_m3_s[link] : 0;  // the engine reports closed links as still
      const double reference = model_.options.flow_unit_m3_s * theirs["flows"][i].get<double>();
      greatest = std::max(greatest, std::abs(reference));
      worst = std::max(worst, std::abs(flow - reference));
      if (open != (theirs["open"][i].get<double>() > 0)) ++result_.status_differences;
    }
    result_.flow = std::max(result_.flow, worst / greatest);
  }

  const HydraulicModel& model_;
  const nlohmann::json& engine_;
  std::map<std::string, int> nodes_, links_;
  Comparison result_;
};

/// Mean time of a first solution from a cold start, topology analysed, as solve.mjs times the engine's.
double TimeFirstSolution_us(const HydraulicModel& model) {
  constexpr int kRuns = 200;
  HydraulicSimulation simulation(model);
  const HydraulicState start = simulation.state();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kRuns; ++i) {
    simulation.state() = start;
    simulation.Solve();
  }
  const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - begin;
  return elapsed.count() / kRuns;
}

void PrintTimes(const std::string& name, const HydraulicModel& model, double engine_us) {
  const double ours_us = TimeFirstSolution_us(model);
  std::printf("%-22s %6d %10.1f %14.1f %7.2f\n", name.c_str(), model.node_count(), ours_us, engine_us,
              engine_us / ours_us);
}

void Print(const std::string& name, const Comparison& c) {
  static bool headed = false;
  if (!headed) {
    std::printf("%-22s %11s %10s %10s %7s %12s %11s %6s\n", "network", "steps", "|dH| m", "|dQ|/Qmax",
                "|dt| s", "balance L/s", "iterations", "more");
    headed = true;
  }
  std::printf("%-22s %5zu/%-5zu %10.1e %10.1e %7lld %12.1e %5d/%-5d %6d  %s\n", name.c_str(), c.steps,
              c.their_steps, c.head_m, c.flow, static_cast<long long>(c.time_s), 1000 * c.imbalance_m3_s,
              c.iterations, c.their_iterations, c.more_iterations, c.where.c_str());
}

std::vector<fs::path> FindNetworks() {
  std::vector<fs::path> found;
  for (const fs::path& folder : inp_folders) {
    if (!fs::is_directory(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".inp") found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(EpanetOracle, HeadsFlowsEventsAndIterationsAgreeWithTheEngine) {
  const std::vector<fs::path> networks = FindNetworks();
  ASSERT_FALSE(networks.empty());
  for (const fs::path& path : networks) {
    SCOPED_TRACE(path.filename().string());
    const fs::path result = result_folder / (path.stem().string() + ".json");
    ASSERT_TRUE(fs::exists(result)) << result;
    const nlohmann::json engine = nlohmann::json::parse(ReadFile(result));
    HydraulicModel model = ReadInp(ReadFile(path), path.filename().string());
    model.options.accuracy = 1e-5;
    Comparer comparer(model, engine);
    SimulatePeriod(model, [&](const HydraulicStep& step) { comparer.Add(step); });
    const Comparison& c = comparer.result();
    Print(path.stem().string(), c);
    EXPECT_EQ(c.steps, c.their_steps);
    EXPECT_LE(c.head_m, kHeadTolerance_m) << c.where;
    EXPECT_LE(c.flow, kFlowTolerance);
    EXPECT_LE(c.time_s, kTimeTolerance_s);
    EXPECT_LE(c.imbalance_m3_s, kImbalanceTolerance_m3_s);
    EXPECT_LE(c.more_iterations, kMoreIterations);
    EXPECT_EQ(c.status_differences, 0);
    EXPECT_EQ(c.not_converged, 0);
  }
}

/// Asserts nothing: times depend on the machine. The engine here is WebAssembly under node, slower than a
/// native build of it.
TEST(EpanetOracle, FirstSolutionsAreTimedBesideTheEngine) {
  std::printf("%-22s %6s %10s %14s %7s\n", "first solution, 1e-5", "nodes", "ours us", "EPANET WASM us",
              "ratio");
  for (const fs::path& path : FindNetworks()) {
    const nlohmann::json engine =
        nlohmann::json::parse(ReadFile(result_folder / (path.stem().string() + ".json")));
    HydraulicModel model = ReadInp(ReadFile(path), path.filename().string());
    model.options.accuracy = 1e-5;
    PrintTimes(path.stem().string(), model, engine["first_step_us"].get<double>());
  }
}

}  // namespace
}  // namespace piperun::sim

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc != 3) {
    std::fprintf(stderr, "usage: test_oracle INP_FOLDER[:INP_FOLDER...] RESULT_FOLDER\n");
    return 2;
  }
  std::stringstream folders(argv[1]);
  for (std::string folder; std::getline(folders, folder, ':');)
    piperun::sim::inp_folders.emplace_back(folder);
  piperun::sim::result_folder = argv[2];
  return RUN_ALL_TESTS();
}
