#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/rest_record.h"
#include "tools/piperun/command.h"
#include "tools/piperun/progress_bar.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

constexpr double kLongest_s = 366 * 86400.0;

struct StaticArguments {
  std::string source;
  std::string duration;
  std::optional<double> rate_Hz;
  std::string seed;
  std::string run;
  std::vector<std::string> set;
  std::string out;
  bool force = false;
};

/// "2.5h", "90 s", "30min", "7d"; a bare number is seconds.
double ReadDuration_s(const std::string& text) {
  const std::size_t end = text.find_last_of("0123456789.") + 1;  // 0 when there is none
  const auto value = ParseNumber(text.substr(0, end));
  const std::string unit = text.substr(std::min(text.size(), text.find_first_not_of(' ', end)));
  const double seconds = unit.empty() || unit == "s" ? 1
                         : unit == "min"             ? 60
                         : unit == "h"               ? 3600
                         : unit == "d"               ? 86400
                                                     : 0;
  if (!value || seconds == 0 || *value <= 0 || *value * seconds > kLongest_s) {
    throw InputError("'" + text +
                         "' is no length of time; give a number above zero with s, min, h or d, at most "
                         "366 d, e.g. 2.5h",
                     "--duration");
  }
  return *value * seconds;
}

scenarios::RestOptions MakeOptions(const StaticArguments& arguments) {
  scenarios::RestOptions options{ReadDuration_s(arguments.duration), arguments.rate_Hz, arguments.set};
  if (!arguments.seed.empty()) options.overrides.push_back("seed=" + arguments.seed);
  if (!arguments.run.empty()) options.overrides.push_back("run=" + arguments.run);
  return options;
}

void Print(const std::vector<scenarios::RestChannel>& channels, const std::string& out,
           const Display& display) {
  if (display.json) {
    nlohmann::ordered_json json;
    for (const auto& c : channels) json[c.name] = {{"samples", c.samples}, {"lost", c.lost}};
    fmt::print("{}\n", json.dump(2));
  } else if (!display.quiet) {
    Table table({"sensor", "samples", "lost"});
    for (const auto& c : channels) table.Add({c.name, std::to_string(c.samples), std::to_string(c.lost)});
    fmt::print("{}\nWritten to {}\n", table.Text(), out);
  }
}

int SimulateStatic(const StaticArguments& arguments, const Display& display) {
  const scenarios::RestOptions rest = MakeOptions(arguments);
  const scenarios::Scenario scenario = scenarios::LoadRestScenario(arguments.source, rest);
  std::vector<scenarios::RestChannel> channels;
  {
    ProgressBar bar(scenario.name, !display.quiet && !display.json);
    scenarios::RunOptions options;
    options.out = arguments.out;
    options.force = arguments.force;
    options.stop = &stop_requested;
    options.progress = [&bar](double t, double fraction) {
      bar.Update(fraction, fmt::format("{:.0f} s simulated", t));
    };
    channels = scenarios::RecordRest(scenario, rest.duration_s, options);
  }
  Print(channels, arguments.out, display);
  return kOk;
}

}  // namespace

void AddSimulateStaticCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<StaticArguments>();
  CLI::App* command =
      app.add_subcommand("simulate-static", "Record the sensors of a scenario at rest, for hours");
  command
      ->add_option(
          "SOURCE", arguments->source,
          "Scenario file or name, a preset of sensors by name or file (as of `piperun allan --preset`), or "
          "a file that holds only `sensors:`. What needs pipes is left out: hydrophones, markers, the pipe "
          "around "
          "a magnetometer")
      ->required();
  command->add_option("--duration", arguments->duration, "How long: number with s, min, h or d, e.g. 2.5h")
      ->required();
  command->add_option("--rate", arguments->rate_Hz,
                      "Sampling rate of the inertial sensors in Hz (default: theirs)");
  command->add_option("-o,--out", arguments->out, "Run folder to write")->required();
  command->add_flag("-f,--force", arguments->force, "Replace the run folder if it exists");
  command->add_option("--seed", arguments->seed, "Seed of all noise (default: the scenario's)");
  command->add_option("--run", arguments->run, "Run index: another draw under the same seed");
  command->add_option("--set", arguments->set, "Override a value: key=value")->allow_extra_args(false);
  command->callback([arguments, &display, &exit_code] { exit_code = SimulateStatic(*arguments, display); });
}

}  // namespace piperun::tools
