#include <benchmark/benchmark.h>

#include <cmath>

#include "acoustics/hydrophone.h"

namespace piperun::acoustics {
namespace {

/// 100 m of PVC-U DN150 with three leaks.
AcousticScene MakeScene(const WaterProperties& water) {
  const WallMaterial pvc{.name = "pvc_u",
                         .young_modulus_Pa = 3.5e9,
                         .loss_factor = 0.05,
                         .poisson_ratio = 0.38,
                         .density_kg_m3 = 1420,
                         .roughness_m = 1.5e-6};
  AcousticScene scene;
  scene.water = water;
  scene.legs = {{0, 100, CalcPipeWave(0.1475, 0.0075, pvc, water)}};
  const LeakSoundKind& kind = LeakSoundKinds().front();
  for (const double chainage_m : {5.0, 8.0, 12.0}) {
    scene.leaks.push_back({"L", chainage_m,
                           kind.make(*kind.make_params(), 2e-3,
                                     {.flow_m3_s = 4.6e-5, .pressure_drop_Pa = 3e5}, water.density_kg_m3)});
  }
  return scene;
}

/// One second of audio at 16 kHz among three leaks, in blocks of 0.1 s, with a slip speed that never rests.
void RenderSecond(benchmark::State& state) {
  const WaterProperties water = CalcWater(10);
  Hydrophone hydrophone({}, MakeScene(water), RandomStream(1, "hydrophone0", 0));
  const auto listener = [](TrueTime t) {
    const double s = 0.4 * Seconds(t);
    return ListenerState{s - 16 * std::floor(s / 16), 0.4, 0.02 + 0.01 * std::sin(7 * s), 0.07375};
  };
  std::vector<std::int32_t> block(1600);
  for (auto _ : state) {
    for (int i = 0; i < 10; ++i) hydrophone.Render(listener, block);
    benchmark::DoNotOptimize(block.data());
  }
  state.counters["x_real_time"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(RenderSecond)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace piperun::acoustics
