#include "acoustics/hydrophone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "acoustics/level.h"
#include "base/check.h"
#include "tests/acoustics/scenes.h"
#include "tests/acoustics/statistics.h"

namespace piperun::acoustics {
namespace {

const RandomStream kRandom(1, "hydrophone0", 0);

/// The default background with three leaks in PVC.
AcousticScene MakeBusyScene() {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  AddLeak(scene, 4, MakeJet(2e-5, 1.2e-3));
  AddLeak(scene, 6, MakeJet(5e-5, 2e-3));
  AddLeak(scene, 11, MakeJet(1e-5, 1e-3));
  return scene;
}

ListenerState WalkPast(TrueTime t) { return {0, 3 + 0.7 * Seconds(t), 0.8, 0.1, kPvcBore_m / 2}; }

std::vector<std::int32_t> RenderInBlocks(std::size_t total, std::size_t block, const RandomStream& random) {
  Hydrophone hydrophone({}, MakeBusyScene(), random);
  std::vector<std::int32_t> counts(total);
  for (std::size_t begin = 0; begin < total; begin += block) {
    hydrophone.Render(WalkPast, std::span(counts).subspan(begin, std::min(block, total - begin)));
  }
  return counts;
}

TEST(Hydrophone, SamplesDoNotDependOnTheSizeOfTheBlocks) {
  const auto whole = RenderInBlocks(30000, 30000, kRandom);
  for (const std::size_t block : {1u, 511u, 512u, 777u, 1600u}) {
    EXPECT_EQ(RenderInBlocks(30000, block, kRandom), whole) << block;
  }
}

TEST(Hydrophone, EverySeedNameAndRunHasItsOwnNoise) {
  const auto render = [](const RandomStream& random) {
    const auto counts = RenderInBlocks(160000, 1600, random);
    return std::vector<double>(counts.begin(), counts.end());
  };
  const auto base = render(kRandom);
  EXPECT_EQ(render(RandomStream(1, "hydrophone0", 0)), base);
  for (const auto& other : {RandomStream(2, "hydrophone0", 0), RandomStream(1, "hydrophone1", 0),
                            RandomStream(1, "hydrophone0", 1)}) {
    // red noise of 10 s: at least 1000 independent samples
    EXPECT_LT(std::abs(Correlation(render(other), base)), 4 / std::sqrt(1000.0));
  }
}

TEST(Hydrophone, AsksForTheListenerOncePerHalfFrameAndNotBeyondItsLookahead) {
  Hydrophone hydrophone({}, MakeBusyScene(), kRandom);
  std::vector<TrueTime> asked;
  std::vector<std::int32_t> block(1600);
  for (std::int64_t b = 0; b < 20; ++b) {
    hydrophone.Render(
        [&](TrueTime t) {
          asked.push_back(t);
          return WalkPast(t);
        },
        block);
    EXPECT_LE(asked.back(), SampleTime(1600 * (b + 1) - 1, hydrophone.rate()) + hydrophone.lookahead());
  }
  for (std::size_t m = 0; m < asked.size(); ++m) {
    EXPECT_EQ(asked[m], SampleTime(512 * static_cast<std::int64_t>(m), hydrophone.rate()));
  }
}

TEST(Hydrophone, HearsAStillLeakAtItsExactLevel) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, 10, MakeJet(1e-3 / 60, 1.2e-3));
  const auto pressure = RenderPressure(scene, MakeNoiselessHydrophone(), kRandom, StillAt(12), 200);
  const auto psd = [&](double f_Hz) { return CalcLeakPsdAt(scene, 0, {0, 12}, f_Hz); };
  // bins 1 to 511, each 15.625 Hz wide
  const double expected = IntegrateLog(psd, 0.5 * 15.625, 511.5 * 15.625);
  // some 600 Hz of noise in 200 s: 4.34 dB / sqrt(1.2e5) = 0.013 dB
  EXPECT_NEAR(CalcLevel_dB(MeanSquare(pressure)), CalcLevel_dB(expected), 0.05);
}

