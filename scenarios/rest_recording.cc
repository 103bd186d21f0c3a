#include "scenarios/rest_recording.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"

namespace piperun::scenarios {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::size_t kAxes = 3;

std::size_t FindImu(const Assembly& assembly, const Scenario& scenario, const std::string& sensor) {
  for (std::size_t i = 0; i < assembly.channel_names.size(); ++i) {
    const bool imu = std::any_of(scenario.sensors.begin(), scenario.sensors.end(), [&](const SensorEntry& e) {
      return e.name == sensor && e.kind.records() == "imu";
    });
    if (imu && assembly.channel_names[i] == sensor) return i;
  }
  throw InputError("there is no inertial sensor of this name", "sensors." + sensor);
}

class SimulatedRecord : public StaticRecord {
 public:
  SimulatedRecord(const Scenario& scenario, const std::string& sensor, double duration_s)
      : assembly_(Assemble(scenario)),
        channel_(*assembly_->channels[FindImu(*assembly_, scenario, sensor)]),
        recording_(channel_, assembly_->motion->state(), assembly_->motion->rate()),
        end_(TrueTime(FromSeconds(duration_s))) {
    timing_.period_s = dynamic_cast<const SensorChannel&>(channel_).sensor().rate().Period_s();
  }

  const std::vector<RecordGroup>& groups() const override { return groups_; }
  const RecordTiming& timing() const override { return timing_; }
  double progress() const override { return std::min(1.0, Seconds(channel_.due()) / Seconds(end_)); }

  bool Next(RecordBlock& block) override {
    block.starts_segment = !follows_;
    block.channels.resize(2 * kAxes);
    for (auto& channel : block.channels) channel.clear();
    const std::vector<double>& first = block.channels.front();
    const Measurement* measurement = nullptr;
    while (first.size() < kBlock && recording_.Next(end_, measurement)) {
      follows_ = measurement != nullptr;
      if (follows_) {
        Append(std::get<ImuSample>(measurement->value), block);
      } else {
        CountLost();
        if (!first.empty()) break;
        block.starts_segment = true;
      }
    }
    timing_.rows += static_cast<std::int64_t>(first.size());
    return !first.empty();
  }

 private:
  void CountLost() {
    if (timing_.gaps.count++ == 0) timing_.gaps.first = FormatNumber(Seconds(channel_.due())) + " s";
    timing_.missing_s += timing_.period_s;
  }
  static void Append(const ImuSample& sample, RecordBlock& block) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      block.channels[axis].push_back(sample.w_WS_S_rad_s[i]);
      block.channels[kAxes + axis].push_back(sample.f_WS_S_m_s2[i]);
    }
  }

  std::unique_ptr<Assembly> assembly_;
  Channel& channel_;
  RestRecording recording_;
  TrueTime end_;
  bool follows_ = false;
  RecordTiming timing_;
  std::vector<RecordGroup> groups_{{"gyro", "rad/s", {"x", "y", "z"}}, {"accel", "m/s^2", {"x", "y", "z"}}};
};

}  // namespace

RestRecording::RestRecording(Channel& channel, const sim::TruthState& rest, Rate truth_rate)
    : channel_(channel),
      state_(rest),
      window_(truth_rate, static_cast<std::size_t>(
                              std::ceil(Seconds(channel.history() + channel.lookahead()) * truth_rate.Hz())) +
                              8) {}

bool RestRecording::Next(TrueTime end, const Measurement*& measurement) {
  const TrueTime due = channel_.due();
  if (due > end) return false;
  while (next_step_ == 0 || window_.latest_time() < due + channel_.lookahead()) {
    state_.time = SampleTime(next_step_++, window_.rate());
    window_.Push(state_);
  }
  measurement = channel_.Take(window_);
  return true;
}

std::unique_ptr<StaticRecord> SimulateStaticRecord(const Scenario& scenario, const std::string& sensor,
                                                   double duration_s) {
  return std::make_unique<SimulatedRecord>(scenario, sensor, duration_s);
}

}  // namespace piperun::scenarios
