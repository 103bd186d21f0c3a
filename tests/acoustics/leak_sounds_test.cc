#include <gtest/gtest.h>

#include <cmath>

#include "tests/acoustics/scenes.h"
#include "tests/acoustics/statistics.h"
#include "tests/support/set_params.h"

namespace piperun::acoustics {
namespace {

using piperun::testing::FindKind;
using piperun::testing::MakeParamsOf;
using piperun::testing::ParamValues;

constexpr double kFlow_m3_s = 4.6e-5, kHole_m = 2e-3, kDensity_kg_m3 = 1000;

std::unique_ptr<LeakSound> MakeSound(const char* name, double drop_Pa, const ParamValues& values = {}) {
  const auto& kind = FindKind(LeakSoundKinds(), name);
  return kind.make(*MakeParamsOf(kind, values), kHole_m, {kFlow_m3_s, drop_Pa}, kDensity_kg_m3);
}

/// What a kind adds to the jet through the same hole.
double Excess(const LeakSound& sound, double drop_Pa, double f_Hz) {
  return sound.VolumeVelocityPsd(f_Hz) -
         MakeJet(kFlow_m3_s, kHole_m, drop_Pa, kDensity_kg_m3)->VolumeVelocityPsd(f_Hz);
}

TEST(LeakSounds, WithoutOutflowAreAllSilent) {
  for (const LeakSoundKind& kind : LeakSoundKinds()) {
    for (const LeakState& state : {LeakState{0, 3e5}, LeakState{1e-5, 0}, LeakState{-1e-5, -3e5}}) {
      const auto sound = kind.make(*kind.make_params(), kHole_m, state, kDensity_kg_m3);
      for (const double f_Hz : {0.0, 100.0, 1000.0, 10000.0}) {
        EXPECT_EQ(sound->VolumeVelocityPsd(f_Hz), 0) << kind.name;
      }
    }
  }
}

TEST(CavitatingJet, IsTheTurbulentJetAboveTheInceptionNumber) {
  // sigma = (108200 - 1228) / 1.7e5 = 0.629 > 0.6
  const auto sound = MakeSound("cavitating_jet", 1.7e5);
  for (const double f_Hz : {10.0, 1000.0, 10000.0}) EXPECT_EQ(Excess(*sound, 1.7e5, f_Hz), 0);
  // 1.8e5 Pa: 0.594
  EXPECT_GT(Excess(*MakeSound("cavitating_jet", 1.8e5), 1.8e5, 1000.0), 0);
}

TEST(CavitatingJet, AddsNoiseThatIsFlatToTenKilohertz) {
  const auto sound = MakeSound("cavitating_jet", 8e5);
  // Rayleigh: tau = 0.9147 * 1e-4 m * (1000 / 106972)^(1/2) = 8.844 us, f_c = 17.996 kHz
  const double fall = Excess(*sound, 8e5, 1e4) / Excess(*sound, 8e5, 10);
  EXPECT_NEAR(fall, 1 / (1 + (10 / 17.996) * (10 / 17.996)), 1e-4);
  EXPECT_GT(10 * std::log10(fall), -1.2);
}

TEST(CavitatingJet, PowerGrowsAsTheSquareOfTheDistanceToInception) {
  // eps_c Q (1 - sigma/0.6), sigma = 106972 / dP: 0.2139 at 5 bar, 0.1337 at 8 bar
  for (const auto& [drop_Pa, sigma] : {std::pair{5e5, 0.213944}, std::pair{8e5, 0.133715}}) {
    const auto sound = MakeSound("cavitating_jet", drop_Pa);
    const double power = IntegrateLog([&](double f_Hz) { return Excess(*sound, drop_Pa, f_Hz); }, 1e-2, 1e9);
    const double rms = 2e-3 * kFlow_m3_s * (1 - sigma / 0.6);
    EXPECT_NEAR(power / (rms * rms), 1, 5e-5);  // tail beyond 1 GHz: 1.1e-5
  }
}

TEST(CavitatingJet, OvertakesTheJetWellAboveItsCorner) {
  const auto sound = MakeSound("cavitating_jet", 8e5);
  const double jet = MakeJet(kFlow_m3_s, kHole_m, 8e5, kDensity_kg_m3)->VolumeVelocityPsd(1e4);
  // by hand: jet (2e-3 Q)^2 / (1.198 * 3000) / (1 + 3.333^2)^1.25 = (2e-3 Q)^2 * 1.230e-5 s,
  // cavities (2e-3 Q)^2 * 0.7771^2 * 2 / (pi * 17996) / 1.3088 = (2e-3 Q)^2 * 1.632e-5 s
  EXPECT_NEAR(sound->VolumeVelocityPsd(1e4) / jet, 1 + 1.632 / 1.230, 0.005);
}

TEST(SlitWhistle, StandsAtTheStrouhalFrequencyOfItsEdges) {
  // U = (2 * 3.2e5 / 1000)^(1/2) = 25.298 m/s, f_0 = 0.25 U / 4 mm = 1581.1 Hz; s = 100 / 2.3548 Hz
  const auto sound = MakeSound("slit_whistle", 3.2e5);
  const double first = Excess(*sound, 3.2e5, 1581.14);
  const double rms = 2e-3 * kFlow_m3_s;
  EXPECT_NEAR(first / (rms * rms) * 42.466 * 2.506628, 1, 1e-4);
  EXPECT_NEAR(Excess(*sound, 3.2e5, 1631.14) / first, 0.5, 1e-4);
  EXPECT_NEAR(Excess(*sound, 3.2e5, 1531.14) / first, 0.5, 1e-4);
  // twice the speed, twice the frequency
  EXPECT_NEAR(Excess(*MakeSound("slit_whistle", 12.8e5), 12.8e5, 3162.28) / first, 1, 1e-4);
}

TEST(SlitWhistle, HarmonicsFallByTheirStepAndEnd) {
  const auto sound = MakeSound("slit_whistle", 3.2e5);
  const double f_0 = 1581.139;
  EXPECT_NEAR(Excess(*sound, 3.2e5, 2 * f_0) / Excess(*sound, 3.2e5, f_0), 0.1, 1e-6);
  EXPECT_NEAR(Excess(*sound, 3.2e5, 3 * f_0) / Excess(*sound, 3.2e5, f_0), 0.01, 1e-6);
  EXPECT_EQ(Excess(*sound, 3.2e5, 4 * f_0), 0);
  const auto single = MakeSound("slit_whistle", 3.2e5, {{"harmonics", 1.0}});
  EXPECT_EQ(Excess(*single, 3.2e5, 2 * f_0), 0);
}

TEST(SlitWhistle, LinesCarryThePowerTheyAreAskedFor) {
  const auto sound = MakeSound("slit_whistle", 3.2e5, {{"bandwidth_Hz", 50.0}, {"harmonic_step_dB", -3.0}});
  const double power = IntegrateLog([&](double f_Hz) { return Excess(*sound, 3.2e5, f_Hz); }, 1, 1e5, 40000);
  const double rms = 2e-3 * kFlow_m3_s;
  EXPECT_NEAR(power / (rms * rms), 1 + 0.501187 + 0.251189, 1e-5);
}

}  // namespace
}  // namespace piperun::acoustics
