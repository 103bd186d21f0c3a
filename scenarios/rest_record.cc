#include "scenarios/rest_record.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/assemble.h"
#include "scenarios/load.h"
#include "scenarios/measurement_writer.h"
#include "scenarios/output_file.h"
#include "scenarios/rest_recording.h"
#include "scenarios/run_folder.h"
#include "scenarios/seal.h"
#include "scenarios/sensor_presets.h"
#include "sim/imu_params.h"

namespace piperun::scenarios {
namespace {

constexpr double kFilterRate_Hz = 1000;
constexpr double kLeastTruthRate_Hz = 100;  // of scripted motions
constexpr double kMostTruthRate_Hz = 10'000;

/// What a source is, by its keys: a scenario has a schema, a preset a name, a file that holds only sensors
/// neither.
enum class SourceType { kScenario, kSensors, kPreset };

SourceType FindSourceType(const std::string& source) {
  const auto presets = SensorPresets();
  const bool known = std::any_of(presets.begin(), presets.end(),
                                 [&](const SensorPreset& preset) { return preset.name == source; });
  if (known) return SourceType::kPreset;
  if (!std::filesystem::is_regular_file(source)) return SourceType::kScenario;
  std::string schema, name, description;
  YamlDocument::FromFile(source).ReadSome([&](ParamVisitor& v) {
    v.Text({"schema", ""}, schema);
    v.Text({"name", ""}, name);
    v.Text({"description", ""}, description);
  });
  if (!schema.empty()) return SourceType::kScenario;
  return name.empty() && description.empty() ? SourceType::kSensors : SourceType::kPreset;
}

/// What makes a file that holds only sensors a scenario.
std::vector<std::string> CompleteSensorFile(const std::string& source) {
  return {"schema=piperun.scenario/1", "name=" + std::filesystem::path(source).stem().string()};
}

Scenario LoadSource(const std::string& source, SourceType type, const std::vector<std::string>& overrides) {
  if (type != SourceType::kPreset) return LoadScenario(source, overrides);
  const SensorPreset preset = LoadSensorPreset(source, {});
  const std::string name = preset.from_file ? std::filesystem::path(source).filename().string() : source;
  return ParseScenario(WritePresetScenario(preset, name), source, overrides);
}

bool NeedsPipes(const SensorEntry& entry) {
  return entry.kind.records() == "audio" || entry.kind.records() == "marker";
}

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

/// What a scenario must change to rest: the rate asked for, and no pipe around its magnetometers.
std::vector<std::string> OverridesAtRest(const Scenario& scenario, std::optional<double> rate_Hz) {
  std::vector<std::string> overrides;
  for (const SensorEntry& entry : scenario.sensors) {
    if (rate_Hz && entry.kind.records() == "imu")
      overrides.push_back("sensors." + entry.name + ".rate_Hz=" + FormatNumber(*rate_Hz));
    if (entry.kind.kind() == "magnetometer") overrides.push_back("sensors." + entry.name + ".pipe={}");
  }
  return overrides;
}

void Append(const std::vector<std::string>& more, std::vector<std::string>& overrides) {
  overrides.insert(overrides.end(), more.begin(), more.end());
}

void KeepSensorsOnly(Scenario& scenario) {
  std::erase_if(scenario.sensors, NeedsPipes);
  if (scenario.sensors.empty())
    throw InputError("nothing to record: there is no sensor but hydrophones and markers", "sensors");
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
  RestRecording recording(channel, rest, truth_rate);
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
  const SourceType type = FindSourceType(source);
  std::vector<std::string> complete;
  if (type == SourceType::kSensors) complete = CompleteSensorFile(source);
  const auto load = [&](const std::vector<std::string>& ours) {
    std::vector<std::string> overrides = complete;
    Append(ours, overrides);
    Append(options.overrides, overrides);
    Scenario scenario = LoadSource(source, type, overrides);
    KeepSensorsOnly(scenario);
    return scenario;
  };
  const auto rest = [&](double rate_Hz) {
    return "motion={kind: scripted, rate_Hz: " + FormatNumber(rate_Hz) +
           ", script: rest, rest: {duration_s: " + FormatNumber(options.duration_s) + "}}";
  };
  std::vector<std::string> ours{rest(kMostTruthRate_Hz)};
  Append(OverridesAtRest(load(ours), options.rate_Hz), ours);
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
