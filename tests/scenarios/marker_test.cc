#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/check.h"
#include "scenarios/assemble.h"
#include "scenarios/replay.h"
#include "scenarios/rest_record.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

/// The small scenario with `line` in place of its own marker.
Scenario ReplaceMarker(const std::string& line, const std::vector<std::string>& set = {}) {
  std::string text = kSmallScenario;
  const std::size_t begin = text.find("  marker0:"), end = text.find('\n', begin) + 1;
  text.replace(begin, end - begin, line);
  return ParseScenario(text, "small.yaml", set);
}

Scenario WithMarker(const std::string& marker, const std::vector<std::string>& set = {}) {
  return ReplaceMarker("  marker0: {kind: marker, " + marker + "}\n", set);
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
  EXPECT_EQ(Refused("receivers: [{pipe: P1, s_m: 3, cover_m: 3.1}]"), "sensors.marker0.receivers[0].cover_m");
  EXPECT_EQ(Refused("receivers: [{pipe: P1, s_m: 3, aside_m: -3}]"), "sensors.marker0.receivers[0].aside_m");
  EXPECT_EQ(Refused("receivers: [{id: A, pipe: P1, s_m: 3}, {id: A, pipe: P1, s_m: 4}]"),
            "sensors.marker0.receivers[1].id");
  EXPECT_EQ(Refused(kTwo), "none");
}

TEST(Marker, ARunIsItsReplayAndTheOtherChannelsAreAsWithoutIt) {
  const TemporaryFolder folder;
  RunInto(WithMarker(std::string("jitter_sd_s: 0.1, ") + kTwo), folder / "with");
  RunInto(ReplaceMarker(""), folder / "without");
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

/// Everything a run folder holds, in the order in which estimators get it.
std::vector<Measurement> ReadAll(const fs::path& run) {
  const EstimatorInput input = LoadEstimatorInput((run / "estimator_input.yaml").string());
  MeasurementLog log(run, input);
  std::vector<Measurement> all;
  while (const Measurement* m = log.Next()) {
    all.push_back(*m);
    if (auto* block = std::get_if<AudioBlock>(&all.back().value)) block->counts = {};
  }
  return all;
}

TEST(Marker, PassesComeBehindEverythingElseInTheOrderOfTheirStamps) {
  // 1 and 2 stand on either side of the pipe: they log one instant
  const TemporaryFolder folder;
  RunInto(WithMarker("receivers: [{pipe: P1, s_m: 5}, {pipe: P1, s_m: 2, aside_m: 1}, "
                     "{pipe: P1, s_m: 2, aside_m: -1}]"),
          folder / "run");
  const auto all = ReadAll(folder / "run");
  ASSERT_GT(all.size(), 1000U);
  std::vector<int> receivers;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(IsReadOutLater(all[i]), i + 3 >= all.size()) << i;
    if (const auto* pass = std::get_if<MarkerPass>(&all[i].value)) receivers.push_back(pass->receiver);
  }
  EXPECT_EQ(receivers, (std::vector<int>{1, 2, 0}));
  EXPECT_EQ(Stamp(all[all.size() - 3]), Stamp(all[all.size() - 2]));
  EXPECT_LT(Stamp(all.back()), Stamp(all[all.size() - 4]));
}

TEST(Marker, ALogWithoutPassesIsARecord) {
  const TemporaryFolder folder;
  RunInto(WithMarker("missed: 1, receivers: [{pipe: P1, s_m: 3}]", {"mission.time_limit_s=2"}),
          folder / "run");
  EXPECT_EQ(FileText(folder / "run/mav0/marker0/data.csv"),
            "#timestamp [ns],receiver [],x [m],y [m],z [m]\n");
  EXPECT_FALSE(ReadAll(folder / "run").empty());
}

TEST(Marker, ADamagedLogIsRefused) {
  const TemporaryFolder folder;
  RunInto(WithMarker("receivers: [{pipe: P1, s_m: 0}]", {"mission.time_limit_s=2"}), folder / "run");
  const std::string header = "#timestamp [ns],receiver [],x [m],y [m],z [m]\n";
  for (const char* rows : {"100,-1,1,2,3\n", "100,0.5,1,2,3\n", "100,1e300,1,2,3\n", "100,0,1,2\n",
                           "100,0,1,2,3\n99,0,1,2,3\n", "100,0,1,2,3"}) {
    WriteTextFile(folder / "run/mav0/marker0/data.csv", header + rows);
    EXPECT_THROW(ReadAll(folder / "run"), InputError) << rows;
  }
  WriteTextFile(folder / "run/mav0/marker0/data.csv", header + "100,0,1,2,3\n100,4,1,2,3\n");
  EXPECT_NO_THROW(ReadAll(folder / "run"));
}

/// Six metres to the east in two pipes, the first of `stated`; a receiver at the beginning of the second.
Scenario MakeTwoPipes(const std::string& stated) {
  std::string text = kSmallScenario;
  const auto replace = [&text](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  replace("    - {id: B,", "    - {id: M, position_m: [3, 0, 0]}\n    - {id: B,");
  replace("    - {id: P1, from: A, to: B, diameter_mm: 150, wall_thickness_mm: 7.5, material: pvc_u}\n",
          "    - {id: P1, from: A, to: M, diameter_mm: 150, wall_thickness_mm: 7.5, " + stated +
              "}\n    - {id: P2, from: M, to: B, diameter_mm: 150, wall_thickness_mm: 7.5}\n");
  replace("s_m: 3.1", "s_m: 2.1");
  replace("jitter_sd_s: 0.1, receivers: [{pipe: P1, s_m: 3, cover_m: 1}]",
          "receivers: [{pipe: P2, s_m: 0, cover_m: 1}]");
  return ParseScenario(text, "two_pipes.yaml");
}

/// When the ball came into the second pipe, by truth/ball.csv.
double FindEntry_s(const fs::path& run) {
  std::stringstream rows(FileText(run / "truth/ball.csv"));
  std::string row;
  while (std::getline(rows, row) && row.find(",P2,") == std::string::npos) {
  }
  return 1e-9 * std::strtod(row.c_str(), nullptr);
}

TEST(Marker, HearsTheBallOnceWhereTwoPipesMeetOrWereStretchedApart) {
  for (const char* stated : {"minor_loss: 0", "length_m: 9"}) {
    const TemporaryFolder folder;
    EXPECT_EQ(RunInto(MakeTwoPipes(stated), folder / "run").status, "ok");
    const auto all = ReadAll(folder / "run");
    ASSERT_FALSE(IsReadOutLater(all[all.size() - 2]));
    ASSERT_TRUE(IsReadOutLater(all.back()));
    EXPECT_EQ(std::get<MarkerPass>(all.back().value).p_W, Vector3d(3, 0, 1));
    // rows of the truth are 10 ms apart
    EXPECT_NEAR(Seconds(Stamp(all.back())), FindEntry_s(folder / "run") - 0.005, 0.0055) << stated;
  }
}

TEST(Marker, RecordsAtRestLeaveItOut) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "small.yaml", kSmallScenario);
  const Scenario rest = LoadRestScenario((folder / "small.yaml").string(), {1, {}, {}});
  std::vector<std::string> names;
  for (const SensorEntry& entry : rest.sensors) names.push_back(entry.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"imu0", "mag0", "pressure0", "temperature0"}));
}

}  // namespace
}  // namespace piperun::scenarios
