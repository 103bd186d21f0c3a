#include <fmt/core.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>

#include "base/number.h"
#include "scenarios/check.h"
#include "scenarios/embedded.h"
#include "scenarios/load.h"
#include "scenarios/output_file.h"
#include "scenarios/run.h"
#include "tools/piperun/command.h"
#include "tools/piperun/progress_bar.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

namespace fs = std::filesystem;

struct CheckArguments {
  std::vector<std::string> scenarios;
  std::string junit;
  std::vector<std::string> set;
};

/// A folder for run folders that nobody keeps.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "piperun-check-XXXXXX").string();
    if (!::mkdtemp(name.data()))
      throw std::system_error(errno, std::generic_category(), "cannot create " + name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

scenarios::CheckedScenario CheckScenario(const std::string& name, const CheckArguments& arguments,
                                         const fs::path& scratch) {
  const scenarios::Scenario scenario = scenarios::LoadScenario(name, arguments.set);
  scenarios::RunOptions options;
  options.out = scratch / "run";
  options.force = true;
  options.stop = &stop_requested;
  const scenarios::RunResult result = scenarios::Run(scenario, options);
  return {scenario.name, result.wall_s, scenarios::CheckExpectations(scenario.expect, result.json)};
}

void PrintTable(const std::vector<scenarios::CheckedScenario>& checked) {
  Table table({"scenario", "expectation", "found", "allowed", "result"});
  for (const scenarios::CheckedScenario& scenario : checked) {
    for (const auto& e : scenario.expectations) {
      const auto number = ParseNumber(e.found);
      table.Add({scenario.name, e.path, number ? fmt::format("{:.6g}", *number) : e.found, e.allowed,
                 e.kept ? "ok" : "FAILED"});
    }
  }
  fmt::print("{}", table.Text());
}

int Check(CheckArguments arguments, const Display& display) {
  if (arguments.scenarios.empty()) {
    for (const auto& file : scenarios::EmbeddedScenarios()) arguments.scenarios.emplace_back(file.name);
  }
  for (const std::string& name : arguments.scenarios)
    scenarios::LoadScenario(name, arguments.set);  // all or none
  const ScratchFolder scratch;
  std::vector<scenarios::CheckedScenario> checked;
  {
    ProgressBar bar("check", !display.quiet && !display.json);
    for (const std::string& name : arguments.scenarios) {
      bar.Update(static_cast<double>(checked.size()) / static_cast<double>(arguments.scenarios.size()), name);
      checked.push_back(CheckScenario(name, arguments, scratch.path()));
    }
  }
  if (!arguments.junit.empty())
    scenarios::WriteTextFile(arguments.junit, scenarios::WriteCheckJunit(checked));
  if (display.json) {
    fmt::print("{}", scenarios::WriteCheckJson(checked));
  } else if (!display.quiet) {
    PrintTable(checked);
  }
  const auto passed = std::count_if(checked.begin(), checked.end(), [](const auto& c) { return c.ok(); });
  const auto failed = static_cast<std::ptrdiff_t>(checked.size()) - passed;
  if (!display.json) fmt::print("{} passed, {} failed\n", passed, failed);
  return failed == 0 ? kOk : kFailed;
}

}  // namespace

void AddCheckCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check", "Run scenarios and hold them to their `expect:` (default: the whole catalogue)");
  command->add_option("SCENARIO", arguments->scenarios, "Scenario files or names");
  command->add_option("--junit", arguments->junit, "Write the outcome as JUnit XML");
  command->add_option("--set", arguments->set, "Override a value in every scenario: key=value")
      ->allow_extra_args(false);
  command->callback([arguments, &display, &exit_code] { exit_code = Check(*arguments, display); });
}

}  // namespace piperun::tools
