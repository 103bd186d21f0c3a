#include <gtest/gtest.h>

#include <cmath>

#include "acoustics/level.h"
#include "tests/acoustics/scenes.h"
#include "tests/acoustics/statistics.h"
#include "tests/support/set_params.h"

namespace piperun::acoustics {
namespace {

constexpr double kLitrePerMinute = 1e-3 / 60;

double Rms(const LeakSound& sound) {
  const auto psd = [&](double f_Hz) { return sound.VolumeVelocityPsd(f_Hz); };
  return std::sqrt(IntegrateLog(psd, 1e-3, 1e10, 20000));
}

TEST(TurbulentJet, IntegralOfTheSpectrumIsTheFluctuationSquared) {
  EXPECT_NEAR(Rms(*MakeJet(kLitrePerMinute, 1e-3)) / (2e-3 * kLitrePerMinute), 1, 1e-6);
  EXPECT_NEAR(Rms(*MakeJet(7 * kLitrePerMinute, 4e-3, 6e5)) / (2e-3 * 7 * kLitrePerMinute), 1, 1e-6);
}

TEST(TurbulentJet, CornerFrequencyFollowsTheTableOfHolesAndPressures) {
  // fc = 0.15 U / d in kHz; at the corner the spectrum is 2^-1.25 of its plateau
  struct Row {
    double drop_bar, hole_mm, corner_kHz;
  };
  for (const Row& row : {Row{1, 1, 2.1}, Row{1, 4, .53}, Row{3, 1, 3.7}, Row{3, 2, 1.84}, Row{5, 2, 2.37},
                         Row{5, 8, .59}, Row{8, 0.5, 12}}) {
    const auto jet = MakeJet(kLitrePerMinute, row.hole_mm * 1e-3, row.drop_bar * 1e5);
    const double fall = jet->VolumeVelocityPsd(row.corner_kHz * 1e3) / jet->VolumeVelocityPsd(0);
    EXPECT_NEAR(fall, std::pow(2, -1.25), 0.02) << row.drop_bar << " bar, " << row.hole_mm << " mm";
  }
}

TEST(TurbulentJet, TailFallsBy25DecibelsPerDecade) {
  const auto jet = MakeJet(kLitrePerMinute, 2e-3);
  const double fall = jet->VolumeVelocityPsd(1e6) / jet->VolumeVelocityPsd(1e5);
  EXPECT_NEAR(10 * std::log10(fall), -25, 0.02);
}

TEST(TurbulentJet, LevelInThePipeFollowsTheTableOfMains) {
  // broadband dB re 1 uPa beside a leak of 0.1, 1 and 10 L/min, printed to a decibel
  struct Row {
    double mean_radius_m, wall_m, young_Pa;
    double level_dB[3];
  };
  for (const Row& row : {Row{.0775, .0075, 3.5e9, {92, 112, 132}}, Row{.082, .006, 165e9, {100, 120, 140}},
                         Row{.1594, .0072, 165e9, {88, 108, 128}}, Row{.302, .008, 207e9, {76, 96, 116}}}) {
    const PipeWave wave = CalcPipeWave(2 * row.mean_radius_m - row.wall_m, row.wall_m,
                                       MakeWall(row.young_Pa, 0.02), MakeWater10C());
    double flow = 0.1 * kLitrePerMinute;
    for (const double level_dB : row.level_dB) {
      const double pressure_Pa = wave.impedance_Pa_s_m3 / 2 * Rms(*MakeJet(flow, 1.2e-3));
      EXPECT_NEAR(CalcLevel_dB(pressure_Pa * pressure_Pa), level_dB, 0.52);
      flow *= 10;
    }
  }
}

TEST(TurbulentJet, DipoleExponentsGivePowerGrowingAsFlowTimesDropToTheTwoAndAHalf) {
  const auto& kind = piperun::testing::FindKind(LeakSoundKinds(), "turbulent_jet");
  const auto params =
      piperun::testing::MakeParamsOf(kind, {{"flow_exponent", -0.5}, {"pressure_exponent", 1.25}});
  const auto power = [&](double flow, double drop_Pa) {
    const double rms = Rms(*kind.make(*params, 2e-3, {flow, drop_Pa}, 1000));
    return rms * rms;
  };
  // 1e-6: the integral begins at 1 mHz
  EXPECT_NEAR(power(2e-5, 2e5) / power(1e-5, 2e5) / 2, 1, 1e-6);
  EXPECT_NEAR(power(1e-5, 8e5) / power(1e-5, 2e5) / 32, 1, 1e-6);
}

TEST(TurbulentJet, WithoutOutflowThereIsNoSound) {
  EXPECT_EQ(MakeJet(0, 2e-3, 3e5)->VolumeVelocityPsd(1000), 0);
  EXPECT_EQ(MakeJet(1e-5, 2e-3, 0)->VolumeVelocityPsd(1000), 0);
  EXPECT_EQ(MakeJet(-1e-5, 2e-3, -3e5)->VolumeVelocityPsd(0), 0);
}

}  // namespace
}  // namespace piperun::acoustics
