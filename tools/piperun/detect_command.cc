#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/number.h"
#include "estimator/leak_locator.h"
#include "scenarios/detect.h"
#include "scenarios/output_file.h"
#include "tools/piperun/command.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

struct DetectArguments {
  std::string audio, pipe, track, locator, out, geojson;
  std::optional<double> speed_sd_m_s;
};

/// Flow in L/min, `sigmas` of its standard deviations away.
std::string FlowText(const estimator::LeakEstimate& leak, double sigmas) {
  if (!leak.flow_m3_s) return "-";
  return FormatDigits(60e3 * *leak.flow_m3_s * std::pow(10, sigmas * leak.flow_sigma_dB / 20), 2);
}

std::string DescribeDetections(const scenarios::Detections& detections) {
  if (detections.leaks.empty()) return "no leak found\n";
  Table table({"time_s", "chainage_m", "95%_from", "to", "confidence", "flow_L/min", "95%_from", "to", "at"});
  for (const estimator::LeakEstimate& leak : detections.leaks) {
    table.Add({FormatFixed(Seconds(leak.t_cpa), 2), detections.placed ? FormatFixed(leak.chainage_m, 2) : "-",
               detections.placed ? FormatFixed(leak.interval.low_m, 2) : "-",
               detections.placed ? FormatFixed(leak.interval.high_m, 2) : "-",
               FormatFixed(leak.confidence, 3), FlowText(leak, 0), FlowText(leak, -1.96),
               FlowText(leak, 1.96), leak.at.value_or("-")});
  }
  std::string text = table.Text();
  if (detections.placed) text += "intervals hold " + detections.interval_holds + "\n";
  return text;
}

void Describe(const scenarios::Detections& detections) {
  fmt::print("{}: {} s at {} Hz, {}\n", detections.audio, FormatFixed(detections.duration_s, 1),
             FormatNumber(detections.rate_Hz), detections.locator);
  if (!detections.placed)
    fmt::print("nothing is known of the way (--pipe, --track): times only, for a ball at about 0.5 m/s\n");
  if (detections.full_scale_samples > 0)
    fmt::print("{} samples at full scale\n", detections.full_scale_samples);
  fmt::print("{}", DescribeDetections(detections));
}

std::string ListLocators() {
  std::string names;
  for (const estimator::LocatorKind& kind : estimator::LocatorKinds())
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

int Detect(const DetectArguments& arguments, const Display& display) {
  scenarios::DetectOptions options;
  options.audio = arguments.audio;
  options.track = arguments.track;
  options.locator = arguments.locator;
  options.speed_sd_m_s = arguments.speed_sd_m_s;
  if (!arguments.pipe.empty()) options.pipe = scenarios::LoadDetectPipe(arguments.pipe);
  const scenarios::Detections detections = scenarios::Detect(options);
  const std::string json = scenarios::WriteDetectionsJson(detections);
  if (!arguments.out.empty()) {
    const std::filesystem::path out = arguments.out;
    std::filesystem::create_directories(out);
    scenarios::WriteTextFile(out / "detections.json", json);
    scenarios::WriteTextFile(out / "detections.csv", scenarios::WriteDetectionsCsv(detections));
    scenarios::WriteTextFile(out / "detections.svg", scenarios::DrawDetectionsSvg(detections));
  }
  if (!arguments.geojson.empty())
    scenarios::WriteTextFile(arguments.geojson, scenarios::WriteDetectionsGeoJson(detections));
  if (display.json) {
    fmt::print("{}", json);
  } else if (!display.quiet) {
    Describe(detections);
  }
  return kOk;
}

}  // namespace

void AddDetectCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<DetectArguments>();
  CLI::App* command = app.add_subcommand("detect", "Find leaks in a recording of a passing hydrophone");
  command
      ->add_option("AUDIO", arguments->audio,
                   "Sound file of one channel: WAV, FLAC, whatever libsndfile reads")
      ->required();
  command->add_option("--pipe", arguments->pipe,
                      "YAML file: material, diameter_m, wall_thickness_m; speed_m_s (0.5), speed_sd_m_s, "
                      "start_chainage_m, length_m, full_scale_Pa (1000), fittings [{id, kind, chainage_m}], "
                      "line_m, origin, locator {kind, ..}");
  command->add_option(
      "--track", arguments->track,
      "Where the ball was: CSV with header time_s,chainage_m[,chainage_sd_m] (otherwise constant "
      "speed)");
  command->add_option(
      "--speed-sd", arguments->speed_sd_m_s,
      "How well the constant speed is known, m/s, standard deviation: intervals then hold it");
  command->add_option("--geojson", arguments->geojson,
                      "File for dig points, GeoJSON; the pipe file gives line_m and origin");
  command->add_option("--locator", arguments->locator, "Locator, default parameters: " + ListLocators());
  command->add_option("-o,--out", arguments->out, "Folder for detections.csv, .json and .svg");
  command->callback([arguments, &display, &exit_code] { exit_code = Detect(*arguments, display); });
}

}  // namespace piperun::tools
