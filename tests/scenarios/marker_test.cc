#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "scenarios/assemble.h"
#include "scenarios/replay_run.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

Scenario WithMarker(const std::string& marker, const std::vector<std::string>& set = {}) {
  std::string text = kSmallScenario;
  text.insert(text.find("sensors:\n") + 9, "  marker0: {kind: marker, " + marker + "}\n");
  return ParseScenario(text, "small.yaml", set);
}

constexpr char kTwo[] = "receivers: [{pipe: P1, s_m: 4, cover_m: 1.5}, {pipe: P1, s_m: 2.0001, aside_m: 2}]";

constexpr double kSpeed_m_s = 0.05;

/// What receivers on the small scenario's six metres of pipe log of a ball that passes at 0.05 m/s, in
/// `passes` runs that follow each other under other run indices.
std::vector<MarkerPass> Record(const std::string& marker, int runs = 1) {
  std::vector<MarkerPass> all;
  for (int run = 0; run < runs; ++run) {
    const auto assembly = Assemble(WithMarker(marker, {"run=" + std::to_string(run)}));
    const auto at = std::find(assembly->channel_names.begin(), assembly->channel_names.end(), "marker0");
    Channel& channel = *assembly->channels[static_cast<std::size_t>(at - assembly->channel_names.begin())];
    const Rate rate(100);
    sim::TruthWindow window(rate, 64);
    for (std::int64_t k = 0; k <= 12000; ++k) {
      sim::TruthState state;
      state.time = SampleTime(k, rate);
      state.pipe = 0;
      state.s_m = kSpeed_m_s * 0.01 * static_cast<double>(k);
      window.Push(state);
      while (channel.due() <= state.time) EXPECT_EQ(channel.Take(window), nullptr);
    }
    for (const Measurement& m : channel.ReadOut(window)) all.push_back(std::get<MarkerPass>(m.value));
  }
  return all;
}

TEST(Marker, LogsTheClosestApproachToEveryReceiver) {
  const auto log = Record(kTwo);
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0].receiver, 1);
  EXPECT_EQ(log[1].receiver, 0);
  // s / v; the small scenario's ball clock has no offset
  EXPECT_NEAR(Seconds(log[0].stamp), 40.002, 1e-6);
  EXPECT_NEAR(Seconds(log[1].stamp), 80, 1e-6);
  EXPECT_TRUE(log[0].p_W.isApprox(Vector3d(2.0001, 2, 1)));
  EXPECT_TRUE(log[1].p_W.isApprox(Vector3d(4, 0, 1.5)));
}

TEST(Marker, HearsNothingBeyondItsRange) {
  EXPECT_TRUE(Record("range_m: 0.9, receivers: [{pipe: P1, s_m: 3, cover_m: 1}]").empty());
}

TEST(Marker, ClocksAndJitterSpreadTheStamps) {
  constexpr int kRuns = 400;
  const auto log = Record("clock_offset_sd_s: 0.3, jitter_sd_s: 0.4, receivers: [{pipe: P1, s_m: 3}]", kRuns);
  ASSERT_EQ(log.size(), static_cast<std::size_t>(kRuns));
  double sum = 0, squares = 0;
  for (const MarkerPass& pass : log) {
    const double late_s = Seconds(pass.stamp) - 60;
    sum += late_s, squares += late_s * late_s;
  }
  // standard deviation 0.5: four of its own, 0.5/sqrt(2 n), and of the mean's
  EXPECT_NEAR(std::sqrt(squares / kRuns), 0.5, 4 * 0.5 / std::sqrt(2.0 * kRuns));
  EXPECT_NEAR(sum / kRuns, 0, 4 * 0.5 / std::sqrt(kRuns));
}

TEST(Marker, MissesAndInventsAsManyPassesAsAsked) {
  constexpr int kRuns = 400;
  const double passes =
      static_cast<double>(Record("missed: 0.3, receivers: [{pipe: P1, s_m: 3}]", kRuns).size());
  EXPECT_NEAR(passes, 0.7 * kRuns, 4 * std::sqrt(0.21 * kRuns));
  // 120 s at 60 an hour: 2 a run
  const double invented = static_cast<double>(
      Record("missed: 1, false_passes_1_h: 60, receivers: [{pipe: P1, s_m: 3}]", kRuns).size());
  EXPECT_NEAR(invented, 2 * kRuns, 4 * std::sqrt(2.0 * kRuns));
}

TEST(Marker, TheSurveyMayErrAndTheReceiverStaysWhereItIs) {
  const auto log = Record("survey_sd_m: 0.5, receivers: [{pipe: P1, s_m: 3}]", 100);
  double squares = 0;
  for (const MarkerPass& pass : log) {
    EXPECT_NEAR(Seconds(pass.stamp), 60, 1e-6);
    squares += (pass.p_W - Vector3d(3, 0, 1)).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / 300), 0.5, 4 * 0.5 / std::sqrt(600.0));
}

/// The key that is refused.
std::string Refused(const std::string& marker) {
  try {
    Assemble(WithMarker(marker));
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "none";
}

TEST(Marker, RefusesWithTheKeyOfWhatIsWrong) {
  EXPECT_EQ(Refused("receivers: []"), "sensors.marker0.receivers");
  EXPECT_EQ(Refused("receivers: [{pipe: P9, s_m: 3}]"), "sensors.marker0.receivers[0].pipe");
  EXPECT_EQ(Refused("receivers: [{pipe: P1, s_m: 3}, {pipe: P1, s_m: 6.5}]"),
            "sensors.marker0.receivers[1].s_m");
  EXPECT_EQ(Refused("range_m: -1, receivers: [{pipe: P1, s_m: 3}]"), "sensors.marker0.range_m");
  EXPECT_EQ(Refused("missed: 1.2, receivers: [{pipe: P1, s_m: 3}]"), "sensors.marker0.missed");
  EXPECT_EQ(Refused(kTwo), "none");
}

std::string FileText(const fs::path& path) { return ReadTextFile(path); }

TEST(Marker, ARunIsItsReplayAndTheOtherChannelsAreAsWithoutIt) {
  const TemporaryFolder folder;
  RunOptions options{};
  options.out = folder / "with";
  Run(WithMarker(std::string("jitter_sd_s: 0.1, ") + kTwo), options);
  options.out = folder / "without";
  Run(MakeSmallScenario(), options);
  ReplayOptions replay;
  replay.run_folder = folder / "with";
  replay.out = folder / "replay";
  Replay(replay);
  const std::string log = FileText(folder / "with" / "mav0/marker0/data.csv");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 3) << log;
  for (const char* name : {"mav0/imu0/data.csv", "mav0/hydrophone0/audio.wav", "mav0/mag0/data.csv",
                           "truth/ball.csv", "estimates/ekf/track.csv", "estimates/ekf/leaks.csv"}) {
    EXPECT_TRUE(FileText(folder / "with" / name) == FileText(folder / "without" / name)) << name;
  }
  for (const char* name : {"estimates/ekf/track.csv", "estimates/thesis/leaks.csv"}) {
    EXPECT_TRUE(FileText(folder / "with" / name) == FileText(folder / "replay" / name)) << name;
  }
}

}  // namespace
}  // namespace piperun::scenarios
