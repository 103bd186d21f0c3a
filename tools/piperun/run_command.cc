#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "base/check.h"
#include "scenarios/load.h"
#include "scenarios/run.h"
#include "tools/piperun/command.h"
#include "tools/piperun/progress_bar.h"
#include "tools/piperun/result_text.h"

namespace piperun::tools {
namespace {

struct RunArguments {
  std::string scenario;
  std::string out;
  bool force = false;
  std::string seed;
  std::string run;
  std::vector<std::string> set;
  std::vector<std::string> estimators;
};

scenarios::Scenario Load(const RunArguments& arguments) {
  std::vector<std::string> overrides = arguments.set;
  if (!arguments.seed.empty()) overrides.push_back("seed=" + arguments.seed);
  if (!arguments.run.empty()) overrides.push_back("run=" + arguments.run);
  scenarios::Scenario scenario = scenarios::LoadScenario(arguments.scenario, overrides);
  if (arguments.estimators.empty()) return scenario;
  std::vector<scenarios::EstimatorEntry> chosen;
  for (const std::string& name : arguments.estimators) {
    const auto found = std::find_if(scenario.estimators.begin(), scenario.estimators.end(),
                                    [&](const auto& entry) { return entry.name == name; });
    if (found == scenario.estimators.end()) {
      std::string problem = "'" + name + "' is no estimator of this scenario; it has:";
      for (const auto& entry : scenario.estimators) problem += " " + entry.name;
      throw InputError(problem, "--estimators");
    }
    chosen.push_back(*found);
  }
  scenario.estimators = std::move(chosen);
  return scenario;
}

int RunScenario(const RunArguments& arguments, const Display& display) {
  const scenarios::Scenario scenario = Load(arguments);
  scenarios::RunResult result;
  {
    ProgressBar bar(scenario.name, !display.quiet && !display.json);
    scenarios::RunOptions options;
    options.out = arguments.out;
    options.force = arguments.force;
    options.stop = &stop_requested;
    options.progress = [&bar](double t, double fraction) {
      bar.Update(fraction, fmt::format("{:.0f} s simulated", t));
    };
    result = scenarios::Run(scenario, options);
  }
  if (display.json) {
    fmt::print("{}", result.json);
  } else if (!display.quiet) {
    fmt::print("{}\nWritten to {}\n", DescribeResult(result), arguments.out);
  }
  if (result.status != "ok") fmt::print(stderr, "piperun: the run ended with status {}\n", result.status);
  return result.status == "ok" ? kOk : kFailed;
}

}  // namespace

void AddRunCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Simulate one inspection run into a run folder");
  command
      ->add_option("SCENARIO", arguments->scenario, "Scenario file, or a name from `piperun scenario list`")
      ->required();
  command->add_option("-o,--out", arguments->out, "Run folder to write")->required();
  command->add_flag("-f,--force", arguments->force, "Replace the run folder if it exists");
  command->add_option("--seed", arguments->seed, "Seed of all noise (default: the scenario's)");
  command->add_option("--run", arguments->run, "Run index: another draw under the same seed");
  command->add_option("--set", arguments->set, "Override a value: key=value, e.g. leaks.L1.s_m=12.5")
      ->allow_extra_args(false);
  command->add_option("--estimators", arguments->estimators, "Only these estimators of the scenario")
      ->delimiter(',');
  command->callback([arguments, &display, &exit_code] { exit_code = RunScenario(*arguments, display); });
}

}  // namespace piperun::tools
