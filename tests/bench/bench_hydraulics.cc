#include <benchmark/benchmark.h>

#include <string>
#include <utility>

#include "sim/network/pipe_leak.h"
#include "sim/network/simulation.h"
#include "tests/support/networks.h"

namespace piperun::sim {
namespace {

/// A town of side x side junctions, streets of 100 m, fed at two corners: stands in for ky4 where it is
/// absent.
HydraulicModel MakeGrid(int side) {
  const auto id = [](int i, int j) { return "J" + std::to_string(i) + "-" + std::to_string(j); };
  std::string junctions = "[JUNCTIONS]\n", pipes = "[PIPES]\n";
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      junctions += id(i, j) + " " + std::to_string((i * 7 + j * 3) % 11) + " 0.4\n";
      const std::string rest = " 100 " + std::to_string(150 + 50 * ((i + 2 * j) % 4)) + " 120\n";
      if (i + 1 < side) pipes += "E" + id(i, j) + " " + id(i, j) + " " + id(i + 1, j) + rest;
      if (j + 1 < side) pipes += "N" + id(i, j) + " " + id(i, j) + " " + id(i, j + 1) + rest;
    }
  }
  pipes += "R1 R " + id(0, 0) + " 200 600 120\nR2 R " + id(side - 1, side - 1) + " 200 600 120\n";
  return ReadInp(junctions + "[RESERVOIRS]\nR 80\n" + pipes + "[OPTIONS]\nUnits LPS\nAccuracy 0.001\n",
                 "grid");
}

HydraulicModel LargeNetwork() {
  auto ky4 = piperun::testing::FindPublicNetwork("ky4.inp");
  return ky4 ? *std::move(ky4) : MakeGrid(31);
}

/// The first instant from a cold start, topology analysed: what EN_runH does after EN_openH and EN_initH.
void FirstSolve(benchmark::State& bench, const HydraulicModel& model) {
  HydraulicSimulation simulation(model);
  const HydraulicState start = simulation.state();
  for (auto _ : bench) {
    simulation.state() = start;
    simulation.Solve();
  }
  bench.counters["iterations_to_converge"] = simulation.report().iterations;
  bench.counters["nodes"] = model.node_count();
}

void Net3FirstSolve(benchmark::State& bench) {
  auto model = piperun::testing::FindPublicNetwork("Net3.inp");
  if (!model) return bench.SkipWithError("Net3.inp is not at hand");
  model->options.accuracy = 1e-3;
  FirstSolve(bench, *model);
}

void TownFirstSolve(benchmark::State& bench) {
  HydraulicModel model = piperun::testing::ReadOwnNetwork("town.inp");
  model.options.accuracy = 1e-3;
  FirstSolve(bench, model);
}

void ThousandNodesFirstSolve(benchmark::State& bench) {
  HydraulicModel model = LargeNetwork();
  model.options.accuracy = 1e-3;
  FirstSolve(bench, model);
}

/// A leak in the middle of a pipe changes between two sizes, to and fro; the solution starts from the last
/// one.
void OneLeakChanged(benchmark::State& bench, double area_m2, double other_area_m2) {
  HydraulicModel model = LargeNetwork();
  model.options.accuracy = 1e-3;
  PipeLeak leak{"L", 100, model.pipes[100].length_m / 2, area_m2};
  const LeakyModel leaky = InsertLeaks(model, {&leak, 1});
  HydraulicSimulation simulation(leaky.model);
  simulation.Solve();
  const int junction = leaky.leaks[0].junction;
  SolveReport report;
  for (auto _ : bench) {
    leak.area_m2 = leak.area_m2 == area_m2 ? other_area_m2 : area_m2;
    simulation.solver().SetLeak(junction, CalcLeakCoefficients(leak), simulation.state());
    report = simulation.solver().Solve(simulation.state());
  }
  bench.counters["iterations_to_converge"] = report.iterations;
}

/// By a tenth, and a hole of 5 mm that comes and all but goes (0.3 and 0.003 L/s or so).
void ThousandNodesLeakChangesByATenth(benchmark::State& bench) { OneLeakChanged(bench, 2e-5, 2.2e-5); }
void ThousandNodesLeakComesAndGoes(benchmark::State& bench) { OneLeakChanged(bench, 2e-5, 2e-7); }

void AnalyseTopology(benchmark::State& bench) {
  const HydraulicModel model = LargeNetwork();
  for (auto _ : bench) benchmark::DoNotOptimize(HydraulicSolver(model));
}

void ReadInpText(benchmark::State& bench) {
  const std::string text =
      piperun::testing::ReadText(piperun::testing::RepositoryRoot() / "assets/networks/town.inp");
  for (auto _ : bench) benchmark::DoNotOptimize(ReadInp(text, "town.inp"));
  bench.SetBytesProcessed(bench.iterations() * static_cast<std::int64_t>(text.size()));
}

void TownTwoDays(benchmark::State& bench) {
  const HydraulicModel model = piperun::testing::ReadOwnNetwork("town.inp");
  for (auto _ : bench) SimulatePeriod(model, [](const HydraulicStep&) {});
}

BENCHMARK(Net3FirstSolve)->Unit(benchmark::kMicrosecond);
BENCHMARK(TownFirstSolve)->Unit(benchmark::kMicrosecond);
BENCHMARK(ThousandNodesFirstSolve)->Unit(benchmark::kMicrosecond);
BENCHMARK(ThousandNodesLeakChangesByATenth)->Unit(benchmark::kMicrosecond);
BENCHMARK(ThousandNodesLeakComesAndGoes)->Unit(benchmark::kMicrosecond);
BENCHMARK(AnalyseTopology)->Unit(benchmark::kMicrosecond);
BENCHMARK(ReadInpText)->Unit(benchmark::kMicrosecond);
BENCHMARK(TownTwoDays)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace piperun::sim
