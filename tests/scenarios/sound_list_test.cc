#include "scenarios/sound_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "scenarios/assemble.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

Scenario WithSounds(const std::string& entries, const std::vector<std::string>& set = {}) {
  return ParseScenario(std::string(kSmallScenario) + "sounds:\n" + entries, "small.yaml", set);
}

constexpr char kAll[] =
    R"(  - {id: T1, pipe: P1, s_m: 2, kind: draw_off, flow_L_s: 0.1, opening_diameter_mm: 5, on_s: 3, off_s: 9}
  - {id: V1, pipe: P1, s_m: 5, kind: throttled_valve, pressure_drop_bar: 0.5}
  - {id: G1, pipe: P1, s_m: 4, kind: gas_pocket, length_m: 0.5, loss_dB_m: 6}
  - {id: S1, node: A, kind: pump, blades: 6, speed_rpm: 1480}
  - {id: H1, node: B, kind: mains_hum}
)";

struct Refusal {
  std::string key, problem;
};

Refusal Refused(const Scenario& scenario) {
  try {
    Assemble(scenario);
  } catch (const InputError& e) {
    return {e.key_path(), e.problem()};
  }
  return {};
}

Refusal Refused(const std::string& entry) { return Refused(WithSounds("  - " + entry + "\n")); }

TEST(SoundList, SourcesStandBehindTheLeaksWithTheirRole) {
  const auto assembly = Assemble(WithSounds(kAll));
  const auto& leaks = assembly->scene.leaks;
  ASSERT_EQ(leaks.size(), 4U);
  EXPECT_EQ(leaks[0].role, acoustics::Role::kLeak);
  EXPECT_EQ(leaks[1].role, acoustics::Role::kDrawOff);
  EXPECT_EQ(leaks[2].role, acoustics::Role::kValve);
  EXPECT_EQ(leaks[3].role, acoustics::Role::kGasPocket);
  EXPECT_EQ(leaks[1].times.on_s, 3);
  EXPECT_EQ(leaks[1].times.off_s, 9);
  EXPECT_TRUE(std::isinf(leaks[2].times.off_s));
  const acoustics::LocalLoss& loss = assembly->scene.network.pipes[0].local_losses.at(0);
  EXPECT_DOUBLE_EQ(loss.s_begin_m, 3.75);
  EXPECT_DOUBLE_EQ(loss.s_end_m, 4.25);
  EXPECT_NEAR(20 * std::log10(std::exp(loss.loss_Np_m)), 6, 1e-12);
  ASSERT_EQ(assembly->scene.tones.size(), 2U);
  EXPECT_EQ(assembly->scene.tones[0].s_m, 0);
  EXPECT_DOUBLE_EQ(assembly->scene.tones[0].tones[0].f_Hz, 148);
  EXPECT_EQ(assembly->scene.tones[1].s_m, 6);
}

TEST(SoundList, AValvesFlowIsThatOfTheHydraulics) {
  const auto assembly = Assemble(WithSounds("  - {id: V, pipe: P1, s_m: 5, kind: throttled_valve}\n"));
  const LeakState& leak = assembly->pipeline->leak_states[0];
  const double flow_m3_s = 8.5e-3 - leak.flow_m3_s;  // behind the leak at 3.1 m
  const double drop_Pa = 1e5, rho = assembly->water.density_kg_m3;
  const double speed_m_s = std::sqrt(2 * drop_Pa / rho);
  const double corner_Hz = 0.15 * speed_m_s / std::sqrt(4 * flow_m3_s / (std::numbers::pi * speed_m_s));
  const double plateau = std::pow(2e-3 * flow_m3_s, 2) / (1.198140234735592 * corner_Hz);
  EXPECT_NEAR(assembly->scene.leaks[1].sound->VolumeVelocityPsd(0) / plateau, 1, 1e-9);
}

