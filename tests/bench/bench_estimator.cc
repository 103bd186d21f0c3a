#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "estimator/allan.h"
#include "estimator/attitude_eskf.h"
#include "estimator/attitude_iekf.h"
#include "estimator/attitude_ukf.h"
#include "estimator/filter_kind.h"
#include "estimator/leak_locator.h"

namespace piperun::estimator {
namespace {

constexpr double kRate_Hz = 400;
constexpr double kAudioRate_Hz = 16000;
constexpr std::size_t kBlock = 1600;
const Vector3d kField_W_T{2.6e-6, 25.1e-6, -40.4e-6};
constexpr double kSpin_rad_s = 12;  // 0.36 m/s on 30 mm

/// Turns off the locator of a filter, so that navigation is timed alone.
class NoLocator : public ParamVisitor {
 public:
  void Number(const ParamInfo&, const Range&, double&) override {}
  void NumberOr(const ParamInfo&, const Range&, std::string_view, std::optional<double>&) override {}
  void Integer(const ParamInfo&, std::int64_t, std::int64_t, std::int64_t&) override {}
  void Flag(const ParamInfo&, bool&) override {}
  void Text(const ParamInfo&, std::string&) override {}
  void Choice(const ParamInfo& info, std::span<const std::string_view> allowed, std::string& value) override {
    if (info.name == "kind" && allowed.front() == "none") value = "none";
  }
  void Array(const ParamInfo&, const Range&, std::span<double>) override {}
  void Table(const ParamInfo&, const Range&, std::size_t, std::vector<double>&) override {}
  void Group(const ParamInfo&, const std::function<void(ParamVisitor&)>& visit) override { visit(*this); }
  void List(const ParamInfo&, ParamList&) override {}
  void Map(const ParamInfo&, ParamMap&) override {}
};

EstimatorStart MakeStart() {
  PipeSpec pipe;
  pipe.id = "P1";
  pipe.from = "A";
  pipe.to = "B";
  pipe.diameter_m = 0.15;
  pipe.wall_thickness_m = 0.0075;
  pipe.material = {"pvc_u", 3.5e9, 0.05, 0.4, 1400, 1.5e-6};
  Network network({{"A", {0, 0, 0}}, {"B", {1e6, 0, 0}}}, {pipe});
  Route route(network, {{0, false}});
  EstimatorStart start;
  start.map.emplace(RouteMap{std::move(network), std::move(route)});
  start.field_W_T = kField_W_T;
  return start;
}

/// One IMU sample of a ball rolling towards x about its y axis.
Measurement ImuAt(std::int64_t k) {
  const double angle = kSpin_rad_s * (static_cast<double>(k) - 0.5) / kRate_Hz;
  return {0, ImuSample{RobotTime(SampleOffset(k, Rate(kRate_Hz))),
                       {0, kSpin_rad_s, 0},
                       {-9.80665 * std::sin(angle), 0, 9.80665 * std::cos(angle)},
                       std::nullopt}};
}

/// What its magnetometer reads at the same instant.
MagSample MagAt(std::int64_t k) {
  const RobotTime stamp(SampleOffset(k, Rate(kRate_Hz)));
  return {stamp, ExpSO3({0, -kSpin_rad_s * Seconds(stamp), 0}) * kField_W_T};
}

/// One IMU sample and an eighth of a magnetometer sample.
void BM_ImuUpdate(benchmark::State& state, const FilterKind& kind) {
  const auto params = kind.make_params();
  NoLocator off;
  params->Visit(off);
  const auto filter = kind.make(*params, MakeStart());
  std::int64_t k = 0;
  for (auto _ : state) {
    const Measurement imu = ImuAt(++k);
    filter->Ingest(imu);
    if (k % 8 == 0) filter->Ingest({1, MagAt(k)});
  }
  benchmark::DoNotOptimize(filter->nav().chainage_m);
}

/// The attitude filter alone: one interval with its gravity update, and an eighth of a magnetometer sample.
template <class Filter>
void BM_AttitudeUpdate(benchmark::State& state) {
  Filter filter({}, 9.80665, kField_W_T);
  filter.AlignTilt({0, 0, 9.80665});
  ImuStep step;
  step.dt_s = 1 / kRate_Hz;
  step.w_S_rad_s = {0, kSpin_rad_s, 0};
  step.dtheta_S_rad = step.dt_s * step.w_S_rad_s;
  std::int64_t k = 0;
  for (auto _ : state) {
    step.f_S_m_s2 = std::get<ImuSample>(ImuAt(++k).value).f_WS_S_m_s2;
    filter.Propagate(step);
    filter.UpdateGravity(step, 0.05);
    if (k % 8 == 0) filter.UpdateMagnetic(MagAt(k).m_S_T, Vector3d::Zero());
  }
  benchmark::DoNotOptimize(filter.q_WS().w());
}
BENCHMARK(BM_AttitudeUpdate<AttitudeEskf>);
BENCHMARK(BM_AttitudeUpdate<AttitudeIekf>);
BENCHMARK(BM_AttitudeUpdate<AttitudeUkf>);
BENCHMARK(BM_AttitudeUpdate<AttitudeEkf>);

void BM_AudioBlock(benchmark::State& state, const LocatorKind& kind) {
  const auto params = kind.make_params();
  const auto locator = kind.make(*params, MakeStart());
  const RandomStream random(1, "hydrophone", 0);
  std::vector<std::int32_t> counts(kBlock);
  for (std::size_t i = 0; i < kBlock; ++i)
    counts[i] = static_cast<std::int32_t>(random.Normals(i, 0)[0] * 1e4);
  std::int64_t n = 0;
  for (auto _ : state) {
    ++n;
    NavState nav;
    nav.valid = true;
    nav.stamp = RobotTime(SampleOffset(n, Rate(kAudioRate_Hz / kBlock)));
    nav.chainage_m = 0.36 * Seconds(nav.stamp);
    locator->IngestNav(nav);
    locator->IngestAudio({nav.stamp, kAudioRate_Hz, 1e-6, counts});
  }
  state.counters["x_real_time"] =
      benchmark::Counter(static_cast<double>(n) * kBlock / kAudioRate_Hz, benchmark::Counter::kIsRate);
}

/// The record of the thesis: 882,472 samples of one axis, 93 clusters of the default grid, every overlap.
void BM_AllanRecord(benchmark::State& state) {
  const RandomStream random(1, "allan", 0);
  std::vector<double> rate(882472);
  for (std::size_t k = 0; k < rate.size(); ++k) rate[k] = random.Normals(k, 0)[0];
  std::size_t clusters = 0;
  for (auto _ : state) clusters = CalcAllanVariance(rate).size();
  state.counters["clusters"] = static_cast<double>(clusters);
}
BENCHMARK(BM_AllanRecord)->Unit(benchmark::kMillisecond);

const int kRegistered = [] {
  for (const FilterKind& kind : FilterKinds()) {
    benchmark::RegisterBenchmark(("ImuUpdate/" + std::string(kind.name)).c_str(), BM_ImuUpdate, kind);
  }
  for (const LocatorKind& kind : LocatorKinds()) {
    benchmark::RegisterBenchmark(("AudioBlock/" + std::string(kind.name)).c_str(), BM_AudioBlock, kind);
  }
  return 0;
}();

}  // namespace
}  // namespace piperun::estimator
