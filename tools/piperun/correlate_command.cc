#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/number.h"
#include "scenarios/correlate.h"
#include "scenarios/output_file.h"
#include "tools/piperun/command.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

struct CorrelateArguments {
  scenarios::CorrelateOptions options;
  scenarios::CorrelatePipe pipe;
  std::string a, b, weight = "scot", out;
  double speed_m_s = 0;
  std::vector<double> band_Hz;
};

void Describe(const scenarios::Correlation& correlation) {
  const estimator::DelayEstimate& delay = correlation.delay;
  fmt::print("{}, {}: {} s at {} Hz, {} to {} Hz; {} m apart, sound at {} m/s\n", correlation.audio[0],
             correlation.audio[1], FormatFixed(correlation.duration_s, 1), FormatNumber(correlation.rate_Hz),
             FormatFixed(delay.band_low_Hz, 0), FormatFixed(delay.band_high_Hz, 0),
             FormatNumber(correlation.distance_m), FormatFixed(correlation.speed_m_s, 1));
  if (!delay.correlated) {
    fmt::print("no sound in common: a correlation of {} comes about by chance with a probability of {}\n",
               FormatDigits(delay.correlation, 2), FormatDigits(delay.false_alarm, 2));
    return;
  }
  const estimator::LeakBetween& leak = correlation.leak;
  Table table({"from_a_m", "from_b_m", "95%_from", "to", "delay_ms", "sigma_ms", "correlation", "side_peak"});
  table.Add({FormatFixed(leak.from_a_m, 2), FormatFixed(correlation.distance_m - leak.from_a_m, 2),
             FormatFixed(leak.interval.low_m, 2), FormatFixed(leak.interval.high_m, 2),
             FormatFixed(1e3 * delay.delay_s, 4), FormatFixed(1e3 * delay.sigma_s, 4),
             FormatFixed(delay.correlation, 3), FormatFixed(delay.side_peak, 2)});
  fmt::print("{}", table.Text());
  if (leak.maybe_beyond_a || leak.maybe_beyond_b)
    fmt::print("the sound may come from beyond {}: the delay does not tell how far\n",
               leak.maybe_beyond_a ? "a" : "b");
  if (delay.side_peak > 0.8) fmt::print("another peak is nearly as high: a wider band tells them apart\n");
}

int Correlate(CorrelateArguments& arguments, const Display& display) {
  scenarios::CorrelateOptions options = arguments.options;
  options.audio = {arguments.a, arguments.b};
  if (arguments.speed_m_s != 0) options.speed_m_s = arguments.speed_m_s;
  if (arguments.pipe.diameter_m != 0) options.pipe = arguments.pipe;
  const auto& names = estimator::kCorrelationWeightNames;
  options.weight =
      static_cast<estimator::CorrelationWeight>(std::ranges::find(names, arguments.weight) - names.begin());
  if (!arguments.band_Hz.empty())
    options.band_low_Hz = arguments.band_Hz[0], options.band_high_Hz = arguments.band_Hz[1];
  const scenarios::Correlation correlation = scenarios::Correlate(options);
  const std::string json = scenarios::WriteCorrelationJson(correlation);
  if (!arguments.out.empty()) {
    const std::filesystem::path out = arguments.out;
    std::filesystem::create_directories(out);
    scenarios::WriteTextFile(out / "correlation.json", json);
    scenarios::WriteTextFile(out / "correlation.svg", scenarios::DrawCorrelationSvg(correlation));
  }
  if (display.json) {
    fmt::print("{}", json);
  } else if (!display.quiet) {
    Describe(correlation);
  }
  return correlation.delay.correlated ? kOk : kFailed;
}

}  // namespace

void AddCorrelateCommand(CLI::App& app, Display& display, int& exit_code) {
  auto arguments = std::make_shared<CorrelateArguments>();
  CLI::App* command = app.add_subcommand("correlate", "Find the leak between two hydrophones on a pipe");
  command->add_option("A", arguments->a, "Sound file of sensor a, one channel")->required();
  command->add_option("B", arguments->b, "Sound file of sensor b, begun at the same instant")->required();
  command->add_option("--distance-m", arguments->options.distance_m, "Along the pipe from a to b")
      ->required();
  command->add_option("--distance-sd-m", arguments->options.distance_sd_m, "Its standard deviation")
      ->capture_default_str();
  CLI::Option* speed = command->add_option("--speed-m-s", arguments->speed_m_s, "Of sound in the pipe");
  CLI::Option* diameter =
      command->add_option("--diameter-m", arguments->pipe.diameter_m, "Bore, instead of the speed")
          ->excludes(speed);
  command->add_option("--wall-m", arguments->pipe.wall_thickness_m, "Thickness of the wall")->needs(diameter);
  command->add_option("--material", arguments->pipe.material, "Of the wall, from the library")
      ->capture_default_str()
      ->needs(diameter);
  command
      ->add_option("--speed-sd", arguments->options.speed_sd,
                   "Relative standard deviation of the speed; in plastic rather 0.1")
      ->capture_default_str();
  command
      ->add_option("--band", arguments->band_Hz, "Band in Hz, from and to (otherwise 10 to 0.45 of the rate)")
      ->expected(2);
  command->add_option("--weight", arguments->weight, "What each frequency counts: none, phat or scot")
      ->check(CLI::IsMember(std::vector<std::string>(estimator::kCorrelationWeightNames.begin(),
                                                     estimator::kCorrelationWeightNames.end())))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "Folder for correlation.json and .svg");
  command->callback([arguments, &display, &exit_code] { exit_code = Correlate(*arguments, display); });
}

}  // namespace piperun::tools
