#include "acoustics/impact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "acoustics/hydrophone.h"
#include "acoustics/level.h"
#include "base/check.h"
#include "tests/acoustics/scenes.h"
#include "tests/acoustics/statistics.h"

namespace piperun::acoustics {
namespace {

const RandomStream kRandom(1, "hydrophone0", 0);
const Rate kRate(16000);
constexpr double kDensity = 999.7;
constexpr double kPi = std::numbers::pi;

/// 60 mm, relative density 1.1.
StruckBall MakeBall() { return {0.03, 1.1 * 999.7 * 4 / 3 * kPi * 2.7e-5, false}; }

ImpactParams MakeMute() {
  ImpactParams params;
  params.ring_Pa_per_N_s = 0;
  return params;
}

Knock MakeKnock(double time_s, double impulse_N_s = 0.02, double contact_time_s = 1e-3) {
  return {TrueTime(FromSeconds(time_s)), impulse_N_s, contact_time_s};
}

/// `seconds` of what knocks sound like.
std::vector<double> RenderKnocks(const ImpactParams& params, const std::vector<Knock>& knocks, double seconds,
                                 double high_pass_Hz = 0, Rate rate = kRate) {
  ImpactSound sound(params, MakeBall(), kDensity, rate, high_pass_Hz, kRandom);
  for (const Knock& knock : knocks) sound.Add(knock);
  std::vector<float> pressure_Pa(static_cast<std::size_t>(seconds * rate.Hz()));
  sound.Render(pressure_Pa);
  return {pressure_Pa.begin(), pressure_Pa.end()};
}

double Peak(const std::vector<double>& x) {
  return std::abs(
      *std::max_element(x.begin(), x.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

TEST(NearPressure, IntegratesToTheForceThatTheAddedMassTakes) {
  // p = rho r a/2 cos theta over the sphere: the axial force is rho V/2 a, and sqrt(3) is the rms of cos
  // theta
  const StruckBall ball = MakeBall();
  const double r = ball.radius_m, displaced = kDensity * 4 / 3 * kPi * r * r * r;
  const double face_on_Pa = std::numbers::sqrt3 * CalcNearPressure_Pa_per_N(ball, kDensity);
  double force_N = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double theta = kPi * (i + 0.5) / n;
    force_N += face_on_Pa * std::cos(theta) * std::cos(theta) * 2 * kPi * r * r * std::sin(theta) * kPi / n;
  }
  // of 1 N the water takes its share of the inertia
  EXPECT_NEAR(force_N, displaced / 2 / (ball.mass_kg + displaced / 2), 1e-7);
}

TEST(Impact, IsTheHalfSineOfItsForce) {
  // 0.02 N s in 1 ms on the 60 mm ball: F = 31.4 N, a = F/(m + rho V/2) = 173.6 m/s2,
  // p = rho r a/2 / sqrt(3) = 1503 Pa
  const auto pressure = RenderKnocks(MakeMute(), {MakeKnock(0.01)}, 0.02);
  const double force_N = kPi / 2 * 0.02 / 1e-3;
  const double inertia_kg = 1.6 * kDensity * 4 / 3 * kPi * 2.7e-5;
  const double peak_Pa = kDensity * 0.03 / 2 * force_N / inertia_kg / std::sqrt(3.0);
  EXPECT_NEAR(peak_Pa, 1503, 1);
  // a sample is a mean over 1/16 of the pulse, the greatest one from 7/16 to 8/16
  EXPECT_NEAR(Peak(pressure), 16 / kPi * std::cos(7 * kPi / 16) * peak_Pa, 1e-5 * peak_Pa);
  for (std::size_t n = 0; n < pressure.size(); ++n) {
    const double t = (static_cast<double>(n) - 0.5) / 16000 - 0.01;
    const double expected = t > 0 && t < 1e-3 ? peak_Pa * std::sin(kPi * t / 1e-3) : 0;
    EXPECT_NEAR(pressure[n], expected, 0.02 * peak_Pa) << n;
  }
}

TEST(Impact, ImpulseIsKeptWhereverTheKnockFallsBetweenTheSamples) {
  for (const double contact_time_s : {2e-5, 1e-4, 1e-3, 2e-2}) {
    for (const double late : {0.0, 0.3, 0.77}) {
      const double begin_s = 0.01 + std::round(late / 16000 * 1e9) * 1e-9;
      const auto pressure = RenderKnocks(MakeMute(), {MakeKnock(begin_s, 0.02, contact_time_s)}, 0.05);
      const double integral = std::accumulate(pressure.begin(), pressure.end(), 0.0) / 16000;
      EXPECT_NEAR(integral / (0.02 * CalcNearPressure_Pa_per_N(MakeBall(), kDensity)), 1, 1e-6);
      // its centre of gravity is half a contact time after the beginning, and half a sample by the mean
      double moment = 0;
      for (std::size_t n = 0; n < pressure.size(); ++n)
        moment += static_cast<double>(n) / 16000 * pressure[n];
      EXPECT_NEAR(moment / 16000 / integral - begin_s, contact_time_s / 2 + 0.5 / 16000, 0.5 / 16000);
    }
  }
}

TEST(Impact, InputStageIsAFirstOrderHighPass) {
  // the step response exp(-2 pi f_c t) of a long push, by the convolution with the pulse
  const double corner_Hz = 10, contact_s = 0.02;
  const auto pressure = RenderKnocks(MakeMute(), {MakeKnock(0, 0.02, contact_s)}, 0.2, corner_Hz);
  const double peak_Pa = kPi / 2 * 0.02 / contact_s * CalcNearPressure_Pa_per_N(MakeBall(), kDensity);
  const double w = 2 * kPi * corner_Hz, W = kPi / contact_s;
  // y' + w y = x', x = P sin(W t): y = P W/(w^2 + W^2) (w cos W t + W sin W t - w exp(-w t)) within the push,
  // and falls off exponentially from there
  const auto response = [&](double t) {
    return peak_Pa * W / (w * w + W * W) * (w * std::cos(W * t) + W * std::sin(W * t) - w * std::exp(-w * t));
  };
  for (std::size_t n = 1; n < pressure.size(); ++n) {
    const double t = (static_cast<double>(n) - 0.5) / 16000;
    const double expected =
        t < contact_s ? response(t) : response(contact_s) * std::exp(-w * (t - contact_s));
    EXPECT_NEAR(pressure[n], expected, 1e-3 * peak_Pa) << n;
  }
}

TEST(Impact, RingHasItsLevelItsBandAndItsDecay) {
  ImpactParams params;
  StruckBall heavy = MakeBall();
  heavy.mass_kg = 1e12;                // no near pressure
  const double contact_time_s = 1e-5;  // short: (2 f T)^2 <= 0.0064 up to 4 kHz
  double early = 0, late = 0;
  const int knocks = 400;
  std::vector<double> record;
  for (int i = 0; i < knocks; ++i) {
    ImpactSound sound(params, heavy, kDensity, kRate, 0, kRandom);
    sound.Add(MakeKnock(1e-3 * i, 0.02, contact_time_s));
    std::vector<float> pressure_Pa(6400 + 3200);
    sound.Render(pressure_Pa);
    const auto begin = pressure_Pa.begin() + 16 * i + (i > 0);
    for (auto p = begin; p < begin + 80; ++p) early += double{*p} * *p / 80 / knocks;
    for (auto p = begin + 1200; p < begin + 1280; ++p) late += double{*p} * *p / 80 / knocks;
    record.insert(record.end(), begin, begin + 2048);
  }
  // 5 ms at the beginning lose 0.67 dB to the decay on average; 400 knocks of 16 modes over 5 ms scatter by
  // 4.3 dB/sqrt(400)
  const double level_dB = 20 * std::log10(20 * 0.02);
  EXPECT_NEAR(10 * std::log10(early), level_dB - 0.67, 0.3);
  EXPECT_NEAR(10 * std::log10(late / early), -20, 0.4);
  const auto psd = Welch(record, 2048, 16000);
  double inside = 0, all = 0;
  for (std::size_t k = 1; k < psd.size(); ++k) {
    const double f_Hz = static_cast<double>(k) * 16000 / 2048;
    all += psd[k];
    if (f_Hz > 900 && f_Hz < 4100) inside += psd[k];
  }
  EXPECT_GT(inside / all, 0.95);
}

TEST(Impact, SoftBlowHardlyRings) {
  // (2 f T)^2 of 20 ms at 2 kHz is 6400
  EXPECT_NEAR(CalcRingShare(2000, 0.02), 1 / 6401.0, 1e-12);
  EXPECT_NEAR(CalcRingShare(2000, 1e-3), 1 / 17.0, 1e-12);
  EXPECT_NEAR(CalcRingShare(2000, 1e-6), 1, 2e-5);
}

TEST(Impact, DefaultRingLiesEightDecibelsOverTheQuietBackground) {
  // 0.02 N s within 1 ms against 80 - 25 log10(f/100) dB, 1 to 4 kHz; +- 3 dB in the trade
  const ImpactParams params;
  double power = 0;
  for (int i = 0; i < 1000; ++i) {
    const double share = CalcRingShare(1000 * std::pow(4, (i + 0.5) / 1000), params.contact_time_s);
    power += 0.4 * 0.4 * share * share / 1000;
  }
  const AmbientParams ambient;
  const auto noise = [&](double f_Hz) { return CalcDistantNoisePsd(ambient, f_Hz); };
  const double over_dB = CalcLevel_dB(power) - CalcLevel_dB(IntegrateLog(noise, 1000, 4000));
  EXPECT_NEAR(over_dB, 8, 3);
}

TEST(Impact, ModesBeyondTheNyquistFrequencyAreLeftOut) {
  ImpactParams params;
  params.ring_low_Hz = 9000;
  params.ring_high_Hz = 20000;
  const auto pressure = RenderKnocks(params, {MakeKnock(0, 0.02, 1e-3)}, 0.1);
  const auto mute = RenderKnocks(MakeMute(), {MakeKnock(0, 0.02, 1e-3)}, 0.1);
  EXPECT_EQ(pressure, mute);
}

TEST(Impact, FallsSilentAgain) {
  ImpactSound sound({}, MakeBall(), kDensity, kRate, 10, kRandom);
  EXPECT_TRUE(sound.silent());
  sound.Add(MakeKnock(0.01));
  EXPECT_FALSE(sound.silent());
  std::vector<float> pressure_Pa(32000);
  sound.Render(pressure_Pa);
  EXPECT_TRUE(sound.silent());
  EXPECT_NE(pressure_Pa[170], 0);
  EXPECT_EQ(pressure_Pa.back(), 0);
}

TEST(Impact, IsNotHeardWhenSwitchedOffOrNotFinite) {
  ImpactParams off;
  off.on = false;
  EXPECT_EQ(Peak(RenderKnocks(off, {MakeKnock(0)}, 0.1)), 0);
  EXPECT_EQ(Peak(RenderKnocks({}, {MakeKnock(0, std::numeric_limits<double>::quiet_NaN())}, 0.1)), 0);
}

TEST(Impact, RefusesABandThatIsNone) {
  ImpactParams params;
  params.ring_high_Hz = params.ring_low_Hz;
  EXPECT_THROW(ImpactSound(params, MakeBall(), kDensity, kRate, 10, kRandom), InputError);
}

TEST(ImpactDeathTest, IsToldBeforeItsSamples) {
  ImpactSound sound({}, MakeBall(), kDensity, kRate, 10, kRandom);
  std::vector<float> pressure_Pa(1600);
  sound.Render(pressure_Pa);
  sound.Add({SampleTime(1599, kRate) + Duration(1), 0.02, 1e-3});  // still in time
  EXPECT_DEATH(sound.Add({SampleTime(1599, kRate), 0.02, 1e-3}), "told before");
}

AcousticScene MakeNoisyScene() {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  scene.ball = MakeBall();
  AddLeak(scene, 10, MakeJet(1e-5, 1e-3));
  return scene;
}

/// A second of hydrophone, told each knock just before the block that it begins in.
std::vector<std::int32_t> Record(const AcousticScene& scene, const std::vector<Knock>& knocks,
                                 std::size_t block) {
  Hydrophone hydrophone({}, scene, kRandom);
  std::vector<std::int32_t> counts(16000);
  std::size_t told = 0;
  for (std::size_t begin = 0; begin < counts.size(); begin += block) {
    const std::size_t end = std::min(begin + block, counts.size());
    while (told < knocks.size() &&
           knocks[told].time <= SampleTime(static_cast<std::int64_t>(end) - 1, kRate)) {
      hydrophone.Add(knocks[told++]);
    }
    hydrophone.Render(StillAt(12), std::span(counts).subspan(begin, end - begin));
  }
  return counts;
}

TEST(Hydrophone, KnocksDoNotDependOnTheSizeOfTheBlocks) {
  const std::vector<Knock> knocks = {MakeKnock(0, 0.001), MakeKnock(0.25, 0.01),
                                     MakeKnock(0.2501, 0.02, 0.02), MakeKnock(0.7)};
  const auto whole = Record(MakeNoisyScene(), knocks, 16000);
  for (const std::size_t block : {1U, 511U, 512U, 1600U}) {
    EXPECT_EQ(Record(MakeNoisyScene(), knocks, block), whole) << block;
  }
}

TEST(Hydrophone, AKnockChangesNoSampleBeforeItAndNoneLongAfterIt) {
  const auto without = Record(MakeNoisyScene(), {}, 1600);
  const auto with = Record(MakeNoisyScene(), {MakeKnock(0.3, 1e-4)}, 1600);
  EXPECT_TRUE(std::equal(with.begin(), with.begin() + 4800, without.begin()));
  EXPECT_FALSE(std::equal(with.begin() + 4800, with.begin() + 4810, without.begin() + 4800));
  // 7.5 Pa behind a high-pass of 10 Hz are gone in 0.6 s, and so is the ring: 10^-8 of it is left
  EXPECT_TRUE(std::equal(with.begin() + 14400, with.end(), without.begin() + 14400));
}

TEST(Hydrophone, ClipsAndCountsKnocksBeyondItsRange) {
  // 1503 Pa at the top of a half-sine of 1 ms: beyond 1000 Pa for 1 - 2/pi asin(1000/1503) = 53.6 % of it
  AcousticScene scene = MakeNoisyScene();
  scene.ambient.impacts.ring_Pa_per_N_s = 0;
  Hydrophone hydrophone(MakeNoiselessHydrophone(), scene, kRandom);
  hydrophone.Add(MakeKnock(0.01));
  std::vector<std::int32_t> counts(1600);
  hydrophone.Render(StillAt(12), counts);
  EXPECT_NEAR(static_cast<double>(hydrophone.clipped_samples()), 0.536 * 16, 1);
}

}  // namespace
}  // namespace piperun::acoustics
