#include <fmt/core.h>

#include <memory>

#include "scenarios/run.h"
#include "tools/piperun/command.h"
#include "tools/piperun/result_text.h"

namespace piperun::tools {
namespace {

int Estimate(scenarios::ReplayOptions& options, const Display& display) {
  options.stop = &stop_requested;
  const scenarios::RunResult result = scenarios::Replay(options);
  if (display.json) {
    fmt::print("{}", result.json);
  } else if (!display.quiet) {
    fmt::print("{}\nWritten to {}\n", DescribeResult(result), options.out.string());
  }
  return kOk;
}

}  // namespace

void AddEstimateCommand(CLI::App& app, Display& display, int& exit_code) {
  auto options = std::make_shared<scenarios::ReplayOptions>();
  CLI::App* command = app.add_subcommand("estimate", "Run estimators on the record in a run folder");
  command->add_option("RUN_FOLDER", options->run_folder, "Folder that `piperun run` wrote")->required();
  command
      ->add_option("--estimators", options->estimators,
                   "Estimators of the run by name, or any filter by its kind (default: those of the run)")
      ->delimiter(',');
  command->add_option("-o,--out", options->out, "Folder to write")->required();
  command->add_flag("-f,--force", options->force, "Replace the folder if it exists");
  command->callback([options, &display, &exit_code] { exit_code = Estimate(*options, display); });
}

}  // namespace piperun::tools
