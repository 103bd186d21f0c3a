#include <benchmark/benchmark.h>

#include <vector>

#include "sim/flow_field.h"
#include "tests/support/star.h"

namespace piperun::sim {
namespace {

/// A tee of 0.15 m in which 18 L/s divide.
struct Tee {
  Tee()
      : network(testing::MakeStar(
            {{-Vector3d::UnitX(), 0.15, 50}, {Vector3d::UnitX(), 0.15, 50}, {Vector3d::UnitY(), 0.15, 50}})),
        bore(network),
        timeline(std::vector<double>(3, network.pipe(0).area_m2()), {TrueTime{}},
                 {FlowState{{{{0, 50, -0.018, 50, 49, 0.02}},
                             {{0, 50, 0.011, 50, 49, 0.02}},
                             {{0, 50, 0.007, 50, 49, 0.02}}}}}),
        field(bore, timeline, CalcWater(15), 9.80665, 0.03) {}

  Network network;
  Bore bore;
  FlowTimeline timeline;
  FlowField field;
};

/// One evaluation at a distance from the node.
void FlowEval(benchmark::State& state, double x_m) {
  const Tee tee;
  const Vector3d p(-x_m, 0.01, -0.03);
  const NetworkSpot spot = testing::SpotIn(tee.network, 0, p);
  for (auto _ : state) benchmark::DoNotOptimize(tee.field.Eval(spot, p, {}));
}

BENCHMARK_CAPTURE(FlowEval, pipe, 20);
BENCHMARK_CAPTURE(FlowEval, profile, 0.4);
BENCHMARK_CAPTURE(FlowEval, fade, 0.2);
BENCHMARK_CAPTURE(FlowEval, core, 0.05);

/// The potential of the joint, found once.
void JunctionSetUp(benchmark::State& state) {
  for (auto _ : state) {
    const Tee tee;
    benchmark::DoNotOptimize(tee.field.FindJunction(0));
  }
}
BENCHMARK(JunctionSetUp)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace piperun::sim