TEST(Hydrophone, RecordIsGaussian) {
  AcousticScene scene = MakeQuietScene(MakeIronWave());
  AddLeak(scene, 10, MakeJet(1e-3 / 60, 1.2e-3));
  const auto pressure = RenderPressure(scene, MakeNoiselessHydrophone(), kRandom, StillAt(12), 120);
  EXPECT_NEAR(Kurtosis(pressure), 3, 0.05);  // sqrt(24 / 4e5) = 0.008 for 3 kHz of noise
}

TEST(Hydrophone, ThirdOctavesFollowTheModel) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  AddLeak(scene, 10, MakeJet(1e-4 / 60, 1.2e-3));
  HydrophoneParams params;
  params.high_pass_Hz = 100;
  const double seconds = 120;
  const ListenerState listener = StillAt(11)(TrueTime{});
  const auto measured =
      Welch(RenderPressure(scene, params, kRandom, StillAt(11), seconds), 4096, params.rate_Hz);
  const double width_Hz = params.rate_Hz / 4096;
  for (int band = 24; band <= 38; ++band) {  // 250 Hz to 6.3 kHz
    const double centre_Hz = std::pow(10, band / 10.0);
    const auto low = static_cast<std::size_t>(centre_Hz / std::pow(2, 1.0 / 6) / width_Hz);
    const auto high = static_cast<std::size_t>(centre_Hz * std::pow(2, 1.0 / 6) / width_Hz);
    double sum = 0, expected = 0;
    for (std::size_t k = low; k < high; ++k) {
      const double f_Hz = static_cast<double>(k) * width_Hz;
      const double sound = CalcLeakPsdAt(scene, 0, {0, 11}, f_Hz) +
                           CalcBackgroundPsd(scene, listener, params.face_radius_m, f_Hz);
      sum += measured[k];
      expected += sound * f_Hz * f_Hz / (f_Hz * f_Hz + 1e4) + CalcPressureSquared(42);
    }
    // relative spread 1/sqrt(B T); four sigma, and 0.05 dB for bins 16 Hz wide on a sloping spectrum
    const double sigma_dB = 4.343 / std::sqrt(static_cast<double>(high - low) * width_Hz * seconds);
    EXPECT_NEAR(10 * std::log10(sum / expected), 0, 4 * sigma_dB + 0.05) << centre_Hz << " Hz";
  }
}

TEST(Hydrophone, LevelFallsWithDistanceAsTheAttenuationSays) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, 10, std::make_shared<FlatSound>(1e-14, 980, 1020));
  const auto level_dB = [&](double s_m) {
    return CalcLevel_dB(
        MeanSquare(RenderPressure(scene, MakeNoiselessHydrophone(), kRandom, StillAt(s_m), 100)));
  };
  // 3.21 dB/m at 1 kHz in the published table; the same seed at all places: only the level differs
  const double beside_dB = level_dB(10.3);  // two bores from the hole
  EXPECT_NEAR((beside_dB - level_dB(15)) / 4.7, 3.21, 0.01 * 3.21);
  EXPECT_NEAR((beside_dB - level_dB(5)) / 4.7, 3.21, 0.01 * 3.21);
  EXPECT_NEAR((beside_dB - level_dB(10.8)) / 0.5, 3.21, 0.01 * 3.21);
}

/// Level of consecutive stretches of 32 ms against the place of their middle.
struct Profile {
  std::vector<double> chainage_m, level_dB;
};

Profile MeasurePassage(std::uint64_t seed, double hole_m, double speed_m_s) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, hole_m, std::make_shared<FlatSound>(1e-13, 2900, 3100));
  const auto listener = [&](TrueTime t) {
    return ListenerState{0, 7 + speed_m_s * Seconds(t), speed_m_s, 0, kPvcBore_m / 2};
  };
  const auto pressure = RenderPressure(scene, MakeNoiselessHydrophone(), RandomStream(seed, "hydrophone0", 0),
                                       listener, 6 / speed_m_s);
  Profile profile;
  for (std::size_t n = 0; n + 512 <= pressure.size(); n += 512) {
    profile.chainage_m.push_back(7 + speed_m_s * (static_cast<double>(n) + 255.5) / 16000);
    profile.level_dB.push_back(CalcLevel_dB(MeanSquare(std::span(pressure).subspan(n, 512))));
  }
  return profile;
}

