#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "estimator/estimator.h"
#include "estimator/filter_kind.h"
#include "estimator/leak_locator.h"
#include "tests/estimator/rolling_ball.h"

namespace piperun::estimator::testing {

constexpr double kBoreRadius_m = 0.075;
constexpr double kBallRadius_m = 0.03;

inline WallMaterial PvcU() { return {"pvc_u", 3.5e9, 0.05, 0.4, 1400, 1.5e-6}; }

/// One DN150 PVC-U pipe along a polyline with bends of 3 D.
inline RouteMap MakeMap(const std::vector<Vector3d>& vertices, double bend_radius_m = 0.45) {
  PipeSpec pipe;
  pipe.id = "P1";
  pipe.from = "A";
  pipe.to = "B";
  pipe.diameter_m = 2 * kBoreRadius_m;
  pipe.wall_thickness_m = 0.0075;
  pipe.bend_radius_m = bend_radius_m;
  pipe.vertices_m.assign(vertices.begin() + 1, vertices.end() - 1);
  pipe.material = PvcU();
  Network network({{"A", vertices.front()}, {"B", vertices.back()}}, {pipe});
  Route route(network, {{0, false}});
  return {std::move(network), std::move(route)};
}

/// From rest, with a time constant of 1 s, to a speed that varies by a tenth.
inline double RunSpeed_m_s(double t) {
  return 0.36 * (1 - std::exp(-t)) * (1 + 0.1 * std::sin(2 * std::numbers::pi * t / 11));
}

/// The ball's way along a map, from its start to 0.3 m before its end.
inline RollingBall MakeBall(const RouteMap& map) {
  RollingBall ball;
  ball.line = map.network.pipe(0).centreline;
  ball.radius_m = kBallRadius_m;
  ball.depth_m = kBoreRadius_m - kBallRadius_m;
  ball.speed_m_s = RunSpeed_m_s;
  double s = 0;
  while (s < map.route.length_m() - 0.3) {
    s += 0.01 * RunSpeed_m_s(ball.duration_s + 0.005);
    ball.duration_s += 0.01;
  }
  ball.q_WB_start = ExpSO3({0.4, -1.3, 0.8});
  return ball;
}

inline EstimatorStart MakeStart(std::optional<RouteMap> map, const RollingBall& ball) {
  EstimatorStart start;
  start.map = std::move(map);
  start.p_W = EvalCentre(ball, 0).p;
  start.ball_radius_m = ball.radius_m;
  start.gravity_m_s2 = kGravity;
  start.field_W_T = kField_W_T;
  return start;
}

/// Sets named fields of a parameter struct ("rolling.slip_sd") and leaves the rest alone.
class Settings : public ParamVisitor {
 public:
  struct Value {
    std::string key;
    double number = 0;
    std::string text;
  };
  explicit Settings(std::vector<Value> values) : values_(std::move(values)) {}

  void Number(const ParamInfo& info, const Range&, double& value) override {
    if (const Value* v = Find(info)) value = v->number;
  }
  void NumberOr(const ParamInfo& info, const Range&, std::string_view none,
                std::optional<double>& value) override {
    if (const Value* v = Find(info)) value = v->text == none ? std::nullopt : std::optional(v->number);
  }
  void Integer(const ParamInfo& info, std::int64_t, std::int64_t, std::int64_t& value) override {
    if (const Value* v = Find(info)) value = static_cast<std::int64_t>(v->number);
  }
  void Flag(const ParamInfo& info, bool& value) override {
    if (const Value* v = Find(info)) value = v->number != 0;
  }
  void Text(const ParamInfo& info, std::string& value) override {
    if (const Value* v = Find(info)) value = v->text;
  }
  void Choice(const ParamInfo& info, std::span<const std::string_view>, std::string& value) override {
    if (const Value* v = Find(info)) value = v->text;
  }
  void Array(const ParamInfo&, const Range&, std::span<double>) override {}
  void Table(const ParamInfo&, const Range&, std::size_t, std::vector<double>&) override {}
  void Group(const ParamInfo& info, const std::function<void(ParamVisitor&)>& visit) override {
    const std::string before = prefix_;
    prefix_ += std::string(info.name) + ".";
    visit(*this);
    prefix_ = before;
  }
  void List(const ParamInfo&, ParamList&) override {}
  void Map(const ParamInfo&, ParamMap&) override {}

 private:
  const Value* Find(const ParamInfo& info) const {
    for (const Value& v : values_) {
      if (v.key == prefix_ + std::string(info.name)) return &v;
    }
    return nullptr;
  }
  std::vector<Value> values_;
  std::string prefix_;
};

template <class Kind>
auto MakeOfKind(const std::vector<Kind>& kinds, std::string_view name, const EstimatorStart& start,
                std::vector<Settings::Value> values) {
  for (const Kind& kind : kinds) {
    if (kind.name != name) continue;
    const auto params = kind.make_params();
    Settings settings(std::move(values));
    params->Visit(settings);
    return kind.make(*params, start);
  }
  return decltype(kinds.front().make(std::declval<const Params&>(), start)){};
}

inline std::unique_ptr<Estimator> MakeFilter(const EstimatorStart& start,
                                             std::vector<Settings::Value> values = {}) {
  return MakeOfKind(FilterKinds(), "quaternion_ekf", start, std::move(values));
}

inline std::unique_ptr<LeakLocator> MakeLocator(std::string_view name, const EstimatorStart& start,
                                                std::vector<Settings::Value> values = {}) {
  return MakeOfKind(LocatorKinds(), name, start, std::move(values));
}

/// Feeds a filter IMU samples and a magnetometer at 50 Hz (sd 0.3 uT; none: sd < 0); `each` after every
/// sample.
template <class Each>
void Feed(Estimator& filter, const BallRecord& record, const std::vector<ImuSample>& samples, double mag_sd_T,
          std::uint64_t seed, Each&& each) {
  const auto every = static_cast<std::size_t>(record.rate_Hz / 50);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    filter.Ingest({0, samples[k]});
    if (mag_sd_T >= 0 && k % every == 0) {
      filter.Ingest({1, Magnetometer(record.truth[k + 1], samples[k].stamp, mag_sd_T, seed, k)});
    }
    each(filter.nav(), record.truth[k + 1]);
  }
}

}  // namespace piperun::estimator::testing
