#include <benchmark/benchmark.h>

#include "sim/hydraulics.h"
#include "sim/motion.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

/// One step of a ball in 0.8 m/s of water with all its loads, in a straight pipe and in one bend after
/// another.
void WorldStep(benchmark::State& state, const std::vector<Vector3d>& points) {
  const testing::PipeLine line = testing::MakePipeLine(points, {.roughness_m = 1e-5});
  const double flow_m3_s = 0.8 * line.network.pipe(0).area_m2();
  const WaterProperties water = CalcWater(15);
  const SteadyFlow flow = SolveSteadyFlow(line.network, line.route, {flow_m3_s, 1e7}, {}, water, 9.80665);
  const Bore bore(line.network);
  MotionContext context;
  context.water = water;
  context.network = &line.network;
  context.route = &line.route;
  context.bore = &bore;
  context.flow = &flow.timeline;
  context.launch = {0, false};
  context.retrieve_node = 1;
  for (const MotionKind& kind : MotionKinds()) {
    if (kind.name != "ball_in_pipe") continue;
    const auto motion = kind.make(*kind.make_params(), context);
    for (auto _ : state) motion->Step();
    benchmark::DoNotOptimize(motion->state().X_WB.p.x());
  }
  state.SetItemsProcessed(state.iterations());
}

std::vector<Vector3d> ZigZag() {
  std::vector<Vector3d> points{Vector3d::Zero()};
  for (int i = 0; i < 2000; ++i)
    points.push_back(points.back() + (i % 2 ? Vector3d(0, 1, 0) : Vector3d(1, 0, 0)));
  return points;
}

BENCHMARK_CAPTURE(WorldStep, straight, std::vector<Vector3d>{{0, 0, 0}, {100000, 0, 0}});
BENCHMARK_CAPTURE(WorldStep, bends, ZigZag());

}  // namespace
}  // namespace piperun::sim
