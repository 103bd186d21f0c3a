// piperun: the command line.

#include <fmt/core.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

#include "base/check.h"
#include "scenarios/run.h"
#include "scenarios/run_json.h"
#include "tools/piperun/command.h"

namespace piperun::tools {

std::atomic<bool> stop_requested{false};

namespace {

void RequestStop(int) { stop_requested = true; }

void WatchSignals() {
  struct sigaction action {};
  action.sa_handler = RequestStop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  action.sa_handler = SIG_IGN;  // a file-size limit shall be a write error, not a death
  sigaction(SIGXFSZ, &action, nullptr);
}

int RunApp(int argc, char** argv) {
  CLI::App app{"piperun simulates a leak-detection ball carried by water through a pipe network."};
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", std::string(scenarios::Version()));
  Display display;
  app.add_flag("-q,--quiet", display.quiet, "Print errors only");
  app.add_flag("--json", display.json, "Print results as JSON");
  int exit_code = kOk;
  AddAllanCommand(app, display, exit_code);
  AddConvertUnitsCommand(app, display, exit_code);
  AddRunCommand(app, display, exit_code);
  AddCheckCommand(app, display, exit_code);
  AddCorrelateCommand(app, display, exit_code);
  AddDetectCommand(app, display, exit_code);
  AddEstimateCommand(app, display, exit_code);
  AddNetworkCommand(app, display, exit_code);
  AddReproduceCommand(app, display, exit_code);
  AddScenarioCommand(app, display, exit_code);
  AddSimulateStaticCommand(app, display, exit_code);
  app.footer("Exit codes: 0 ok, 1 the run or a check failed, 2 wrong usage or input, 130 interrupted.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    app.exit(e);
    return kWrongInput;
  }
  return exit_code;
}

int Main(int argc, char** argv) {
  WatchSignals();
  try {
    const int exit_code = RunApp(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      throw std::runtime_error("cannot write to standard output");
    return exit_code;
  } catch (const InputError& e) {
    fmt::print(stderr, "piperun: {}\n", e.what());
    return kWrongInput;
  } catch (const scenarios::Interrupted&) {
    fmt::print(stderr, "piperun: interrupted; nothing was kept\n");
    return kInterrupted;
  } catch (const std::exception& e) {
    fmt::print(stderr, "piperun: {}\n", e.what());
    return kFailed;
  }
}

}  // namespace
}  // namespace piperun::tools

int main(int argc, char** argv) { return piperun::tools::Main(argc, argv); }
