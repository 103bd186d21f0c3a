#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "acoustics/audio_file.h"
#include "acoustics/hydrophone.h"
#include "acoustics/network_field.h"

namespace piperun::acoustics {
namespace {

const WaterProperties kWater = CalcWater(10);

const WallMaterial kPvc{.name = "pvc_u",
                        .young_modulus_Pa = 3.5e9,
                        .loss_factor = 0.05,
                        .poisson_ratio = 0.38,
                        .density_kg_m3 = 1420,
                        .roughness_m = 1.5e-6};
const WallMaterial kIron{.name = "ductile_iron",
                         .young_modulus_Pa = 165e9,
                         .loss_factor = 0.02,
                         .poisson_ratio = 0.28,
                         .density_kg_m3 = 7100,
                         .roughness_m = 1e-4};

const LeakSoundKind& FindJet() {
  return *std::ranges::find(LeakSoundKinds(), "turbulent_jet", &LeakSoundKind::name);
}

void AddLeak(AcousticScene& scene, int pipe, double s_m) {
  const LeakSoundKind& kind = FindJet();
  scene.leaks.push_back({"L", pipe, s_m,
                         kind.make(*kind.make_params(), 2e-3, {.flow_m3_s = 4.6e-5, .pressure_drop_Pa = 3e5},
                                   kWater.density_kg_m3)});
}

/// 100 m of PVC-U DN150 with three leaks.
AcousticScene MakeMain() {
  AcousticScene scene;
  scene.water = kWater;
  scene.network = {{{0, 1, 100, CalcPipeWave(0.1475, 0.0075, kPvc, kWater)}},
                   {NodeEnd::kGoesOn, NodeEnd::kGoesOn},
                   {},
                   {}};
  for (const double s_m : {5.0, 8.0, 12.0}) AddLeak(scene, 0, s_m);
  return scene;
}

/// A town of 1,200 iron pipes of 16 m on a grid of 25 x 25 streets, in ten bores, with twenty leaks: sound
/// crosses it all.
AcousticScene MakeTown() {
  constexpr int kStreets = 25;
  AcousticScene scene;
  scene.water = kWater;
  const auto add_pipe = [&scene](int from, int to) {
    const double bore_m = 0.08 + 0.02 * static_cast<double>(scene.network.pipes.size() * 7 % 10);
    scene.network.pipes.push_back({from, to, 16, CalcPipeWave(bore_m, 0.006, kIron, kWater)});
  };
  for (int row = 0; row < kStreets; ++row) {
    for (int column = 0; column < kStreets; ++column) {
      const int node = row * kStreets + column;
      if (column + 1 < kStreets) add_pipe(node, node + 1);
      if (row + 1 < kStreets) add_pipe(node, node + kStreets);
    }
  }
  for (int i = 0; i < 20; ++i) AddLeak(scene, 60 * i, 5);
  for (int i = 0; i < 20; ++i) scene.listening_pipes.push_back(2 * i);
  return scene;
}

/// Through pipes 0, 2, 4 .. of 16 m at 0.4 m/s, again and again, with a slip speed that never rests.
class Walk {
 public:
  explicit Walk(int pipes) : pipes_(pipes) {}
  ListenerState operator()(TrueTime t) const {
    const double way_m = 0.4 * Seconds(t);
    const int count = static_cast<int>(way_m / 16);
    return {2 * (count % pipes_), way_m - 16 * count, 0.4, 0.02 + 0.01 * std::sin(7 * way_m), 0.07375};
  }

