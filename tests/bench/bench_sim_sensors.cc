#include <benchmark/benchmark.h>

#include <numbers>

#include "sim/imu_error.h"
#include "sim/imu_triad.h"
#include "sim/sensor.h"

namespace piperun::sim {
namespace {

constexpr double kSpin_rad_s = 2 * std::numbers::pi * 5;  // five whole turns a second
constexpr std::int64_t kPhysics_Hz = 1000;

enum class Errors { kNone, kInterval, kSteps };

/// Switches error terms of an IMU on: all that act on whole intervals, or those that need every physics step,
/// too.
class SwitchOnErrors : public ParamVisitor {
 public:
  explicit SwitchOnErrors(Errors errors) : errors_(errors) {}
  void Number(const ParamInfo& info, const Range&, double& value) override {
    if (info.name != "rate_Hz" && !info.name.ends_with("time_s")) value = 1e-4;
  }
  void NumberOr(const ParamInfo& info, const Range&, std::string_view,
                std::optional<double>& value) override {
    if (info.name != "analogue_bandwidth_Hz" || errors_ == Errors::kSteps) value = 100;
  }
  void Flag(const ParamInfo&, bool& value) override { value = true; }
  void Array(const ParamInfo& info, const Range&, std::span<double> values) override {
    const bool curved = info.name.starts_with("scale_second") || info.name.starts_with("scale_asym") ||
                        info.name.starts_with("vibration");
    if (curved && errors_ != Errors::kSteps) return;
    for (double& x : values) x = 1e-3;
  }
  void Group(const ParamInfo&, const std::function<void(ParamVisitor&)>& visit) override { visit(*this); }
  void Integer(const ParamInfo&, std::int64_t, std::int64_t, std::int64_t&) override {}
  void Text(const ParamInfo&, std::string&) override {}
  void Choice(const ParamInfo&, std::span<const std::string_view>, std::string&) override {}
  void Table(const ParamInfo&, const Range&, std::size_t, std::vector<double>&) override {}
  void List(const ParamInfo&, ParamList&) override {}
  void Map(const ParamInfo&, ParamMap&) override {}

 private:
  Errors errors_;
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
void SampleRolling(benchmark::State& state, std::string_view kind_name, Errors errors) {
  const Rate physics(kPhysics_Hz);
  std::unique_ptr<Sensor> sensor;
  for (const SensorKind& kind : SensorKinds()) {
    if (kind.name != kind_name) continue;
    const auto params = kind.make_params();
    SwitchOnErrors switch_on(errors);
    if (errors != Errors::kNone) params->Visit(switch_on);
    sensor = kind.make(*params, {RandomStream(1, "sensor0", 0), {}, {0, 0, -9.80665}, physics});
  }
  std::vector<TruthState> second = RollingSecond();
  TruthWindow window(physics, 16);
  std::int64_t step = 0, k = 0;
  for (auto _ : state) {
    while (step == 0 ||
           window.latest_time() < sensor->DueTime(k) + sensor->lookahead() + Duration(1'000'000)) {
      TruthState& truth = second[static_cast<std::size_t>(step % kPhysics_Hz)];
      truth.time = SampleTime(step++, physics);
      window.Push(truth);
    }
    benchmark::DoNotOptimize(sensor->Sample(k++, window));
  }
  state.SetItemsProcessed(state.iterations());
}

/// All six axes of the error model on true means: N, B, K, Q, Gauss-Markov, ramp, temperature, scale factor
/// and its instability, misalignment, g-sensitivity, range, register.
void ImuErrorModel(benchmark::State& state) {
  TriadErrorParams gyro, accel;
  SwitchOnErrors switch_on(Errors::kInterval);
  gyro.Visit(switch_on, kGyroFields);
  accel.Visit(switch_on, kAccelFields);
  const Rate rate(100), physics(kPhysics_Hz);
  const RandomStream random(1, "imu0", 0);
  ImuTriad w(TriadType::kGyroscope, gyro, rate, physics, {random, 0});
  ImuTriad f(TriadType::kAccelerometer, accel, rate, physics, {random, kTriadSlots});
  const Vector3d w_true(1, kSpin_rad_s, 2), f_true(1, 2, 9.8);
  std::int64_t k = 0;
  unsigned saturated = 0;
  for (auto _ : state) {
    w.BeginSample(k, 5);
    f.BeginSample(k++, 5);
    benchmark::DoNotOptimize(w.Read(w_true, f_true, saturated));
    benchmark::DoNotOptimize(f.Read(f_true, f_true, saturated));
  }
  state.SetItemsProcessed(state.iterations());
}

void ImuSample(benchmark::State& state) { SampleRolling(state, "imu", Errors::kInterval); }
void ImuSampleFiltered(benchmark::State& state) { SampleRolling(state, "imu", Errors::kSteps); }
void ImuSampleIdeal(benchmark::State& state) { SampleRolling(state, "imu", Errors::kNone); }
void MagnetometerSample(benchmark::State& state) { SampleRolling(state, "magnetometer", Errors::kNone); }
BENCHMARK(ImuErrorModel);
BENCHMARK(ImuSample);
BENCHMARK(ImuSampleFiltered);
BENCHMARK(ImuSampleIdeal);
BENCHMARK(MagnetometerSample);

}  // namespace
}  // namespace piperun::sim
