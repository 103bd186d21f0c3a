#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "acoustics/flow_noise.h"
#include "acoustics/level.h"
#include "acoustics/listener_spectrum.h"
#include "tests/acoustics/scenes.h"
#include "tests/acoustics/statistics.h"

namespace piperun::acoustics {
namespace {

TEST(DistantNoise, HasItsLevelAtHundredHertzAndItsSlope) {
  const AmbientParams ambient;
  const auto level_dB = [&](double f_Hz) { return CalcLevel_dB(CalcDistantNoisePsd(ambient, f_Hz)); };
  EXPECT_NEAR(level_dB(100), 80, 1e-9);
  EXPECT_NEAR(level_dB(1000), 55, 1e-9);
  EXPECT_NEAR(level_dB(300), 68, 0.5);  // printed to a decibel
  EXPECT_NEAR(level_dB(3000), 43, 0.5);
}

TEST(WallPressure, FollowsTheTableOfADn150Main) {
  // dB re 1 uPa^2/Hz at 10, 100, 300, 1000 Hz, 20 C, printed to a decibel, with another smooth friction law
  // (within 3 % in wall shear, which the steep end of the spectrum turns into 0.7 dB)
  struct Row {
    double speed_m_s;
    double level_dB[4];
  };
  for (const Row& row :
       {Row{.3, {104, 72, 49, 22}}, Row{.5, {111, 95, 72, 46}}, Row{1, {120, 114, 104, 78}}}) {
    const WallFlow flow = CalcWallFlow(row.speed_m_s, 0.075, CalcWater(20));
    for (int i = 0; i < 4; ++i) {
      const double f_Hz = (const double[]){10, 100, 300, 1000}[i];
      EXPECT_NEAR(CalcLevel_dB(CalcWallPressurePsd(flow, f_Hz)), row.level_dB[i], 0.5 + 0.7)
          << row.speed_m_s << " m/s, " << f_Hz << " Hz";
    }
  }
}

TEST(WallPressure, RmsIsThreeToFiveTimesTheWallShear) {
  struct Row {
    double speed_m_s, rms_Pa;
  };
  for (const Row& row : {Row{.3, .8}, Row{.5, 2.2}, Row{1, 8.5}, Row{2, 33}}) {
    const WallFlow flow = CalcWallFlow(row.speed_m_s, 0.0775, CalcWater(10));
    const auto psd = [&](double f_Hz) { return CalcWallPressurePsd(flow, f_Hz); };
    const double rms_Pa = std::sqrt(IntegrateLog(psd, 1e-3, 1e6));
    EXPECT_NEAR(rms_Pa / row.rms_Pa, 1, 0.06);
    EXPECT_GT(rms_Pa, 3 * flow.wall_shear_Pa);
    EXPECT_LT(rms_Pa, 6 * flow.wall_shear_Pa);
  }
}

TEST(WallPressure, EqualsGoodysFormula) {
  const WaterProperties water = CalcWater(12);
  const double U = 0.7, a = 0.06, f = 80;
  const double Re = U * 2 * a / water.kinematic_viscosity_m2_s;
  const double tau = 0.3164 * std::pow(Re, -0.25) * water.density_kg_m3 * U * U / 8;
  const double RT = (a / (1.2 * U)) / (water.kinematic_viscosity_m2_s / (tau / water.density_kg_m3));
  const double x = 2 * std::numbers::pi * f * a / (1.2 * U);
  const double shape =
      3 * x * x / (std::pow(std::pow(x, 0.75) + 0.5, 3.7) + std::pow(1.1 * std::pow(RT, -0.57) * x, 7));
  const double psd = 2 * std::numbers::pi * shape * tau * tau * a / (1.2 * U);
  EXPECT_NEAR(CalcWallPressurePsd(CalcWallFlow(U, a, water), f) / psd, 1, 1e-12);
}

TEST(WallPressure, AFaceAsLargeAsTheEddiesHearsAQuarterOfTheirPower) {
  const WallFlow flow = CalcWallFlow(0.5, 0.075, CalcWater(10));
  const double f_Hz = 0.7 * 1.2 * 0.5 / (2 * std::numbers::pi * 0.005);  // omega r = Uc
  EXPECT_NEAR(CalcFaceAveraging(flow, 0.005, f_Hz), 0.25, 1e-12);
  EXPECT_EQ(CalcFaceAveraging(flow, 0, 1e4), 1);
}

TEST(WallPressure, IsNegligibleAbove500HertzForADriftingBallAndLoudForAHeldOne) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient.flow_noise = true;
  const ListenerState drifting{0, 10, 0.5, 0.02, kPvcBore_m / 2};
  for (const double f_Hz : {500.0, 1000.0, 4000.0}) {
    EXPECT_LT(CalcBackgroundPsd(scene, drifting, 0.005, f_Hz), 0.01 * CalcSelfNoisePsd({}, f_Hz));
  }
  // held against 1 m/s it hears 114 dB at 100 Hz less 13 dB of averaging, the distant noise has 80 dB
  const ListenerState held{0, 10, 1, 1, kPvcBore_m / 2};
  EXPECT_GT(CalcBackgroundPsd(scene, held, 0.005, 100), 100 * CalcDistantNoisePsd(AmbientParams{}, 100));
}

TEST(SelfNoise, IsFlatAboveHundredHertzAndOneOverFBelow) {
  const HydrophoneParams params;
  EXPECT_NEAR(CalcLevel_dB(CalcSelfNoisePsd(params, 1000)), 42, 1e-9);
  EXPECT_NEAR(CalcLevel_dB(CalcSelfNoisePsd(params, 100)), 42, 1e-9);
  EXPECT_NEAR(CalcLevel_dB(CalcSelfNoisePsd(params, 10)), 52, 1e-9);
}

TEST(ConverterNoise, Of16BitsAtOneKilopascalIs40Decibels) {
  HydrophoneParams params;
  params.bits = 16;
  EXPECT_NEAR(CalcLevel_dB(CalcConverterNoisePsd(params)), 39.9, 0.05);
}

/// Mean over a bin, at the four frequencies that stand for it.
double CalcLeakPsdInBin(const AcousticScene& scene, std::size_t leak, const PipePlace& place,
                        std::size_t bin) {
  double sum = 0;
  for (std::size_t j = 0; j < StretchField::kParts; ++j) {
    const double f_Hz = 15.625 * (static_cast<double>(bin) + StretchField::OffsetInBin(bin, j));
    sum += CalcLeakPsdAt(scene, leak, place, f_Hz) / StretchField::kParts;
  }
  return sum;
}

class ListenerSpectrumAt : public testing::TestWithParam<ListenerState> {};

TEST_P(ListenerSpectrumAt, TabulatesThePureFunctions) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.network =
      MakeNetwork({{0, 1, 10, MakePvcWave()}, {1, 2, 20, MakeIronWave()}, {2, 3, 20, MakePvcWave()}});
  scene.ambient = {};
  AddLeak(scene, 8, MakeJet(1e-5, 1e-3));
  AddLeak(scene, {1, 3}, MakeJet(5e-5, 3e-3));
  const HydrophoneParams params;
  const double width_Hz = 15.625;
  ListenerSpectrum spectrum(scene, params, width_Hz, 513);
  std::vector<float> psd(513);
  spectrum.Calc(GetParam(), psd);
  EXPECT_EQ(psd[0], 0);
  for (std::size_t k = 1; k < psd.size(); ++k) {
    const double f_Hz = static_cast<double>(k) * width_Hz;
    double sound = CalcBackgroundPsd(scene, GetParam(), params.face_radius_m, f_Hz);
    for (const std::size_t leak : {0u, 1u}) sound += CalcLeakPsdInBin(scene, leak, GetParam().place(), k);
    const double expected = sound * f_Hz * f_Hz / (f_Hz * f_Hz + 100) + CalcSelfNoisePsd(params, f_Hz);
    // along a stretch a bin has one attenuation, whichever of its frequencies the waves at the ends prefer
    EXPECT_NEAR(10 * std::log10(psd[k] / expected), 0, 0.1) << f_Hz << " Hz";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Listeners, ListenerSpectrumAt,
    testing::Values(ListenerState{0, 7.9, 0.5, 0.03, 0.075}, ListenerState{0, 8, 0, 0, 0.075},
                    ListenerState{1, 2.5, 1.7, 1.7, 0.06}, ListenerState{2, 1, 0.3, 0.001, 0.075},
                    ListenerState{0, -2, 0.3, 0.31, 0.075}, ListenerState{-1, 0, 0.3, 0.31, 0}));

/// A tee: mains of PVC and iron, a branch of thinner PVC with its own leak, and a detached pipe.
AcousticScene MakeTeeScene() {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  const PipeWave branch = CalcPipeWave(0.1, 0.005, MakeWall(3.5e9, 0.05), MakeWater10C());
  scene.network = MakeNetwork(
      {{0, 1, 10, MakePvcWave()}, {1, 2, 20, MakeIronWave()}, {3, 1, 15, branch}, {4, 5, 30, MakePvcWave()}});
  scene.ambient = {};
  AddLeak(scene, {0, 8}, MakeJet(1e-5, 1e-3));
  AddLeak(scene, {2, 12}, MakeJet(2e-5, 1e-3));
  return scene;
}

std::vector<float> CalcSpectrumAt(ListenerSpectrum& spectrum, const PipePlace& place) {
  std::vector<float> psd(513);
  spectrum.Calc({place.pipe, place.s_m, 0.4, 0.05, 0.075}, psd);
  return psd;
}

TEST(ListenerSpectrum, AroundATeeIsThatOfThePureFunctions) {
  const AcousticScene scene = MakeTeeScene();
  ListenerSpectrum spectrum(scene, {}, 15.625, 513);
  for (const PipePlace& place : {PipePlace{0, 9.5}, {1, 0.5}, {2, 14.5}, {2, 3}, {1, 19}, {0, 1}}) {
    const auto psd = CalcSpectrumAt(spectrum, place);
    for (std::size_t k = 1; k < psd.size(); ++k) {
      const double f_Hz = 15.625 * static_cast<double>(k);
      const ListenerState listener{place.pipe, place.s_m, 0.4, 0.05, 0.075};
      const double sound = CalcLeakPsdInBin(scene, 0, place, k) + CalcLeakPsdInBin(scene, 1, place, k) +
                           CalcBackgroundPsd(scene, listener, 0.005, f_Hz);
      const double expected = sound * f_Hz * f_Hz / (f_Hz * f_Hz + 100) + CalcSelfNoisePsd({}, f_Hz);
      EXPECT_NEAR(10 * std::log10(psd[k] / expected), 0, 0.05) << place.pipe << ", " << f_Hz << " Hz";
    }
  }
}

TEST(ListenerSpectrum, DoesNotRememberThePipesItCameThrough) {
  const AcousticScene scene = MakeTeeScene();
  ListenerSpectrum used(scene, {}, 15.625, 513);
  for (const PipePlace& place : {PipePlace{0, 9}, {2, 14}, {-1, 0}, {3, 10}, {1, 2}, {2, 14}, {0, 9}}) {
    ListenerSpectrum fresh(scene, {}, 15.625, 513);
    EXPECT_EQ(CalcSpectrumAt(used, place), CalcSpectrumAt(fresh, place)) << place.pipe;
  }
}

TEST(ListenerSpectrum, IsTheSameFromAllPipesOfANode) {
  ListenerSpectrum spectrum(MakeTeeScene(), {}, 15.625, 513);
  const auto main = CalcSpectrumAt(spectrum, {0, 10});
  const auto onward = CalcSpectrumAt(spectrum, {1, 0}), branch = CalcSpectrumAt(spectrum, {2, 15});
  for (std::size_t k = 1; k < main.size(); ++k) {
    // the loss from an end of a pipe on is that of the bin's middle
    EXPECT_NEAR(onward[k] / main[k], 1, 2e-3) << k;
    EXPECT_NEAR(branch[k] / main[k], 1, 2e-3) << k;
  }
}

TEST(ListenerSpectrum, InNoPipeAndInADetachedOneHoldsNoLeak) {
  AcousticScene without = MakeTeeScene();
  without.leaks.clear();
  ListenerSpectrum spectrum(MakeTeeScene(), {}, 15.625, 513), quiet(without, {}, 15.625, 513);
  EXPECT_EQ(CalcSpectrumAt(spectrum, {-1, 0}), CalcSpectrumAt(quiet, {-1, 0}));
  EXPECT_EQ(CalcSpectrumAt(spectrum, {3, 10}), CalcSpectrumAt(quiet, {3, 10}));
  EXPECT_NE(CalcSpectrumAt(spectrum, {1, 10}), CalcSpectrumAt(quiet, {1, 10}));
}

TEST(ListenerSpectrum, DoesNotRememberWhatItWasAskedBefore) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  ListenerSpectrum used(scene, {}, 15.625, 513), fresh(scene, {}, 15.625, 513);
  std::vector<float> a(513), b(513);
  for (int i = 0; i < 500; ++i) used.Calc({0, 0, 0.01 * i, 0.004 * i, 0.05 + 1e-4 * (i % 3)}, a);
  used.Calc({0, 0, 0.4, 0.05, 0.075}, a);
  fresh.Calc({0, 0, 0.4, 0.05, 0.075}, b);
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace piperun::acoustics