/// Least-squares line of level over |s - hole|: returns slope and residual sum of squares.
std::pair<double, double> FitRoof(const Profile& profile, double hole_m) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < profile.level_dB.size(); ++i, ++n) {
    const double x = std::abs(profile.chainage_m[i] - hole_m), y = profile.level_dB[i];
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
  }
  const double cov = sxy - sx * sy / n, var = sxx - sx * sx / n;
  return {cov / var, syy - sy * sy / n - cov * cov / var};
}

double FindRoofTop(const Profile& profile) {
  double best_m = 0, least = std::numeric_limits<double>::infinity();
  for (int mm = 9500; mm < 10500; ++mm) {
    const double hole_m = 1e-3 * mm;
    const double residual = FitRoof(profile, hole_m).second;
    if (residual < least) {
      least = residual;
      best_m = hole_m;
    }
  }
  return best_m;
}

TEST(Hydrophone, PassingAHoleIsLoudestThereAndFallsOffStraight) {
  for (const double speed_m_s : {0.3, 1.0}) {
    double top_m = 0, slope = 0;
    const int passes = 20;
    for (int seed = 0; seed < passes; ++seed) {
      const Profile profile = MeasurePassage(static_cast<std::uint64_t>(seed), 10.013, speed_m_s);
      top_m += FindRoofTop(profile) / passes;
      slope += FitRoof(profile, 10.013).first / passes;
    }
    EXPECT_NEAR(top_m, 10.013, 0.02);
    const double alpha_dB_m = 8.685889638 * MakePvcWave().Attenuation_Np_m(3000);
    EXPECT_NEAR(-slope / alpha_dB_m, 1, 0.01);
  }
}

TEST(Hydrophone, BesideTheHoleItHearsTheNearField) {
  // at 1 kHz in DN150: k a = 0.32, so 10 log10(1 + 0.32^2) = 0.43 dB over the plane wave on the axis at the
  // hole, and nothing of it a bore away
  AcousticScene scene = MakeQuietScene(MakeStiffWave());
  const PipeWave wave = MakeStiffWave();
  AddLeak(scene, 10, std::make_shared<FlatSound>(1e-14, 980, 1020));
  const auto level_dB = [&](double s_m) {
    return CalcLevel_dB(
        MeanSquare(RenderPressure(scene, MakeNoiselessHydrophone(), kRandom, StillAt(s_m), 50)));
  };
  const double ka = 2 * std::numbers::pi * 1000 / MakeWater10C().sound_speed_m_s * wave.bore_radius_m;
  EXPECT_NEAR(ka, 0.34, 0.01);
  EXPECT_NEAR(level_dB(10) - level_dB(10.25), 10 * std::log10(1 + ka * ka), 0.02);
  // halfway out: z = 0.15 D
  const double z_m = 0.3 * wave.bore_radius_m, share = std::exp(-1.0) / (1 + 0.09);
  EXPECT_NEAR(level_dB(10 - z_m) - level_dB(10.25), 10 * std::log10(1 + ka * ka * share), 0.02);
}

TEST(Hydrophone, CountsWhatItClips) {
  AcousticScene scene = MakeQuietScene(MakeStiffWave());
  const double pressure_rms_Pa = 1;
  const double impedance = MakeStiffWave().impedance_Pa_s_m3;
  // below the first cut-on at 5.4 kHz: a plane wave
  AddLeak(scene, 10, std::make_shared<FlatSound>(4 / (impedance * impedance) / 2000, 2000, 4000));
  HydrophoneParams params = MakeNoiselessHydrophone();
  params.full_scale_Pa = 2 * pressure_rms_Pa;
  for (const std::int64_t bits : {16, 24}) {
    params.bits = bits;
    Hydrophone hydrophone(params, scene, kRandom);
    std::vector<std::int32_t> counts(800000);
    hydrophone.Render(StillAt(10.5), counts);
    const std::int32_t largest = (1 << (bits - 1)) - 1;
    double at_the_stop = 0;
    for (const std::int32_t c : counts) {
      EXPECT_LE(std::abs(c), largest);
      at_the_stop += std::abs(c) == largest;
    }
    // a Gaussian is beyond two sigma for a share erfc(sqrt 2) = 4.55 % of the time
    const double share =
        static_cast<double>(hydrophone.clipped_samples()) / static_cast<double>(counts.size());
    EXPECT_NEAR(share, std::erfc(std::sqrt(2.0)), 0.001);
    EXPECT_GE(at_the_stop, static_cast<double>(hydrophone.clipped_samples()));
    EXPECT_LE(at_the_stop, 1.01 * static_cast<double>(hydrophone.clipped_samples()));
  }
}

