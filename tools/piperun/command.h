#pragma once

#include <CLI/CLI.hpp>
#include <atomic>

namespace piperun::tools {

enum ExitCode { kOk = 0, kFailed = 1, kWrongInput = 2, kInterrupted = 130 };

/// What the user wants to see, for every command.
struct Display {
  bool quiet = false;
  bool json = false;
};

/// Set by SIGINT and SIGTERM.
extern std::atomic<bool> stop_requested;

/// Each adds its sub-command; when the user called it, its function runs and sets the exit code.
void AddAllanCommand(CLI::App& app, Display& display, int& exit_code);
void AddConvertUnitsCommand(CLI::App& app, Display& display, int& exit_code);
void AddRunCommand(CLI::App& app, Display& display, int& exit_code);
void AddCheckCommand(CLI::App& app, Display& display, int& exit_code);
void AddCorrelateCommand(CLI::App& app, Display& display, int& exit_code);
void AddDetectCommand(CLI::App& app, Display& display, int& exit_code);
void AddEstimateCommand(CLI::App& app, Display& display, int& exit_code);
void AddNetworkCommand(CLI::App& app, Display& display, int& exit_code);
void AddReproduceCommand(CLI::App& app, Display& display, int& exit_code);
void AddScenarioCommand(CLI::App& app, Display& display, int& exit_code);
void AddSimulateStaticCommand(CLI::App& app, Display& display, int& exit_code);

}  // namespace piperun::tools
