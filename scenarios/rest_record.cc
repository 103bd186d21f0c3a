#include "scenarios/rest_record.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/assemble.h"
#include "scenarios/load.h"
#include "scenarios/measurement_writer.h"
#include "scenarios/output_file.h"
#include "scenarios/run_folder.h"
#include "scenarios/seal.h"
#include "sim/imu_params.h"

namespace piperun::scenarios {
namespace {

constexpr double kFilterRate_Hz = 1000;
constexpr double kLeastTruthRate_Hz = 100;  // of scripted motions
constexpr double kMostTruthRate_Hz = 10'000;

/// What makes a file that holds only sensors a scenario.
std::vector<std::string> CompleteSensorFile(const std::string& source) {
  if (!std::filesystem::is_regular_file(source)) return {};
  std::string schema;
  YamlDocument::FromFile(source).ReadSome([&](ParamVisitor& v) { v.Text({"schema", ""}, schema); });
  if (!schema.empty()) return {};
  return {"schema=piperun.scenario/1", "name=" + std::filesystem::path(source).stem().string()};
}

bool IsAudio(const SensorEntry& entry) { return entry.kind.records() == "audio"; }

/// The physics rate that the sensors' records at rest hang on or, if none does, the lowest they can do with.
double FindTruthRate_Hz(const Scenario& scenario) {
  double rate_Hz = kLeastTruthRate_Hz;
  const std::unique_ptr<Assembly> assembly = Assemble(scenario);
  for (const auto& channel : assembly->channels) {
    rate_Hz = std::max(rate_Hz, dynamic_cast<const SensorChannel&>(*channel).sensor().rate().Hz());
  }
  for (const SensorEntry& entry : scenario.sensors) {
    const auto* imu = dynamic_cast<const sim::ImuParams*>(&entry.kind.params());
    if (imu && imu->filtered()) rate_Hz = std::max(rate_Hz, kFilterRate_Hz);
  }
  return rate_Hz;
}

std::vector<std::string> RateOverrides(const Scenario& scenario, std::optional<double> rate_Hz) {
  std::vector<std::string> overrides;
  for (const SensorEntry& entry : scenario.sensors) {
    if (rate_Hz && entry.kind.records() == "imu")
      overrides.push_back("sensors." + entry.name + ".rate_Hz=" + FormatNumber(*rate_Hz));
  }
  return overrides;
}

void Append(const std::vector<std::string>& more, std::vector<std::string>& overrides) {
  overrides.insert(overrides.end(), more.begin(), more.end());
}

void KeepSensorsOnly(Scenario& scenario) {
  std::erase_if(scenario.sensors, IsAudio);
  if (scenario.sensors.empty())
    throw InputError("nothing to record: there is no sensor but hydrophones", "sensors");
  Scenario rest;
  rest.schema = scenario.schema;
  rest.name = scenario.name;
  rest.seed = scenario.seed;
  rest.run = scenario.run;
  rest.gravity_m_s2 = scenario.gravity_m_s2;
  rest.water = scenario.water;
  rest.motion = scenario.motion;
  rest.ball = scenario.ball;
  rest.sensors = scenario.sensors;
  rest.sources = scenario.sources;
  scenario = std::move(rest);
}

/// One channel from the start to the end, fed with the truth of a body that stays as it is.
class ChannelRecording {
 public:
  ChannelRecording(Channel& channel, const sim::TruthState& rest, Rate truth_rate)
      : channel_(channel),
        state_(rest),
        window_(truth_rate, static_cast<std::size_t>(std::ceil(
                                Seconds(channel.history() + channel.lookahead()) * truth_rate.Hz())) +
                                8) {}

  /// The next measurement, if it is due by `end`; null when it was lost.
  bool Next(TrueTime end, const Measurement*& measurement) {
    const TrueTime due = channel_.due();
    if (due > end) return false;
    while (next_step_ == 0 || window_.latest_time() < due + channel_.lookahead()) {
      state_.time = SampleTime(next_step_++, window_.rate());
      window_.Push(state_);
    }
    measurement = channel_.Take(window_);
    return true;
  }