TEST(Hydrophone, FullScaleIsTheLargestCode) {
  HydrophoneParams params;
  EXPECT_DOUBLE_EQ(params.scale_Pa() * 8388607, 1000);
  params.bits = 16;
  EXPECT_DOUBLE_EQ(params.scale_Pa() * 32767, 1000);
}

TEST(Hydrophone, SilenceIsZero) {
  HydrophoneParams params = MakeNoiselessHydrophone();
  Hydrophone hydrophone(params, MakeQuietScene(MakePvcWave()), kRandom);
  std::vector<std::int32_t> counts(5000, 1);
  hydrophone.Render(StillAt(10), counts);
  EXPECT_EQ(counts, std::vector<std::int32_t>(5000, 0));
}

TEST(Hydrophone, AListenerThatIsNotFiniteHearsNothing) {
  Hydrophone hydrophone({}, MakeBusyScene(), kRandom);
  std::vector<std::int32_t> counts(5120);
  hydrophone.Render(
      [](TrueTime t) {
        return t < SampleTime(2048, Rate(16000)) ? WalkPast(t) : ListenerState{0, NAN, 1, 0, 0.07};
      },
      counts);
  const auto loud =
      std::count_if(counts.begin(), counts.begin() + 2048, [](std::int32_t c) { return c != 0; });
  EXPECT_GT(loud, 2000);
  EXPECT_TRUE(std::all_of(counts.begin() + 2048, counts.end(), [](std::int32_t c) { return c == 0; }));
}

/// Within single precision, and rounding of the converter.
template <class Record>
void ExpectAlike(const Record& a, const Record& b) {
  ASSERT_EQ(a.size(), b.size());
  const double step_Pa = 2 * 1000 / 65536.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(a[i], b[i], 1e-4 * std::sqrt(MeanSquare(b)) + 1.01 * step_Pa) << i;
  }
}

TEST(Hydrophone, APipeCutInTwoSoundsAsTheWholeOne) {
  AcousticScene whole = MakeQuietScene(MakePvcWave());
  AddLeak(whole, 60, MakeJet(2e-5, 1.2e-3));
  AcousticScene cut = MakeQuietScene(MakePvcWave());
  cut.network = MakeNetwork({{0, 1, 64, MakePvcWave()}, {2, 1, 336, MakePvcWave()}});
  AddLeak(cut, {0, 60}, MakeJet(2e-5, 1.2e-3));
  const auto s_m = [](TrueTime t) { return 62.5 + 1.5 * Seconds(t); };
  const auto in_whole = [&](TrueTime t) { return ListenerState{0, s_m(t), 0.5, 0.05, 0.07}; };
  const auto in_cut = [&](TrueTime t) {
    const ListenerState before{0, s_m(t), 0.5, 0.05, 0.07}, beyond{1, 400 - s_m(t), 0.5, 0.05, 0.07};
    return s_m(t) < 64 ? before : beyond;
  };
  ExpectAlike(RenderPressure(cut, {}, kRandom, in_cut, 4), RenderPressure(whole, {}, kRandom, in_whole, 4));
}

