// A whole run, files and all: how many times faster than the water.

#include <benchmark/benchmark.h>

#include <filesystem>

#include "scenarios/load.h"
#include "scenarios/run.h"

namespace piperun::scenarios {
namespace {

void RunScenario(benchmark::State& state, const char* name) {
  const Scenario scenario = LoadScenario(name);
  RunOptions options;
  options.out = std::filesystem::temp_directory_path() / (std::string("piperun-bench-") + name);
  options.force = true;
  double simulated_s = 0;
  for (auto _ : state) simulated_s += Run(scenario, options).duration_s;
  state.counters["x_real_time"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsRate);
  std::filesystem::remove_all(options.out);
}

BENCHMARK_CAPTURE(RunScenario, Quickstart, "quickstart")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RunScenario, TwoBends, "two_bends")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RunScenario, Closure, "closure")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace piperun::scenarios
