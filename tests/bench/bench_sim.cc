#include <benchmark/benchmark.h>

#include "sim/fluid_load.h"
#include "sim/hydraulics.h"
#include "sim/motion.h"
#include "sim/stream_fluctuations.h"
#include "tests/support/pipes.h"
#include "tests/support/set_params.h"

namespace piperun::sim {
namespace {

/// One step of a ball in 0.8 m/s of water with all its loads, in a straight pipe and in one bend after
/// another; with turbulence it is everything that the physics has.
void WorldStep(benchmark::State& state, const std::vector<Vector3d>& points, bool turbulence) {
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
    const std::unique_ptr<Params> params = kind.make_params();
    testing::ParamWriter writer({{"stream.turbulence.on", turbulence}});
    params->Visit(writer);
    const auto motion = kind.make(*params, context);
    for (auto _ : state) motion->Step();
    benchmark::DoNotOptimize(motion->state().X_WB.p.x());
  }
  state.SetItemsProcessed(state.iterations());
}

/// All loads on a ball that rolls along with the water; the slip changes, so that nothing is foreseen.
void LoadEval(benchmark::State& state, const ForceParams& forces) {
  const std::vector<double> bores{0.075};
  const FluidLoadCoefficients c =
      CalcFluidLoadCoefficients({}, forces, CalcWater(15), {0, 0, -9.80665}, bores);
  WaterAtBall water;
  water.bore_radius_m = bores[0];
  water.from_wall_W = Vector3d::UnitZ();
  water.spin_W = {0, 3, 0};
  double slip_m_s = 0;
  for (auto _ : state) {
    slip_m_s = slip_m_s < 0.5 ? slip_m_s + 1e-3 : 1e-3;
    water.velocity_W = {0.8 + slip_m_s, 0, 0};
    benchmark::DoNotOptimize(CalcFluidLoad(c, {0.8, 0, 0}, {0, 27, 0}, water));
  }
}

BENCHMARK_CAPTURE(LoadEval, all, ForceParams{});
BENCHMARK_CAPTURE(LoadEval, clift_grace_weber, ForceParams{.drag = "clift_grace_weber"});
BENCHMARK_CAPTURE(LoadEval, barati_high, ForceParams{.drag = "barati_high"});
BENCHMARK_CAPTURE(LoadEval, free_drag_only,
                  ForceParams{.wall_factor = "none", .rolling_drag = false, .lift = false, .magnus = false});

std::vector<Vector3d> ZigZag() {
  std::vector<Vector3d> points{Vector3d::Zero()};
  for (int i = 0; i < 2000; ++i)
    points.push_back(points.back() + (i % 2 ? Vector3d(0, 1, 0) : Vector3d(1, 0, 0)));
  return points;
}

/// One step of turbulence around the reference ball, noise included; with swirl switching.
void FluctuationStep(benchmark::State& state, bool switching) {
  StreamParams params;
  params.turbulence.on = true;
  params.swirl_switching = switching;
  StreamFluctuations fluctuations(params, 1, 0, Rate(1000), 0.06, 1, 1e-6);
  WaterAtBall mean;
  mean.velocity_W = {1, 0, 0};
  mean.bulk_speed_m_s = 1;
  mean.bore_radius_m = 0.075;
  mean.friction_velocity_m_s = 0.05;
  NetworkSpot spot;
  spot.axis = {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::Zero()};
  for (auto _ : state) {
    fluctuations.Step();
    WaterAtBall water = mean;
    fluctuations.AddTo(spot, {0, 0.01, -0.03}, water);
    benchmark::DoNotOptimize(water);
  }
}

BENCHMARK_CAPTURE(FluctuationStep, turbulence, false);
BENCHMARK_CAPTURE(FluctuationStep, and_swirl, true);

void SixNormals(benchmark::State& state) {
  const RandomStream noise(1, "turbulence", 0);
  std::uint64_t sample = 0;
  for (auto _ : state) benchmark::DoNotOptimize(noise.SixNormals(++sample, 0));
}
BENCHMARK(SixNormals);

const std::vector<Vector3d> kStraight{{0, 0, 0}, {100000, 0, 0}};
BENCHMARK_CAPTURE(WorldStep, straight, kStraight, false);
BENCHMARK_CAPTURE(WorldStep, bends, ZigZag(), false);
BENCHMARK_CAPTURE(WorldStep, straight_turbulent, kStraight, true);
BENCHMARK_CAPTURE(WorldStep, bends_turbulent, ZigZag(), true);

}  // namespace
}  // namespace piperun::sim
