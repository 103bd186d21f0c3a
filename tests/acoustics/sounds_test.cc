#include "acoustics/sound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "acoustics/level.h"
#include "acoustics/listener_spectrum.h"
#include "acoustics/rolling.h"
#include "base/check.h"
#include "tests/acoustics/scenes.h"
#include "tests/acoustics/statistics.h"
#include "tests/support/set_params.h"

namespace piperun::acoustics {
namespace {

using testing::ParamValues;

constexpr double kPi = std::numbers::pi;

SoundSite MakeSite() { return {MakePvcWave(), MakeWater10C(), 0.01, 3e5}; }

SiteSound MakeSound(std::string_view name, const ParamValues& values = {},
                    const SoundSite& site = MakeSite()) {
  const SoundKind& kind = testing::FindKind(SoundKinds(), name);
  return kind.make(*testing::MakeParamsOf(kind, values), site);
}

std::string KeyRefused(std::string_view name, const ParamValues& values, const SoundSite& site = MakeSite()) {
  try {
    MakeSound(name, values, site);
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "";
}

/// Integral of a spectrum over all f > 0, by the trapezoidal rule over the logarithm of f.
double IntegratePsd(const LeakSound& sound) {
  constexpr int kCells = 20000;
  const double low = std::log(1e-5), step = (std::log(1e8) - low) / kCells;
  double sum = 0;
  for (int i = 0; i <= kCells; ++i) {
    const double f_Hz = std::exp(low + i * step);
    sum += f_Hz * sound.VolumeVelocityPsd(f_Hz);
  }
  return sum * step;
}

TEST(ThrottledValve, IsTheJetThatPassesTheFlowUnderTheDrop) {
  const double drop_Pa = 2e5, flow_m3_s = 0.004, rho = MakeWater10C().density_kg_m3;
  const SiteSound valve =
      MakeSound("throttled_valve", {{"pressure_drop_Pa", drop_Pa}, {"flow_m3_s", flow_m3_s}});
  EXPECT_EQ(valve.role, Role::kValve);
  const double speed_m_s = std::sqrt(2 * drop_Pa / rho);
  const double diameter_m = std::sqrt(4 * flow_m3_s / (kPi * speed_m_s));
  const double corner_Hz = 0.15 * speed_m_s / diameter_m;
  // (eps0 Q)^2 in all, 2^(-5/4) of the plateau at the corner
  EXPECT_NEAR(IntegratePsd(*valve.noise) / std::pow(2e-3 * flow_m3_s, 2), 1, 1e-4);
  EXPECT_NEAR(valve.noise->VolumeVelocityPsd(corner_Hz) / valve.noise->VolumeVelocityPsd(0),
              std::pow(2, -1.25), 1e-12);
}

TEST(ThrottledValve, TakesThePipesFlowAndIsSilentWithoutAny) {
  SoundSite site = MakeSite();
  const SiteSound valve = MakeSound("throttled_valve", {}, site);
  EXPECT_NEAR(IntegratePsd(*valve.noise) / std::pow(2e-3 * site.flow_m3_s, 2), 1, 1e-4);
  site.flow_m3_s = 0;
  EXPECT_EQ(MakeSound("throttled_valve", {}, site).noise, nullptr);
}

TEST(DrawOff, IsTheJetOfItsOpeningUnderThePipesPressure) {
  const SiteSound tap = MakeSound("draw_off", {{"flow_m3_s", 2e-4}, {"opening_diameter_m", 0.006}});
  EXPECT_EQ(tap.role, Role::kDrawOff);
  const auto leak = MakeJet(2e-4, 0.006, 3e5);
  for (const double f_Hz : {10.0, 600.0, 4000.0}) {
    EXPECT_DOUBLE_EQ(tap.noise->VolumeVelocityPsd(f_Hz), leak->VolumeVelocityPsd(f_Hz)) << f_Hz;
  }
}

TEST(DrawOff, DrawsNoMoreThanThePressureDrives) {
  const double most_m3_s = kPi / 4 * 25e-6 * std::sqrt(2 * 3e5 / MakeWater10C().density_kg_m3);
  EXPECT_EQ(KeyRefused("draw_off", {{"flow_m3_s", 1.001 * most_m3_s}}), "flow_m3_s");
  EXPECT_NE(MakeSound("draw_off", {{"flow_m3_s", 0.999 * most_m3_s}}).noise, nullptr);
}

TEST(DrawOff, IsSilentInAPipeWithoutPressure) {
  SoundSite site = MakeSite();
  site.gauge_pressure_Pa = 0;
  EXPECT_EQ(MakeSound("draw_off", {}, site).noise, nullptr);
}

TEST(GasPocket, BubblesOfOneSizeHaveThePowerOfTheirPulses) {
  const double radius_m = 1.5e-3, amplitude = 4e-4, damping = 0.08, per_s = 35;
  const SiteSound pocket = MakeSound("gas_pocket", {{"min_radius_m", radius_m},
                                                    {"max_radius_m", radius_m},
                                                    {"relative_amplitude", amplitude},
                                                    {"damping", damping},
                                                    {"bubble_rate_Hz", per_s}});
  // Campbell: the variance is N times the integral of q(t)^2, q = q_0 exp(-a t) sin(w t), taken step by step
  const double rho = MakeWater10C().density_kg_m3;
  const double w = std::sqrt(3 * 1.4 * (101325 + 3e5) / rho) / radius_m;
  const double q_0 = w * 4 * kPi * std::pow(radius_m, 3) * amplitude;
  const double dt_s = 1e-8;
  double energy = 0;
  for (double t_s = 0.5 * dt_s; t_s < 0.02; t_s += dt_s) {
    const double q = q_0 * std::exp(-0.5 * damping * w * t_s) * std::sin(w * t_s);
    energy += q * q * dt_s;
  }
  EXPECT_NEAR(IntegratePsd(*pocket.noise) / (per_s * energy), 1, 1e-3);
}

TEST(GasPocket, AMillimetreBubbleRingsAtMinnaertsFrequency) {
  SoundSite site = MakeSite();
  site.gauge_pressure_Pa = 0;
  const SiteSound pocket =
      MakeSound("gas_pocket", {{"min_radius_m", 1e-3}, {"max_radius_m", 1e-3}, {"damping", 0.01}}, site);
  double best_Hz = 0, best = 0;
  for (double f_Hz = 1000; f_Hz < 6000; f_Hz += 1) {
    const double psd = pocket.noise->VolumeVelocityPsd(f_Hz);
    if (psd > best) best = psd, best_Hz = f_Hz;
  }
  EXPECT_NEAR(best_Hz, 3260,
              25);  // 3.26 m/s over the radius in air-saturated fresh water at 1 atm (Leighton)
}

TEST(GasPocket, SoundLosesMoreOnItsWayThroughIt) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, 100, std::make_shared<FlatSound>(1e-12, 1, 8000));
  const auto level_dB = [&](double s_m) { return CalcLevel_dB(CalcLeakPsdAt(scene, 0, {0, s_m}, 500)); };
  const double before_dB = level_dB(104), behind_dB = level_dB(110), inside_dB = level_dB(106);
  const SiteSound pocket = MakeSound("gas_pocket", {{"length_m", 3.}, {"loss_dB_m", 4.}});
  scene.network.pipes[0].local_losses = {{105, 105 + pocket.loss_length_m, pocket.loss_Np_m}};
  EXPECT_NEAR(level_dB(104), before_dB, 1e-9);
  EXPECT_NEAR(level_dB(106), inside_dB - 4, 1e-9);
  EXPECT_NEAR(level_dB(110), behind_dB - 12, 1e-9);
}

TEST(GasPocket, IsHeardInTheRecordAsInTheSpectrum) {
  AcousticScene scene = MakeQuietScene(MakeIronWave());
  AddLeak(scene, 100, std::make_shared<FlatSound>(1e-14, 500, 4000));
  // behind: two pipes, part of the loss
  scene.network =
      MakeNetwork({{0, 1, kPipe_m, MakeIronWave()}, {1, 2, 50, MakeIronWave(), {{10, 20, 0.05}}}});
  const ListenerState listener{1, 17, 0, 0, kPvcBore_m / 2};
  ListenerSpectrum spectrum(scene, MakeNoiselessHydrophone(), 16, 500);
  std::vector<float> psd(500);
  spectrum.Calc(listener, psd);
  const double alpha = MakeIronWave().Attenuation_Np_m(1600);
  const double at_hole = std::pow(0.5 * MakeIronWave().impedance_Pa_s_m3, 2) * 1e-14;
  const double expected = at_hole * std::exp(-2 * (alpha * (kPipe_m - 100 + 17) + 7 * 0.05));
  EXPECT_NEAR(CalcLevel_dB(psd[100]) - CalcLevel_dB(expected), 0, 0.01);
}

TEST(Sound, CountsOnlyWhileItSounds) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  AddLeak(scene, 100, std::make_shared<FlatSound>(1e-12, 500, 4000));
  scene.leaks[0].times = {.on_s = 2, .off_s = 5, .ramp_s = 0.5};
  ListenerSpectrum spectrum(scene, MakeNoiselessHydrophone(), 16, 500);
  const auto power_at = [&](double t_s) {
    ListenerState listener{0, 103, 0, 0, kPvcBore_m / 2};
    listener.time = TrueTime(FromSeconds(t_s));
    std::vector<float> psd(500);
    spectrum.Calc(listener, psd);
    return static_cast<double>(psd[100]);
  };
  const double full = power_at(3.5);
  EXPECT_NEAR(full / CalcLeakPsdAt(scene, 0, {0, 103}, 1600), 1, 1e-3);
  EXPECT_LT(power_at(1.99) / full, 1e-6);
  EXPECT_NEAR(power_at(2.25) / full, 0.5, 1e-3);                          // halfway up in power
  EXPECT_NEAR(power_at(2.125) / full, 0.5 * (1 - std::sqrt(0.5)), 1e-3);  // a raised cosine
  EXPECT_NEAR(power_at(4.75) / full, 0.5, 1e-3);
  EXPECT_LT(power_at(5.01) / full, 1e-6);
}

