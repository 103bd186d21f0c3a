#include "scenarios/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Everything in run.json but how long it took.
Json WithoutTiming(const std::string& text) {
  Json json = Json::parse(text);
  json.erase("wall_s");
  json.erase("realtime_factor");
  return json;
}

std::vector<std::string> FilesBelow(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class SmallRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    result_ = new RunResult(RunInto(MakeSmallScenario(), *folder_ / "run"));
  }
  static void TearDownTestSuite() {
    delete result_;
    delete folder_;
  }
  static fs::path Folder() { return *folder_ / "run"; }
  static TemporaryFolder* folder_;
  static RunResult* result_;
};
TemporaryFolder* SmallRun::folder_ = nullptr;
RunResult* SmallRun::result_ = nullptr;

TEST_F(SmallRun, LeavesACompleteRunFolder) {
  EXPECT_EQ(result_->status, "ok");
  const std::vector<std::string> files = FilesBelow(Folder());
  for (const char* name :
       {"run.json", "scenario.yaml", "estimator_input.yaml", "mav0/imu0/data.csv", "mav0/imu0/sensor.yaml",
        "mav0/mag0/data.csv", "mav0/pressure0/data.csv", "mav0/hydrophone0/audio.wav",
        "mav0/hydrophone0/sensor.yaml", "mav0/state_groundtruth_estimate0/data.csv", "truth/ball.csv",
        "truth/leaks.csv", "estimates/ekf/track.csv", "estimates/ekf/trajectory.tum", "estimates/ekf/leaks.csv"}) {
    EXPECT_TRUE(std::binary_search(files.begin(), files.end(), name)) << name;
  }
  const Json json = Json::parse(FileText(Folder() / "run.json"));
  EXPECT_EQ(json["hash"].size(), files.size() - 1);
  EXPECT_EQ(json["route"]["pipes"], Json::array({"P1"}));
  EXPECT_NEAR(json["route"]["length_m"].get<double>(), 6, 1e-12);
  // only the finished folder is left
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_->path()), fs::directory_iterator{}), 1);
}

TEST_F(SmallRun, FindsItsLeak) {
  const auto& leaks = result_->estimators[0].leaks;
  ASSERT_EQ(leaks.leaks.size(), 1u);
  EXPECT_EQ(leaks.leaks[0].match, "L1");
  EXPECT_LT(std::abs(*leaks.leaks[0].error_m), 0.1);
}

TEST_F(SmallRun, IsRewrittenByteForByteFromItsOwnScenario) {
  const Scenario again = LoadScenario((Folder() / "scenario.yaml").string());
  const TemporaryFolder other;
  RunInto(again, other / "run");
  const std::vector<std::string> files = FilesBelow(Folder());
  ASSERT_EQ(FilesBelow(other / "run"), files);
  for (const std::string& name : files) {
    if (name == "run.json") continue;
    EXPECT_TRUE(FileText(Folder() / name) == FileText(other / "run" / name)) << name;
  }
  EXPECT_EQ(WithoutTiming(FileText(Folder() / "run.json")), WithoutTiming(FileText(other / "run" / "run.json")));
}

TEST_F(SmallRun, ReplayGivesTheSameBitsAsTheLoop) {
  const TemporaryFolder other;
  ReplayOptions options;
  options.run_folder = Folder();
  options.out = other / "replay";
  const RunResult replayed = Replay(options);
  for (const char* name : {"estimates/ekf/track.csv", "estimates/ekf/trajectory.tum", "estimates/ekf/leaks.csv",
                           "estimates/thesis/track.csv", "estimates/thesis/leaks.csv"}) {
    EXPECT_TRUE(FileText(Folder() / name) == FileText(other / "replay" / name)) << name;
  }
  EXPECT_EQ(Json::parse(replayed.json)["estimators"], Json::parse(result_->json)["estimators"]);
}