TEST(Hydrophone, ALeakTooFarToBeHeardChangesNothing) {
  AcousticScene near = MakeQuietScene(MakePvcWave());
  near.ambient = {};
  near.network = MakeNetwork({{0, 1, kPipe_m, MakePvcWave()},
                              {1, 2, 1e4, MakePvcWave()},  // 0.05 dB/m in the lowest bin
                              {3, 4, 10, MakePvcWave()}});
  AddLeak(near, {0, 4}, MakeJet(2e-5, 1.2e-3));
  AcousticScene far = near;
  AddLeak(far, {1, 9e3}, MakeJet(2e-5, 1.2e-3));
  AddLeak(far, {2, 5}, MakeJet(2e-5, 1.2e-3));
  std::swap(far.leaks.front(), far.leaks.back());
  AcousticScene audible = near;
  AddLeak(audible, {0, 6}, MakeJet(2e-5, 1.2e-3));
  const auto base = RenderPressure(near, {}, kRandom, WalkPast, 2);
  ExpectAlike(RenderPressure(far, {}, kRandom, WalkPast, 2), base);
  EXPECT_GT(MeanSquare(RenderPressure(audible, {}, kRandom, WalkPast, 2)), 1.1 * MeanSquare(base));
}

TEST(Hydrophone, LevelDoesNotDependOnTheRate) {
  AcousticScene scene = MakeQuietScene(MakeStiffWave());
  AddLeak(scene, 10, std::make_shared<FlatSound>(1e-14, 500, 3500));
  HydrophoneParams params = MakeNoiselessHydrophone();
  const double half_impedance = MakeStiffWave().impedance_Pa_s_m3 / 2;
  const double expected_dB = CalcLevel_dB(half_impedance * half_impedance * 1e-14 * 3000);
  for (const double rate_Hz : {8000.0, 11025.0, 44100.0, 96000.0}) {
    params.rate_Hz = rate_Hz;
    const auto pressure = RenderPressure(scene, params, kRandom, StillAt(10.5), 30);
    EXPECT_NEAR(CalcLevel_dB(MeanSquare(pressure)), expected_dB, 0.08) << rate_Hz;
  }
}

TEST(Hydrophone, RefusesParametersOutOfRange) {
  const auto make = [](auto change) {
    HydrophoneParams params;
    change(params);
    Hydrophone(params, MakeQuietScene(MakePvcWave()), kRandom);
  };
  EXPECT_THROW(make([](HydrophoneParams& p) { p.rate_Hz = 0; }), InputError);
  EXPECT_THROW(make([](HydrophoneParams& p) { p.bits = 20; }), InputError);
  EXPECT_THROW(make([](HydrophoneParams& p) { p.rate_Hz = 16000.5; }), InputError);
  EXPECT_THROW(make([](HydrophoneParams& p) { p.rate_Hz = NAN; }), InputError);
}

TEST(LeakSnr, IsTheRatioOfFlatSpectra) {
  AcousticScene scene = MakeQuietScene(MakeStiffWave());
  AddLeak(scene, 10, std::make_shared<FlatSound>(1e-20, 0, 1e6));
  scene.ambient.distant_level_dB_re_1uPa2_Hz = 60;
  HydrophoneParams params = MakeNoiselessHydrophone();
  const double half_impedance = MakeStiffWave().impedance_Pa_s_m3 / 2;
  const double leak_dB = CalcLevel_dB(half_impedance * half_impedance * 1e-20);
  const ListenerState beside{0, 10.5, 0, 0, kPvcBore_m / 2};
  EXPECT_NEAR(CalcLeakSnr_dB(scene, 0, params, beside, 1000, 4000), leak_dB - 60, 0.01);
  params.self_noise_dB_re_1uPa2_Hz = 60;  // twice the noise
  EXPECT_NEAR(CalcLeakSnr_dB(scene, 0, params, beside, 1000, 4000), leak_dB - 63.01, 0.01);
}