TEST(Rolling, LevelGoesWithThirtyLogOfTheSpeed) {
  RollingParams params;
  params.on = true;
  const double at_1_dB = CalcLevel_dB(CalcRollingPsd(params, 1, 700));
  EXPECT_NEAR(CalcLevel_dB(CalcRollingPsd(params, 0.1, 700)), at_1_dB - 30, 1e-9);
  EXPECT_NEAR(CalcLevel_dB(CalcRollingPsd(params, 2, 700)), at_1_dB + 30 * std::log10(2), 1e-9);
  EXPECT_EQ(CalcRollingPsd(params, 0, 700), 0);
  params.low_Hz = 1, params.high_Hz = 1e6;  // ends far away: the level is that of the band
  EXPECT_NEAR(CalcLevel_dB(CalcRollingPsd(params, 1, 1000)), params.level_dB_re_1uPa2_Hz, 1e-4);
  EXPECT_NEAR(CalcLevel_dB(CalcRollingPsd(params, 1, 1e6)), params.level_dB_re_1uPa2_Hz - 3.0103, 1e-3);
}

TEST(Rolling, IsHeardOfAHardBallThatRolls) {
  const auto psd_at_800_Hz = [](bool on, bool soft, double speed_m_s) {
    AcousticScene scene = MakeQuietScene(MakePvcWave());
    scene.ambient.rolling.on = on;
    scene.ball.gives_way = soft;
    ListenerState listener{0, 100, 0, 0, kPvcBore_m / 2};
    listener.rolling_speed_m_s = speed_m_s;
    std::vector<float> psd(500);
    ListenerSpectrum(scene, MakeNoiselessHydrophone(), 16, 500).Calc(listener, psd);
    EXPECT_NEAR(psd[50], CalcBackgroundPsd(scene, listener, 0.005, 800), 1e-4 * psd[50] + 1e-20);
    return static_cast<double>(psd[50]);
  };
  const double silence = psd_at_800_Hz(false, false, 0.4);
  EXPECT_GT(psd_at_800_Hz(true, false, 0.4), 1e6 * silence);
  EXPECT_EQ(psd_at_800_Hz(true, true, 0.4), silence);   // soft
  EXPECT_EQ(psd_at_800_Hz(true, false, 0.0), silence);  // at rest, or afloat
}

}  // namespace
}  // namespace piperun::acoustics
