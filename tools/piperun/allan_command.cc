#include <fmt/core.h>

#include <memory>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/allan_report.h"
#include "scenarios/output_file.h"
#include "scenarios/static_record.h"
#include "tools/piperun/allan_text.h"
#include "tools/piperun/command.h"
#include "tools/piperun/progress_bar.h"

namespace piperun::tools {
namespace {

struct AllanArguments {
  std::string file;
  std::vector<std::string> columns, units;
  std::string time_column, time_unit;
  std::optional<double> rate_Hz;
  double full_scale = 1, confidence = 0.95;
  std::string flicker = "poles";
  bool gauss_markov = false;
  std::int64_t shortest_cluster = 0;  // not given
  int jobs = 0;
  std::string json, kalibr, preset, svg;
};

/// "gyro=a" -> (gyro, a)
std::pair<std::string, std::string> SplitAssignment(const std::string& text, const char* option) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError("'" + text + "' is not of the form GROUP=VALUE", option);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<std::string> SplitNames(const std::string& text) {
  std::vector<std::string> names(1);
  for (const char c : text) c == ',' ? static_cast<void>(names.emplace_back()) : names.back().push_back(c);
  return names;
}

scenarios::StaticRecordOptions MakeRecordOptions(const AllanArguments& arguments) {
  scenarios::StaticRecordOptions options;
  for (const std::string& text : arguments.columns) {
    const auto [group, names] = SplitAssignment(text, "--columns");
    options.columns.emplace_back(group, SplitNames(names));
  }
  for (const std::string& text : arguments.units) options.units.push_back(SplitAssignment(text, "--unit"));
  options.time_column = arguments.time_column;
  options.time_unit = arguments.time_unit;
  options.rate_Hz = arguments.rate_Hz;
  options.full_scale = arguments.full_scale;
  return options;
}

scenarios::AllanAnalysis Analyse(const AllanArguments& arguments, const Display& display) {
  const auto record = scenarios::OpenStaticRecord(arguments.file, MakeRecordOptions(arguments));
  if (!arguments.kalibr.empty()) scenarios::RequireKalibrGroups(record->groups());
  ProgressBar bar("allan", !display.quiet && !display.json);
  scenarios::AllanOptions options;
  options.fit.flicker =
      arguments.flicker == "ideal" ? estimator::FlickerForm::kIdeal : estimator::FlickerForm::kPoles;
  options.fit.terms[estimator::Index(estimator::NoiseTerm::kGaussMarkov)] = arguments.gauss_markov;
  options.fit.shortest_cluster = std::max<std::int64_t>(1, arguments.shortest_cluster);
  options.leave_out_smooth = arguments.shortest_cluster == 0;
  options.fit.confidence = arguments.confidence;
  options.jobs = arguments.jobs;
  options.stop = &stop_requested;
  options.progress = [&bar](double fraction) { bar.Update(fraction, fraction < 1 ? "reading" : "fitting"); };
  return AnalyseStaticRecord(*record, arguments.file, options);
}

void WriteFiles(const scenarios::AllanAnalysis& analysis, const AllanArguments& arguments) {
  // all texts first: a file is written only when every one can be
  const std::pair<const std::string&, std::string> files[] = {
      {arguments.json, arguments.json.empty() ? "" : WriteAllanJson(analysis)},
      {arguments.kalibr, arguments.kalibr.empty() ? "" : WriteKalibrYaml(analysis)},
      {arguments.preset, arguments.preset.empty() ? "" : WriteSensorPreset(analysis)},
      {arguments.svg, arguments.svg.empty() ? "" : DrawAllanSvg(analysis)}};
  for (const auto& [path, text] : files) {
    if (!path.empty()) scenarios::WriteTextFile(path, text);
  }
}

int Allan(const AllanArguments& arguments, const Display& display) {
  const scenarios::AllanAnalysis analysis = Analyse(arguments, display);
  WriteFiles(analysis, arguments);
  if (display.json) {
    fmt::print("{}", WriteAllanJson(analysis));
  } else if (!display.quiet) {
    fmt::print("{}", DescribeAllan(analysis));
  }
  if (analysis.at_rest()) return kOk;
  fmt::print(stderr,
             "piperun: {}: the sensor was not at rest; the figures are not those of its noise alone\n",
             arguments.file);
  return kFailed;
}

constexpr const char* kFooter =
    "FILE is a run folder (its mav0/imu0), a CSV file whose header names units (EuRoC: 'a_RS_S_x [m s^-2]'), "
    "any\n"
    "CSV with --columns and --unit, or a mono WAV or FLAC file. Example of a plain log:\n"
    "  piperun allan log.csv --columns gyro=gx,gy,gz --unit gyro=deg/s --columns accel=ax,ay,az --unit "
    "accel=g \\\n"
    "      --time-column t --svg log.svg --preset my_imu.yaml\n"
    "Exit code 1: the sensor was not at rest.";

}  // namespace

void AddAllanCommand(CLI::App& app, Display& display, int& exit_code) {
  auto a = std::make_shared<AllanArguments>();
  CLI::App* command =
      app.add_subcommand("allan", "Noise of a sensor at rest: Allan deviation, fitted terms, a preset");
  command->add_option("FILE", a->file, "The record")->required();
  command
      ->add_option("--columns", a->columns,
                   "GROUP=name,name,.. (gyro, accel, mag, pressure or a name of yours)")
      ->allow_extra_args(false);
  command->add_option("--unit", a->units, "GROUP=UNIT: deg/s, rad/s, mg, g, m/s^2, uT, Pa ..")
      ->allow_extra_args(false);
  command->add_option("--time-column", a->time_column, "Column of the time stamps");
  command->add_option("--time-unit", a->time_unit,
                      "Their unit: s, ms, us, ns (default: the header's, else s)");
  command->add_option("--rate", a->rate_Hz, "Sampling rate in Hz, for records without stamps");
  command->add_option("--full-scale", a->full_scale, "WAV: the largest count, in the group's unit");
  command->add_option("--confidence", a->confidence, "Of all intervals, two-sided (0.95)")
      ->check(CLI::Range(0.5, 0.9999));
  command->add_option("--flicker", a->flicker, "Fit flicker as the simulator's eight poles, or as ideal 1/f")
      ->check(CLI::IsMember({"poles", "ideal"}));
  command->add_flag("--gauss-markov", a->gauss_markov, "Fit a Gauss-Markov term, too");
  command
      ->add_option("--shortest-cluster", a->shortest_cluster,
                   "Leave shorter clusters (samples) out of the fit (default: those that a low-pass smooths)")
      ->check(CLI::PositiveNumber);
  command->add_option("--jobs", a->jobs, "Threads for the fits (0: all cores)")->check(CLI::Range(0, 1024));
  command->add_option("--json-file", a->json, "Write everything as JSON (--json prints it)");
  command->add_option("--kalibr", a->kalibr, "Write Kalibr's imu.yaml");
  command->add_option("--preset", a->preset,
                      "Write a preset of sensors (`sensors: {imu0: {kind: imu, preset: FILE}}`)");
  command->add_option("--svg", a->svg, "Draw the deviations with their fit");
  command->footer(kFooter);
  command->callback([a, &display, &exit_code] { exit_code = Allan(*a, display); });
}

}  // namespace piperun::tools
