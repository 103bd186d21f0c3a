#include <benchmark/benchmark.h>

#include <numbers>

#include "sim/sensor.h"

namespace piperun::sim {
namespace {

constexpr double kSpin_rad_s = 2 * std::numbers::pi * 5;  // five whole turns a second
constexpr std::int64_t kPhysics_Hz = 1000;

/// Switches every error term of an IMU on.
class SwitchOnErrors : public ParamVisitor {
 public:
  void Number(const ParamInfo& info, const Range&, double& value) override {
    if (info.name != "rate_Hz") value = 1e-4;
  }
  void NumberOr(const ParamInfo&, const Range&, std::string_view, std::optional<double>& value) override {
    value = 100;
  }
  void Flag(const ParamInfo&, bool& value) override { value = true; }
  void Array(const ParamInfo&, const Range&, std::span<double> values) override {
    for (double& x : values) x = 1e-3;
  }
  void Group(const ParamInfo&, const std::function<void(ParamVisitor&)>& visit) override { visit(*this); }
  void Integer(const ParamInfo&, std::int64_t, std::int64_t, std::int64_t&) override {}
  void Text(const ParamInfo&, std::string&) override {}
  void Choice(const ParamInfo&, std::span<const std::string_view>, std::string&) override {}
  void Table(const ParamInfo&, const Range&, std::size_t, std::vector<double>&) override {}
  void List(const ParamInfo&, ParamList&) override {}
  void Map(const ParamInfo&, ParamMap&) override {}
};

/// One second of a rolling ball, to be played again and again.
std::vector<TruthState> RollingSecond() {
  std::vector<TruthState> states(kPhysics_Hz);
  for (std::int64_t k = 0; k < kPhysics_Hz; ++k) {
    TruthState& s = states[static_cast<std::size_t>(k)];
    const double t = static_cast<double>(k) / kPhysics_Hz;
    s.X_WB = {{t, 0, 0}, ExpSO3({0, kSpin_rad_s * t, 0})};
    s.w_WB_B = {0, kSpin_rad_s, 0};
    s.dtheta_B_rad = s.w_WB_B / kPhysics_Hz;
    s.f_WB_B = s.X_WB.q.conjugate() * Vector3d(0, 0, 9.80665);
  }
  return states;
}

/// Pushes the truth of every interval (2.5 steps at 400 Hz) and takes its sample.
void SampleRolling(benchmark::State& state, std::string_view kind_name, bool errors) {
  const Rate physics(kPhysics_Hz);
  std::unique_ptr<Sensor> sensor;
  for (const SensorKind& kind : SensorKinds()) {
    if (kind.name != kind_name) continue;
    const auto params = kind.make_params();
    SwitchOnErrors switch_on;
    if (errors) params->Visit(switch_on);
    sensor = kind.make(*params, {RandomStream(1, "sensor0", 0), {}, {0, 0, -9.80665}, physics});
  }
  std::vector<TruthState> second = RollingSecond();
  TruthWindow window(physics, 16);
  std::int64_t step = 0, k = 0;
  for (auto _ : state) {
    while (step == 0 || window.latest_time() < sensor->DueTime(k) + Duration(1'000'000)) {
      TruthState& truth = second[static_cast<std::size_t>(step % kPhysics_Hz)];
      truth.time = SampleTime(step++, physics);
      window.Push(truth);
    }
    benchmark::DoNotOptimize(sensor->Sample(k++, window));
  }
  state.SetItemsProcessed(state.iterations());
}

void ImuSample(benchmark::State& state) { SampleRolling(state, "imu", true); }
void ImuSampleIdeal(benchmark::State& state) { SampleRolling(state, "imu", false); }
void MagnetometerSample(benchmark::State& state) { SampleRolling(state, "magnetometer", false); }
BENCHMARK(ImuSample);
BENCHMARK(ImuSampleIdeal);
BENCHMARK(MagnetometerSample);

}  // namespace
}  // namespace piperun::sim
