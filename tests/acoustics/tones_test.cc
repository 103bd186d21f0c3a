#include "acoustics/tones.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "acoustics/level.h"
#include "base/check.h"
#include "tests/acoustics/scenes.h"

namespace piperun::acoustics {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kSource_m = 100;
const RandomStream kRandom(1, "hydrophone0", 0);

/// One machine with one line of 1 Pa rms (120 dB re 1 uPa) beside it.
AcousticScene MakeToneScene(double f_Hz, const PipeWave& wave) {
  AcousticScene scene = MakeQuietScene(wave);
  scene.tones = {{"P", 0, kSource_m, {}, CalcHarmonics({f_Hz, 1, 120, -6}, wave.impedance_Pa_s_m3)}};
  return scene;
}

Hydrophone::ListenerAt Moving(double s_m, double v_m_s) {
  return [=](TrueTime t) {
    ListenerState listener{0, s_m + v_m_s * Seconds(t), 0, 0, kPvcBore_m / 2};
    listener.time = t;
    return listener;
  };
}

/// Complex amplitude of the line at f in x (Goertzel's filter): peak value and phase at x[0]. A whole number
/// of periods makes it exact.
std::complex<double> FindLine(std::span<const double> x, double f_Hz, double rate_Hz) {
  const double w = kTwoPi * f_Hz / rate_Hz;
  double s1 = 0, s2 = 0;
  for (const double sample : x) {
    const double s = sample + 2 * std::cos(w) * s1 - s2;
    s2 = s1;
    s1 = s;
  }
  const double n = static_cast<double>(x.size());
  return (s1 - std::polar(1.0, -w) * s2) * std::polar(2 / n, -w * (n - 1));
}

TEST(Tones, HarmonicsFallByTheirStepAndLieAtMultiples) {
  const double zc = MakePvcWave().impedance_Pa_s_m3;
  const auto tones = CalcHarmonics({148, 8, 120, -6}, zc);
  ASSERT_EQ(tones.size(), 8U);
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const double p_rms_Pa = 0.5 * zc * tones[i].volume_velocity_m3_s / std::numbers::sqrt2;
    EXPECT_DOUBLE_EQ(tones[i].f_Hz, 148.0 * static_cast<double>(i + 1));
    EXPECT_NEAR(20 * std::log10(p_rms_Pa / 1e-6), 120 - 6 * static_cast<double>(i), 1e-9);
  }
}

TEST(Tones, AreHeardWithTheirLevelAndTheLossOfTheWay) {
  const PipeWave wave = MakePvcWave();
  for (const double f_Hz : {148.0, 1036.0}) {
    for (const double x_m : {0.0, 2.0, -15.0}) {
      const auto p = RenderPressure(MakeToneScene(f_Hz, wave), MakeNoiselessHydrophone(), kRandom,
                                    Moving(kSource_m + x_m, 0), 2);
      const auto line = FindLine(std::span(p).first(16000), f_Hz, 16000);
      const double expected_Pa = std::numbers::sqrt2 * std::exp(-wave.Attenuation_Np_m(f_Hz) * std::abs(x_m));
      EXPECT_NEAR(20 * std::log10(std::abs(line) / expected_Pa), 0, 0.01) << f_Hz << " Hz, " << x_m;
    }
  }
}

TEST(Tones, PassTheInputStage) {
  HydrophoneParams params = MakeNoiselessHydrophone();
  params.high_pass_Hz = 50;
  const auto p = RenderPressure(MakeToneScene(50, MakeIronWave()), params, kRandom, Moving(kSource_m, 0), 1);
  const auto line = FindLine(p, 50, 16000);
  EXPECT_NEAR(std::abs(line), 1, 1e-3);                     // 3 dB below the peak of sqrt(2) Pa
  EXPECT_NEAR(std::arg(line), std::numbers::pi / 4, 1e-3);  // i/(1 + i)
}

/// p(t) = sqrt(2) exp(-alpha |x|) cos(2 pi f (t - |x|/c)), the closed form for one line that starts at phase
/// 0.
TEST(Tones, AListenerThatPassesHearsTheClosedFormWithItsDopplerShift) {
  const PipeWave wave = MakePvcWave();
  for (const double f_Hz : {345.0, 2931.0}) {
    const auto p = RenderPressure(MakeToneScene(f_Hz, wave), MakeNoiselessHydrophone(), kRandom,
                                  Moving(kSource_m - 2, 1), 4);
    const double alpha = wave.Attenuation_Np_m(f_Hz);
    double worst_Pa = 0;
    for (std::size_t n = 0; n < p.size(); ++n) {
      const double t_s = static_cast<double>(n) / 16000, x_m = std::abs(t_s - 2);
      const double expected_Pa = std::numbers::sqrt2 * std::exp(-alpha * x_m) *
                                 std::cos(kTwoPi * f_Hz * (t_s - x_m / wave.speed_m_s));
      worst_Pa = std::max(worst_Pa, std::abs(p[n] - expected_Pa));
    }
    const double turn_rad = kTwoPi * f_Hz / wave.speed_m_s * 1.0 * 64 / 16000;  // in a stretch at 1 m/s
    // a chord's sagitta; at the source itself, where the way's length has a corner, half a stretch on top
    EXPECT_LT(worst_Pa, std::numbers::sqrt2 * (turn_rad * turn_rad / 8 + turn_rad / 4) + 2e-4) << f_Hz;
  }
}