 private:
  int pipes_;
};

/// One second of audio at 16 kHz in blocks of 0.1 s.
void RenderSecond(benchmark::State& state, const AcousticScene& scene, const Walk& walk) {
  Hydrophone hydrophone({}, scene, RandomStream(1, "hydrophone0", 0));
  const Hydrophone::ListenerAt listener = walk;
  std::vector<std::int32_t> block(1600);
  for (auto _ : state) {
    for (int i = 0; i < 10; ++i) hydrophone.Render(listener, block);
    benchmark::DoNotOptimize(block.data());
  }
  state.counters["x_real_time"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}

void RenderSecondInMain(benchmark::State& state) { RenderSecond(state, MakeMain(), Walk(1)); }
BENCHMARK(RenderSecondInMain)->Unit(benchmark::kMillisecond);

void RenderSecondInTown(benchmark::State& state) { RenderSecond(state, MakeTown(), Walk(20)); }
BENCHMARK(RenderSecondInTown)->Unit(benchmark::kMillisecond);

/// 60 s of the main (three leaks; distant noise, eddies, self noise and converter) into a WAV of 16 bits;
/// with stems, those into files of their own beside it.
void RenderMinuteIntoFiles(benchmark::State& state) {
  const bool stems = state.range(0) != 0;
  HydrophoneParams params;
  params.bits = 16;
  params.stems = stems;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "piperun_bench_acoustics";
  std::filesystem::create_directories(folder);
  const Hydrophone::ListenerAt listener = Walk(1);
  std::vector<std::int32_t> block(1600);
  for (auto _ : state) {
    state.PauseTiming();
    Hydrophone hydrophone(params, MakeMain(), RandomStream(1, "hydrophone0", 0));
    state.ResumeTiming();
    AudioWriter mix(folder / "audio.wav", {AudioContainer::kWav, 16000, 16});
    std::vector<AudioWriter> files;
    for (const std::string& name : hydrophone.StemNames())
      files.emplace_back(folder / (name + ".wav"), AudioFormat{AudioContainer::kFloatWav, 16000, 24});
    for (int i = 0; i < 600; ++i) {
      hydrophone.Render(listener, block);
      mix.Write(block);
      for (std::size_t stem = 0; stem < files.size(); ++stem) files[stem].Write(hydrophone.stem_Pa(stem));
    }
    mix.Close();
    for (AudioWriter& file : files) file.Close();
  }
  state.counters["x_real_time"] = benchmark::Counter(60, benchmark::Counter::kIsIterationInvariantRate);
  std::filesystem::remove_all(folder);
}
BENCHMARK(RenderMinuteIntoFiles)->ArgName("stems")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// Waves of all pipes, sounds and ways of all leaks, tables: what a run pays before it starts.
void AssembleTown(benchmark::State& state) {
  for (auto _ : state) {
    Hydrophone hydrophone({}, MakeTown(), RandomStream(1, "hydrophone0", 0));
    benchmark::DoNotOptimize(hydrophone.rate());
  }
}
BENCHMARK(AssembleTown)->Unit(benchmark::kMillisecond);

/// 100 nodes on a ring with chords of iron, all sides different: 512 frequencies, three sources.
void SolveField(benchmark::State& state) {
  AcousticNetwork network;
  const PipeWave wave = CalcPipeWave(0.158, 0.006, kIron, kWater);
  for (int i = 0; i < 100; ++i) {
    network.pipes.push_back({i, (i + 1) % 100, 20 + 0.37 * i, wave});
    if (i % 5 == 0) network.pipes.push_back({i, (i + 13) % 100, 50 + 0.11 * i, wave});
  }
  std::vector<double> frequencies_Hz;
  for (int k = 1; k <= 512; ++k) frequencies_Hz.push_back(15.625 * k);
  const auto whole = static_cast<double>(state.range(0));  // of the band, so that nothing is left out below 1
  for (double& f_Hz : frequencies_Hz) f_Hz *= whole / 1000;
  for (auto _ : state) {
    const NetworkField field(network, {{0, 3}, {40, 7}, {77, 5}}, frequencies_Hz);
    benchmark::DoNotOptimize(field.Impedance_Pa_s_m3(511, 2, {30, 1}));
  }
}
BENCHMARK(SolveField)->Arg(1000)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace piperun::acoustics