TEST(LeakSnr, EqualsTheIntegralsOfTheFormulas) {
  // 1 L/min at 3 bar through 1.2 mm, 5 m along PVC-U DN150, every formula written out again
  const double pi = std::numbers::pi, Q = 1e-3 / 60, d = 1.2e-3, drop = 3e5;
  const WaterProperties water = MakeWater10C();
  const double rho = water.density_kg_m3, c_f = water.sound_speed_m_s;
  const double X = 2 * rho * c_f * c_f * 0.0775 / (3.5e9 * 0.0075), c = c_f / std::sqrt(1 + X),
               a_i = kPvcBore_m / 2;
  const double Zc = rho * c / (pi * a_i * a_i), fc = 0.15 * std::sqrt(2 * drop / rho) / d;
  const auto high_pass = [](double f) { return f * f / (f * f + 100); };
  const auto leak = [&](double f) {
    const double alpha = 2 * pi * f / c * 0.05 * X / (2 * (1 + X)) +
                         std::sqrt(pi * f * water.kinematic_viscosity_m2_s) / (a_i * c);
    return high_pass(f) * std::pow(Zc / 2 * 2e-3 * Q, 2) * std::pow(1 + f / fc * f / fc, -1.25) /
           (1.19814023 * fc) * std::exp(-2 * alpha * 5);
  };
  const auto noise = [&](double f) {
    return high_pass(f) * 1e-12 * std::pow(10, 8 - 2.5 * std::log10(f / 100)) + 1e-12 * std::pow(10, 4.2) +
           std::pow(1000 / 8388607.0, 2) / 6 / 16000;
  };
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  scene.ambient.flow_noise = false;
  AddLeak(scene, 10, MakeJet(Q, d, drop));
  EXPECT_NEAR(CalcLeakSnr_dB(scene, 0, {}, {0, 15, 0, 0, a_i}, 1000, 4000),
              10 * std::log10(IntegrateLog(leak, 1000, 4000) / IntegrateLog(noise, 1000, 4000)), 1e-3);
}

TEST(LeakSnr, FollowsTheTableOfSnrAgainstDistance) {
  // 1 L/min at 3 bar, 1-4 kHz, default background, printed to a decibel; the table rests on band edges that
  // are not stated (0.9 instead of 1 kHz makes 0.4 dB)
  struct Row {
    PipeWave wave;
    double distance_m = 0, snr_dB = 0;
  };
  const PipeWave iron = CalcPipeWave(0.158, 0.006, MakeWall(165e9, 0.01), MakeWater10C());
  for (const Row& row : {Row{MakePvcWave(), 1, 18}, Row{iron, 0.4, 33},  // plane waves: off the hole
                         Row{iron, 20, 30}, Row{iron, 100, 22}}) {
    AcousticScene scene = MakeQuietScene(row.wave);
    scene.ambient = {};
    AddLeak(scene, 200, MakeJet(1e-3 / 60, 1.2e-3));
    const ListenerState listener{0, 200 + row.distance_m, 0.5, 0.05, row.wave.bore_radius_m};
    EXPECT_NEAR(CalcLeakSnr_dB(scene, 0, {}, listener, 1000, 4000), row.snr_dB, 0.9)
        << row.distance_m << " m";
  }
}

TEST(LeakSnr, OfASilentLeakIsMinusInfinity) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, 10, MakeJet(0, 1e-3));
  EXPECT_EQ(CalcLeakSnr_dB(scene, 0, {}, {0, 10, 0, 0, 0.07}, 1000, 4000),
            -std::numeric_limits<double>::infinity());
}

TEST(LeakSnr, WhereNoPipeLeadsIsMinusInfinity) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.network = MakeNetwork({{0, 1, kPipe_m, MakePvcWave()}, {2, 3, 10, MakePvcWave()}});
  AddLeak(scene, 10, MakeJet(1e-5, 1e-3));
  for (const int pipe : {-1, 1}) {
    EXPECT_EQ(CalcLeakSnr_dB(scene, 0, {}, {pipe, 5, 0, 0, 0.07}, 1000, 4000),
              -std::numeric_limits<double>::infinity());
  }
}

TEST(LeakSnr, RefusesABandThatIsNone) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, 10, MakeJet(1e-5, 1e-3));
  const ListenerState listener{0, 10, 0, 0, 0.07};
  EXPECT_THROW(CalcLeakSnr_dB(scene, 0, {}, listener, 1000, 9000), InputError);
  EXPECT_THROW(CalcLeakSnr_dB(scene, 0, {}, listener, 0, 4000), InputError);
  EXPECT_THROW(CalcLeakSnr_dB(scene, 0, {}, listener, 4000, 1000), InputError);
}

}  // namespace
}  // namespace piperun::acoustics