TEST_F(SmallRun, OtherChannelsDoNotChangeWhenSensorsComeGoOrMove) {
  const std::string text = kSmallScenario;
  const std::string mag = "  mag0: {kind: magnetometer, rate_Hz: 50, noise_sd_uT: 0.3}\n";
  const std::size_t at = text.find(mag);
  ASSERT_NE(at, std::string::npos);
  const std::string without = text.substr(0, at) + text.substr(at + mag.size());
  std::string reordered = without;
  reordered.insert(reordered.find("sensors:\n") + 9, mag);
  std::string more = text;
  more.insert(more.find("sensors:\n") + 9, "  a_second_imu: {kind: imu, rate_Hz: 333, gyro: {noise_deg_s_sqrtHz: 0.1}}\n");
  for (const std::string& variant : {without, reordered, more}) {
    const TemporaryFolder other;
    RunInto(ParseScenario(variant, "variant.yaml"), other / "run");
    for (const char* name : {"mav0/imu0/data.csv", "mav0/pressure0/data.csv", "mav0/hydrophone0/audio.wav",
                             "mav0/mag0/data.csv", "truth/ball.csv"}) {
      if (!fs::exists(other / "run" / name)) continue;  // the removed one
      EXPECT_TRUE(FileText(Folder() / name) == FileText(other / "run" / name)) << name;
    }
  }
}

TEST_F(SmallRun, AnotherRunIndexDrawsOtherNoiseOverTheSameMotion) {
  const TemporaryFolder other;
  RunInto(MakeSmallScenario({"run=1"}), other / "run");
  EXPECT_TRUE(FileText(Folder() / "truth/ball.csv") == FileText(other / "run" / "truth/ball.csv"));
  EXPECT_FALSE(FileText(Folder() / "mav0/imu0/data.csv") == FileText(other / "run" / "mav0/imu0/data.csv"));
  EXPECT_FALSE(FileText(Folder() / "mav0/hydrophone0/audio.wav") ==
               FileText(other / "run" / "mav0/hydrophone0/audio.wav"));
}

TEST(Run, KeepsTheDataOfABallThatStops) {
  const TemporaryFolder folder;
  const RunResult result =
      RunInto(MakeSmallScenario({"flow.inlet_L_s=0.1", "mission.stuck_after_s=5", "leaks=[]"}), folder / "run");
  EXPECT_EQ(result.status, "ball_stuck");
  EXPECT_EQ(Json::parse(FileText(folder / "run" / "run.json"))["status"], "ball_stuck");
  EXPECT_GT(fs::file_size(folder / "run" / "mav0/imu0/data.csv"), 10000u);
}

TEST(Run, EndsAtTheTimeLimit) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(MakeSmallScenario({"mission.time_limit_s=2"}), folder / "run");
  EXPECT_EQ(result.status, "time_limit");
  EXPECT_DOUBLE_EQ(result.duration_s, 2);
}

TEST(Run, LeavesNothingBehindWhenInterrupted) {
  const TemporaryFolder folder;
  const std::atomic<bool> stop{true};
  RunOptions options;
  options.out = folder / "run";
  options.stop = &stop;
  EXPECT_THROW(scenarios::Run(MakeSmallScenario(), options), Interrupted);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Run, RefusesAnExistingFolderUnlessForced) {
  const TemporaryFolder folder;
  const Scenario scenario = MakeSmallScenario({"mission.time_limit_s=1"});
  RunOptions options;
  options.out = folder / "run";
  scenarios::Run(scenario, options);
  EXPECT_THROW(scenarios::Run(scenario, options), InputError);
  options.force = true;
  EXPECT_NO_THROW(scenarios::Run(scenario, options));
  fs::create_directory(folder / "precious");
  options.out = folder / "precious";  // no run folder: --force must not delete it
  EXPECT_THROW(scenarios::Run(scenario, options), InputError);
  EXPECT_TRUE(fs::exists(folder / "precious"));
}

}  // namespace
}  // namespace piperun::scenarios