 private:
  Channel& channel_;
  sim::TruthState state_;
  sim::TruthWindow window_;
  std::int64_t next_step_ = 0;
};

/// Progress of one channel among all, now and then; ends the recording when the user asks to.
class Reporter {
 public:
  Reporter(const RunOptions& options, std::size_t channel, std::size_t channels, TrueTime end)
      : options_(options),
        channel_(static_cast<double>(channel)),
        channels_(static_cast<double>(channels)),
        end_(end) {}
  void Count(TrueTime due) {
    if (++count_ % 4096 != 0) return;
    if (options_.stop && *options_.stop) throw Interrupted();
    const double part = Seconds(due) / Seconds(end_);
    if (options_.progress) options_.progress(Seconds(due), (channel_ + part) / channels_);
  }

 private:
  const RunOptions& options_;
  double channel_;
  double channels_;
  TrueTime end_;
  std::int64_t count_ = 0;
};

RestChannel RecordChannel(Channel& channel, const sim::TruthState& rest, Rate truth_rate, TrueTime end,
                          MeasurementWriter& writer, Reporter reporter) {
  RestChannel result;
  ChannelRecording recording(channel, rest, truth_rate);
  for (const Measurement* measurement = nullptr; recording.Next(end, measurement);) {
    ++(measurement ? result.samples : result.lost);
    if (measurement) writer.Write(*measurement);
    reporter.Count(channel.due());
  }
  writer.Close();
  return result;
}

}  // namespace

Scenario LoadRestScenario(const std::string& source, const RestOptions& options) {
  const std::vector<std::string> complete = CompleteSensorFile(source);
  const auto load = [&](const std::vector<std::string>& ours) {
    std::vector<std::string> overrides = complete;
    Append(ours, overrides);
    Append(options.overrides, overrides);
    Scenario scenario = LoadScenario(source, overrides);
    KeepSensorsOnly(scenario);
    return scenario;
  };
  const auto rest = [&](double rate_Hz) {
    return "motion={kind: scripted, rate_Hz: " + FormatNumber(rate_Hz) +
           ", script: rest, rest: {duration_s: " + FormatNumber(options.duration_s) + "}}";
  };
  std::vector<std::string> ours{rest(kMostTruthRate_Hz)};
  Append(RateOverrides(load(ours), options.rate_Hz), ours);
  ours.front() = rest(FindTruthRate_Hz(load(ours)));
  return load(ours);
}

std::vector<RestChannel> RecordRest(const Scenario& scenario, double duration_s, const RunOptions& options) {
  const auto begin = StartWatch();
  RunFolder folder(options.out, options.force);
  const std::unique_ptr<Assembly> assembly = Assemble(scenario);
  const sim::TruthState rest = assembly->motion->state();
  const Rate truth_rate = assembly->motion->rate();
  const TrueTime end = TrueTime(FromSeconds(duration_s));
  std::vector<RestChannel> channels;
  for (std::size_t i = 0; i < assembly->channels.size(); ++i) {
    const std::string& name = assembly->channel_names[i];
    const auto entry = std::find_if(scenario.sensors.begin(), scenario.sensors.end(),
                                    [&](const SensorEntry& e) { return e.name == name; });
    const auto& sensor = dynamic_cast<const SensorChannel&>(*assembly->channels[i]).sensor();
    const auto writer =
        MakeMeasurementWriter(*entry, sensor.X_BS(), RecordOptions{}, folder.Folder("mav0/" + name));
    channels.push_back(RecordChannel(*assembly->channels[i], rest, truth_rate, end, *writer,
                                     Reporter(options, i, assembly->channels.size(), end)));
    channels.back().name = name;
  }
  WriteTextFile(folder.staging() / "scenario.yaml", WriteScenario(scenario));
  RunResult result;
  result.scenario = scenario.name;
  result.seed = scenario.seed;
  result.run = scenario.run;
  result.status = "ok";
  result.duration_s = Seconds(end);
  Seal(folder, begin, result);
  return channels;
}

}  // namespace piperun::scenarios