TEST(SoundList, WhatDoesNotFitIsRefusedWithItsKey) {
  const Refusal pipe = Refused("{id: T, pipe: P2, s_m: 2, kind: draw_off}");
  EXPECT_EQ(pipe.key, "sounds[0].pipe");
  EXPECT_NE(pipe.problem.find("did you mean 'P1'"), std::string::npos);
  EXPECT_EQ(Refused("{id: T, node: Q, kind: pump}").key, "sounds[0].node");
  EXPECT_EQ(Refused("{id: T, pipe: P1, node: A, kind: pump}").key, "sounds[0].pipe");
  EXPECT_EQ(Refused("{id: T, kind: pump}").key, "sounds[0].pipe");
  EXPECT_EQ(Refused("{id: T, pipe: P1, s_m: 7, kind: pump}").key, "sounds[0].s_m");
  EXPECT_EQ(Refused("{id: L1, pipe: P1, s_m: 2, kind: pump}").key, "sounds[0].id");
  EXPECT_EQ(Refused("{id: T, pipe: P1, s_m: 2, kind: pump, on_s: 5, off_s: 4}").key, "sounds[0].off_s");
  EXPECT_EQ(Refused("{id: T, pipe: P1, s_m: 5.5, kind: gas_pocket, length_m: 1.1}").key,
            "sounds[0].length_m");
  EXPECT_EQ(Refused("{id: T, pipe: P1, s_m: 2, kind: draw_off, flow_L_s: 50}").key, "sounds[0].flow_m3_s");
  EXPECT_EQ(Refused("{id: T, pipe: P1, s_m: 2, kind: pump, speed_rpm: 90000}").key,
            "sensors.hydrophone0.rate_Hz");
}

TEST(SoundList, ABandAboveHalfTheRateIsRefused) {
  const auto key = [](const std::vector<std::string>& set) { return Refused(MakeSmallScenario(set)).key; };
  EXPECT_EQ(key({"ambient.rolling.on=true", "ambient.rolling.low_Hz=8000", "ambient.rolling.high_Hz=9000"}),
            "ambient.rolling.low_Hz");
  EXPECT_EQ(key({"ambient.rolling.on=true", "ambient.rolling.low_Hz=900", "ambient.rolling.high_Hz=900"}),
            "ambient.rolling.high_Hz");
  EXPECT_EQ(key({"ambient.rolling.on=true"}), "");
}

bool Says(const std::vector<std::string>& notes, const std::string& what) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

TEST(SoundList, ADrawOffWithoutPressureIsSilentAndTheRunSaysSo) {
  const auto assembly = Assemble(WithSounds("  - {id: T, pipe: P1, s_m: 5, kind: draw_off}\n",
                                            {"leaks=[]", "flow.inlet_pressure_Pa=0"}));
  EXPECT_TRUE(Says(assembly->pipeline->notes, "sound 'T' is silent"));
  EXPECT_TRUE(assembly->scene.leaks.empty());
}

TEST(SoundList, ChangesNoBytesButTheHydrophones) {
  const TemporaryFolder folder;
  const std::vector<std::string> set{"estimators={}"};
  const RunResult without = RunInto(MakeSmallScenario(set), folder / "without");
  const RunResult with = RunInto(WithSounds(kAll, set), folder / "with");
  for (const char* file :
       {"mav0/imu0/data.csv", "mav0/mag0/data.csv", "mav0/pressure0/data.csv", "mav0/temperature0/data.csv",
        "mav0/marker0/data.csv", "truth/ball.csv", "truth/contacts.csv"}) {
    EXPECT_EQ(FileText(folder.path() / "with" / file), FileText(folder / "without" / file)) << file;
  }
  const char* audio = "mav0/hydrophone0/audio.wav";
  EXPECT_NE(FileText(folder / "with" / audio), FileText(folder / "without" / audio));
  ASSERT_EQ(with.leaks.size(), 1U);
  EXPECT_EQ(with.leaks[0].flow_m3_s, without.leaks[0].flow_m3_s);
  EXPECT_LT(*with.leaks[0].snr_dB, *without.leaks[0].snr_dB);  // to the leak the sounds are noise
}

TEST(SoundList, ARunAgainWritesTheSame) {
  const Scenario scenario = WithSounds(kAll);
  const std::string once = WriteScenario(scenario);
  EXPECT_EQ(WriteScenario(ParseScenario(once, "again.yaml")), once);
}

TEST(SoundList, SensorYamlCountsWhatDroppedOut) {
  const TemporaryFolder folder;
  Scenario scenario = ParseScenario(std::string(kSmallScenario), "small.yaml",
                                    {"estimators={}", "sensors.hydrophone0.faults.drop_outs_1_h=0",
                                     "sensors.hydrophone0.faults.drop_outs=[{begin_s: 1, end_s: 1.5}]"});
  RunInto(scenario, folder / "run");
  const std::string text = FileText(folder.path() / "run/mav0/hydrophone0/sensor.yaml");
  EXPECT_NE(text.find("dropped_samples: 8000"), std::string::npos);
}

}  // namespace
}  // namespace piperun::scenarios
