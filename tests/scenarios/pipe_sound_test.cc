#include "scenarios/pipe_sound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.h"
#include "scenarios/acoustic_scene.h"
#include "scenarios/assemble.h"
#include "scenarios/estimator_input.h"
#include "scenarios/sound_range.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

acoustics::PipeWave WaveOf(const std::vector<std::string>& overrides) {
  const Scenario scenario = MakeSmallScenario(overrides);
  const WaterProperties water = CalcWater(scenario.water.temperature_C);
  return MakeAcousticNetwork(BuildPipeline(scenario, water), water, scenario.gravity_m_s2).pipes[0].wave;
}

/// Korteweg's speed in a wall of 7.5 mm around 150 mm at 10 C, of so many N/m of E h, with so thick a lining.
double CalcKorteweg(double E_h_N_m, double lining_m = 0) {
  const WaterProperties water = CalcWater(10);
  const double a = 0.5 * (0.150 + 0.0075 + lining_m);
  return 1 / std::sqrt(1 / std::pow(water.sound_speed_m_s, 2) + 2 * water.density_kg_m3 * a / E_h_N_m);
}

TEST(PipeSound, WithoutAWordIsTheBareWallInAir) {
  const acoustics::PipeWave wave = WaveOf({});
  EXPECT_EQ(wave.law, acoustics::WaveLaw::kAuto);
  EXPECT_NEAR(wave.speed_m_s, CalcKorteweg(3.5e9 * 0.0075), 1e-6);
}

TEST(PipeSound, AWordOfThePipeCountsBeforeTheNetworks) {
  const double bare = WaveOf({}).speed_m_s;
  const double clay = WaveOf({"network.soil=stiff_clay"}).speed_m_s;
  EXPECT_GT(clay, 1.3 * bare);
  EXPECT_EQ(WaveOf({"network.pipes[0].soil=stiff_clay"}).speed_m_s, clay);
  EXPECT_EQ(WaveOf({"network.soil=stiff_clay", "network.pipes[0].soil=none"}).speed_m_s, bare);
  EXPECT_LT(WaveOf({"network.soil=stiff_clay", "network.pipes[0].soil=sand"}).speed_m_s, 1.1 * bare);
}

TEST(PipeSound, PvcInSoftClayHasTheSpeedMeasuredInTheField) {
  // 484 m/s, Gao et al. 2004
  EXPECT_NEAR(WaveOf({"network.soil=soft_clay"}).Speed_m_s(100) / 484, 1, 0.05);
}

TEST(PipeSound, ALiningStiffensTheHoop) {
  // cement mortar of 25 GPa, 4 mm: E h grows from 26.25 to 126.25 MN/m
  const double lined = CalcKorteweg(3.5e9 * 0.0075 + 25e9 * 0.004, 0.004);
  EXPECT_NEAR(WaveOf({"network.lining=cement_mortar"}).speed_m_s, lined, 1e-6);
  const double thin = CalcKorteweg(3.5e9 * 0.0075 + 3e9 * 0.001, 0.001);
  EXPECT_NEAR(WaveOf({"network.pipes[0].lining=epoxy", "network.pipes[0].lining_m=0.001"}).speed_m_s, thin,
              1e-6);
}

TEST(PipeSound, TheLawIsChosenByName) {
  EXPECT_EQ(WaveOf({"network.wave_law=compact"}).law, acoustics::WaveLaw::kCompact);
  EXPECT_EQ(WaveOf({"network.pipes[0].wave_law=wall_inertia"}).law, acoustics::WaveLaw::kWallInertia);
}

std::string RefusalOf(const std::vector<std::string>& overrides) {
  try {
    WaveOf(overrides);
  } catch (const InputError& e) {
    return e.key_path() + ": " + e.problem();
  }
  return "";
}

TEST(PipeSound, WhatItRefusesItNames) {
  EXPECT_NE(RefusalOf({"network.soil=mud"}).find("network.soil"), std::string::npos);
  EXPECT_NE(RefusalOf({"network.lining_m=0"}).find("network.lining_m"), std::string::npos);
  const std::string compact = RefusalOf({"network.soil=sand", "network.wave_law=compact"});
  EXPECT_EQ(compact.find("network.pipes[0].wave_law: pipe 'P1'"), 0u) << compact;
}

TEST(PipeSound, TheCrewsMapSaysNothingOfTheSoil) {
  const auto assembly = Assemble(MakeSmallScenario({"network.soil=sand"}));
  EXPECT_EQ(assembly->pipeline->drawing.pipes[0].sound.soil, "sand");
  const EstimatorInput input = MakeEstimatorInput(MakeSmallScenario({"network.soil=sand"}), *assembly);
  EXPECT_EQ(input.map.network.pipes[0].sound, PipeSoundParams());
}

TEST(SoundRange, IsWarnedOfOnceWithTheNumbers) {
  const auto warnings = Assemble(MakeSmallScenario())->pipeline->warnings;
  const auto says = [&](const std::string& what) {
    return std::count_if(warnings.begin(), warnings.end(),
                         [&](const std::string& w) { return w.find(what) != std::string::npos; });
  };
  // f_ring = sqrt(3.5e9/(1400 (1 - 0.16)))/(2 pi 0.07875) = 3486.6 Hz; 0.15 of it 523 Hz;
  // cut-on 1.8412 x 1447.3/(2 pi 0.075) = 5655 Hz
  EXPECT_EQ(
      says("sound: the record goes to 8000 Hz, the law of the wall to 0.15 of the ring frequency: 523 Hz "
           "in P1;"),
      1);
  EXPECT_EQ(says("to the first cut-on: 565"), 1);
  const auto count = [](double top_Hz) {
    const auto assembly = Assemble(MakeSmallScenario());
    return WarnOfSoundRange(*assembly->network(), assembly->scene, top_Hz).size();
  };
  EXPECT_EQ(count(520), 0u);
  EXPECT_EQ(count(530), 1u);
  EXPECT_EQ(count(5700), 2u);
}

TEST(SoundRange, NamesThePipesOfTheLowestLimitAndCountsTheOthers) {
  Scenario scenario = MakeSmallScenario({"network.pipes.P1.diameter_mm=300"});
  const auto small = Assemble(MakeSmallScenario()), large = Assemble(scenario);
  acoustics::AcousticScene both = small->scene;
  both.network.pipes.push_back(large->scene.network.pipes[0]);
  both.listening_pipes = {0, 0, 0, 0, 0, 1};
  PipeSpec first, second;
  first.id = "P1", first.from = "A", first.to = "B", first.diameter_m = 0.15, first.wall_thickness_m = 0.0075;
  second.id = "P2", second.from = "B", second.to = "C", second.diameter_m = 0.3,
  second.wall_thickness_m = 0.0075;
  const Network network({{"A", {0, 0, 0}}, {"B", {6, 0, 0}}, {"C", {12, 0, 0}}}, {first, second});
  const auto warnings = WarnOfSoundRange(network, both, 8000);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[1].find(" in P2, higher in 5 others"), std::string::npos) << warnings[1];
  both.listening_pipes = {0, 0, 0, 0, 0};
  EXPECT_NE(WarnOfSoundRange(network, both, 8000)[1].find(" in P1, P1, P1 and 2 more;"), std::string::npos);
}

}  // namespace
}  // namespace piperun::scenarios