TEST(Tones, AListenerThatLeavesHearsALowerTone) {
  const PipeWave wave = MakePvcWave();
  const double f_Hz = 1000, v_m_s = 2;
  const auto p = RenderPressure(MakeToneScene(f_Hz, wave), MakeNoiselessHydrophone(), kRandom,
                                Moving(kSource_m + 1, v_m_s), 1);
  // the phase that the line gains on f within half a second, from windows of 0.1 s
  const auto early = FindLine(std::span(p).subspan(1600, 1600), f_Hz, 16000);
  const auto later = FindLine(std::span(p).subspan(9600, 1600), f_Hz, 16000);
  const double turns = -f_Hz * v_m_s / wave.speed_m_s * 0.5;
  const double gained = std::arg(later / early) / kTwoPi;
  EXPECT_NEAR(std::remainder(gained - turns, 1), 0, 2e-3);
}

TEST(Tones, NothingBreaksWhereTheListenerChangesPipes) {
  const PipeWave wave = MakePvcWave();
  AcousticScene scene = MakeToneScene(345, wave);
  scene.network = MakeNetwork({{0, 1, 103, wave}, {1, 2, 50, wave}});
  const auto listener = [](TrueTime t) {
    const double s_m = 102 + Seconds(t);
    ListenerState state{s_m < 103 ? 0 : 1, s_m < 103 ? s_m : s_m - 103, 0, 0, kPvcBore_m / 2};
    state.time = t;
    return state;
  };
  const auto in_two = RenderPressure(scene, MakeNoiselessHydrophone(), kRandom, listener, 2);
  const auto in_one =
      RenderPressure(MakeToneScene(345, wave), MakeNoiselessHydrophone(), kRandom, Moving(102, 1), 2);
  for (std::size_t n = 0; n < in_one.size(); ++n) {
    // within the frame that holds the node the amplitude goes along a chord of 0.18 rad
    ASSERT_NEAR(in_two[n], in_one[n], 0.004 * std::numbers::sqrt2 + 2e-4) << n;
  }
}

TEST(Tones, DoNotDependOnTheSizeOfTheBlocks) {
  AcousticScene scene = MakeToneScene(345, MakePvcWave());
  scene.ambient = {};
  scene.tones[0].times = {.on_s = 0.3, .off_s = 1.1, .ramp_s = 0.1};
  const auto render = [&](std::size_t block) {
    Hydrophone hydrophone({}, scene, kRandom);
    std::vector<std::int32_t> counts(24000);
    for (std::size_t i = 0; i < counts.size(); i += block) {
      hydrophone.Render(Moving(99, 1), std::span(counts).subspan(i, std::min(block, counts.size() - i)));
    }
    return counts;
  };
  const auto whole = render(24000);
  for (const std::size_t block : {1U, 63U, 512U, 1600U}) EXPECT_EQ(render(block), whole) << block;
}

TEST(Tones, AreAddedToARecordThatStaysAsItIs) {
  AcousticScene with = MakeToneScene(345, MakePvcWave());
  with.ambient = {};
  with.tones[0].times = {.on_s = 1, .off_s = 2, .ramp_s = 0.1};
  AcousticScene without = with;
  without.tones.clear();
  const auto a = RenderPressure(with, {}, kRandom, Moving(101, 0.5), 3);
  const auto b = RenderPressure(without, {}, kRandom, Moving(101, 0.5), 3);
  double difference_Pa2 = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const double t_s = static_cast<double>(n) / 16000;
    const bool sounds = t_s > 0.99 && t_s < 2.01;
    ASSERT_TRUE(sounds || a[n] == b[n]) << n;
    if (t_s > 1.1 && t_s < 1.9) difference_Pa2 += (a[n] - b[n]) * (a[n] - b[n]) / (0.8 * 16000);
  }
  const double loss_Np = MakePvcWave().Attenuation_Np_m(345) * 1.75;  // mean way: 1 + 0.5 * 1.5 m
  EXPECT_NEAR(10 * std::log10(difference_Pa2) + 20 / std::numbers::ln10 * loss_Np, 0, 0.05);
}

TEST(Tones, AFirstLineAboveHalfTheRateIsRefusedAndHigherOnesAreTakenAway) {
  const auto is_refused = [](double f_Hz) {
    try {
      Hydrophone({}, MakeToneScene(f_Hz, MakePvcWave()), kRandom);
    } catch (const InputError& e) {
      return e.key_path() == "rate_Hz" && e.problem().find("'P'") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(is_refused(8000));
  EXPECT_FALSE(is_refused(7999));
  AcousticScene scene = MakeToneScene(5000, MakePvcWave());
  scene.tones[0].tones = CalcHarmonics({5000, 3, 120, 0}, MakePvcWave().impedance_Pa_s_m3);
  const auto p = RenderPressure(scene, MakeNoiselessHydrophone(), kRandom, Moving(kSource_m, 0), 1);
  EXPECT_NEAR(std::abs(FindLine(p, 5000, 16000)), std::numbers::sqrt2, 1e-3);
  EXPECT_LT(std::abs(FindLine(p, 6000, 16000)), 1e-4);  // where 10 kHz would be folded to
  EXPECT_LT(std::abs(FindLine(p, 1000, 16000)), 1e-4);  // and 15 kHz
}

}  // namespace
}  // namespace piperun::acoustics
