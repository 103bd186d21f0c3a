#include "scenarios/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

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
        "mav0/hydrophone0/sensor.yaml", "mav0/marker0/data.csv", "mav0/marker0/sensor.yaml",
        "mav0/state_groundtruth_estimate0/data.csv", "truth/ball.csv", "truth/leaks.csv",
        "estimates/ekf/track.csv", "estimates/ekf/trajectory.tum", "estimates/ekf/leaks.csv"}) {
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
  EXPECT_EQ(WithoutTiming(FileText(Folder() / "run.json")),
            WithoutTiming(FileText(other / "run" / "run.json")));
}

TEST_F(SmallRun, ReplayGivesTheSameBitsAsTheLoop) {
  const TemporaryFolder other;
  ReplayOptions options;
  options.run_folder = Folder();
  options.out = other / "replay";
  const RunResult replayed = Replay(options);
  for (const char* name :
       {"estimates/ekf/track.csv", "estimates/ekf/trajectory.tum", "estimates/ekf/leaks.csv",
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
  more.insert(
      more.find("sensors:\n") + 9,
      "  a_second_imu: {kind: imu, rate_Hz: 333, gyro: {noise_deg_s_sqrtHz: 0.1}}\n"
      "  looks_far_ahead: {kind: imu, rate_Hz: 1, sampling: {jitter_s: 0.45}}\n"
      "  thermometer: {kind: temperature, offset_sd_K: 0.5, noise_sd_K: 0.1}\n"
      "  gates: {kind: marker, survey_sd_m: 0.1, receivers: [{pipe: P1, s_m: 3}, {pipe: P1, s_m: 5}]}\n"
      "  wall_port: {kind: pressure, port_mm: [30, 0, 0], dynamic: sphere, noise_sd_Pa: 3}\n");
  for (const std::string& variant : {without, reordered, more}) {
    const TemporaryFolder other;
    RunInto(ParseScenario(variant, "variant.yaml"), other / "run");
    for (const char* name :
         {"mav0/imu0/data.csv", "mav0/pressure0/data.csv", "mav0/hydrophone0/audio.wav", "mav0/mag0/data.csv",
          "mav0/temperature0/data.csv", "mav0/marker0/data.csv", "truth/ball.csv"}) {
      if (!fs::exists(other / "run" / name)) continue;  // the removed one
      EXPECT_TRUE(FileText(Folder() / name) == FileText(other / "run" / name)) << name;
    }
  }
}

TEST_F(SmallRun, AFilterHearsItsHydrophoneByWhateverNameItGoes) {
  // the name decides the channel's number and its noise
  std::string text = kSmallScenario;
  text.replace(text.find("hydrophone0"), 11, "z_hydrophone");
  const TemporaryFolder other;
  for (const RunResult& result : {*result_, RunInto(ParseScenario(text, "renamed.yaml"), other / "run")}) {
    const Json leaks = Json::parse(result.json)["estimators"]["ekf"]["leaks"];
    ASSERT_EQ(leaks.size(), 1U);
    EXPECT_EQ(leaks[0]["match"], "L1");
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

/// Rows of a CSV file as numbers; what is no number becomes 0.
std::vector<std::vector<double>> ReadRows(const fs::path& path) {
  std::vector<std::vector<double>> rows;
  std::stringstream text(FileText(path));
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::stringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');)
      rows.back().push_back(std::strtod(field.c_str(), nullptr));
  }
  return rows;
}

constexpr char kMounted[] =
    "sensors.imu0={kind: imu, rate_Hz: 400, lever_arm_m: [0.01, 0.002, -0.003], mounting_deg: [0, 0, 90], "
    "gyro: {bias_deg_s: [1, 2, 3]}, accel: {bias_m_s2: [0.01, 0.02, 0.03]}}";

TEST(Run, GroundTruthIsThatOfTheImuWhereItIsMounted) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario({kMounted, "mission.time_limit_s=4"}), folder / "run");
  const auto ball = ReadRows(folder / "run/truth/ball.csv");
  const auto imu = ReadRows(folder / "run/mav0/state_groundtruth_estimate0/data.csv");
  ASSERT_EQ(ball.size(), imu.size());
  const Vector3d lever(0.01, 0.002, -0.003);
  const Quaterniond q_BS = ExpSO3({0, 0, M_PI / 2});
  for (std::size_t i = 0; i < ball.size(); i += 50) {
    const auto& b = ball[i];
    const auto& s = imu[i];
    const Quaterniond q_WB(b[7], b[8], b[9], b[10]);
    const Vector3d p_WS = Vector3d(b[4], b[5], b[6]) + q_WB * lever;
    EXPECT_LT((Vector3d(s[1], s[2], s[3]) - p_WS).norm(), 1e-12);
    EXPECT_LT(LogSO3(Quaterniond(s[4], s[5], s[6], s[7]).conjugate() * (q_WB * q_BS)).norm(), 1e-9);
    EXPECT_LT((Vector3d(s[11], s[12], s[13]) - Vector3d(1, 2, 3) * M_PI / 180).norm(), 1e-12);
    EXPECT_LT((Vector3d(s[14], s[15], s[16]) - Vector3d(0.01, 0.02, 0.03)).norm(), 1e-12);
  }
}

TEST(Run, AFilterKnowsHowItsImuIsMounted) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(
      MakeSmallScenario({"sensors.imu0.lever_arm_m=[0.002, 0, 0]", "sensors.imu0.mounting_deg=[0, 0, 90]",
                         "sensors.mag0.mounting_deg=[0, 0, 90]", "estimators.ekf.locator={kind: none}"}),
      folder / "run");
  ASSERT_TRUE(result.estimators[0].causal);
  EXPECT_LT(result.estimators[0].causal->attitude_rmse_deg, 5);
  EXPECT_LT(std::abs(result.estimators[0].causal->chainage_final_error_m), 0.05);
}

TEST(Run, ARobotClockBehindTrueTimeLosesNothingOfTheTrack) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario({"ball={clock_offset_s: -500}", "mission.time_limit_s=4"}), folder / "run");
  const auto track = ReadRows(folder / "run/estimates/ekf/track.csv");
  ASSERT_GT(track.size(), 60u);  // 20 a second, but for the alignment
  EXPECT_LT(track.front()[0], -499e9);
  EXPECT_LT(track.front()[1], 0.1) << "the track begins at the launch";
}

TEST(Run, TellsTheFilterThePlannedLaunchNotTheDrawnOne) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario({"mission.lateral_sd_mm=30", "mission.time_limit_s=1"}), folder / "run");
  EXPECT_NE(FileText(folder / "run/estimator_input.yaml").find("p_W_m: [0, 0, -0.045]"), std::string::npos);
}

TEST(Run, ALeakTheBallNeverReachesHasNoPassage) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(MakeSmallScenario({"mission.time_limit_s=2"}), folder / "run");
  EXPECT_FALSE(result.leaks[0].t_cpa_ns);
  EXPECT_FALSE(result.leaks[0].snr_dB);
  ReplayOptions options;
  options.run_folder = folder / "run";
  options.out = folder / "replay";
  const RunResult replayed = Replay(options);
  EXPECT_EQ(replayed.status, "time_limit");
  EXPECT_EQ(replayed.route_length_m, result.route_length_m);
  EXPECT_EQ(replayed.duration_s, 2);
}

TEST(Run, AFilterWithoutItsSensorsIsRefused) {
  const TemporaryFolder folder;
  for (const char* left : {"sensors={mag0: {kind: magnetometer}}", "sensors={imu0: {kind: imu}}"}) {
    EXPECT_THROW(RunInto(MakeSmallScenario({left}), folder / "run"), InputError) << left;
  }
  EXPECT_NO_THROW(
      RunInto(MakeSmallScenario({"sensors={imu0: {kind: imu}}", "mission.time_limit_s=1",
                                 "estimators={ekf: {kind: quaternion_ekf, locator: {kind: none}}}"}),
              folder / "run"));
}

TEST(Run, KeepsTheDataOfABallThatStops) {
  const TemporaryFolder folder;
  const RunResult result = RunInto(
      MakeSmallScenario({"flow.inlet_L_s=0.1", "mission.stuck_after_s=5", "leaks=[]"}), folder / "run");
  EXPECT_EQ(result.status, "ball_stuck");
  EXPECT_EQ(Json::parse(FileText(folder / "run" / "run.json"))["status"], "ball_stuck");
  EXPECT_GT(fs::file_size(folder / "run" / "mav0/imu0/data.csv"), 10000u);
}

TEST(Run, ReplayRefusesToWriteOverWhatItReads) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario({"mission.time_limit_s=1"}), folder / "run");
  ReplayOptions options;
  options.run_folder = folder / "run";
  options.force = true;
  for (const char* out : {"run", "run/inside", "../"}) {
    options.out = folder / out;
    EXPECT_THROW(Replay(options), InputError) << out;
  }
  EXPECT_TRUE(fs::exists(folder / "run/mav0/imu0/data.csv"));
}

TEST(Run, ReplayRefusesADamagedRecord) {
  const TemporaryFolder folder;
  const auto replay_with = [&](const std::string& file,
                               const std::function<std::string(const std::string&)>& damage) {
    RunOptions options;
    options.out = folder / "run";
    options.force = true;
    scenarios::Run(MakeSmallScenario({"mission.time_limit_s=2"}), options);
    WriteTextFile(options.out / file, damage(FileText(options.out / file)));
    ReplayOptions replay;
    replay.run_folder = options.out;
    replay.out = folder / "replay";
    Replay(replay);
  };
  const auto cut = [](const std::string& text) { return text.substr(0, text.size() - 7); };
  const auto header_only = [](const std::string& text) { return text.substr(0, text.find('\n') + 1); };
  const auto no_header = [](const std::string& text) { return text.substr(text.find('\n') + 1); };
  const auto first_row_twice = [](const std::string& text) {
    const std::size_t row = text.find('\n') + 1, next = text.find('\n', row) + 1;
    return text.substr(0, next) + text.substr(row);
  };
  for (const auto& damage : std::vector<std::function<std::string(const std::string&)>>{
           cut, header_only, no_header, first_row_twice}) {
    EXPECT_THROW(replay_with("mav0/imu0/data.csv", damage), InputError);
  }
  EXPECT_THROW(
      replay_with("mav0/hydrophone0/audio.wav", [](const std::string& wav) { return wav.substr(0, 60'000); }),
      InputError);
  const auto without = [](const std::string& key) {
    return [key](const std::string& yaml) {
      const std::size_t at = yaml.find(key);
      return yaml.substr(0, at) + yaml.substr(yaml.find('\n', at) + 1);
    };
  };
  EXPECT_THROW(replay_with("mav0/hydrophone0/sensor.yaml", without("scale_Pa")), InputError);
  EXPECT_THROW(replay_with("mav0/hydrophone0/sensor.yaml",
                           [](const std::string&) { return std::string("schema: x\n"); }),
               InputError);
  EXPECT_FALSE(fs::exists(folder / "replay"));
}

TEST(Run, RefusesNamesThatWouldBreakItsFiles) {
  const TemporaryFolder folder;
  EXPECT_THROW(
      RunInto(MakeSmallScenario({"sensors.state_groundtruth_estimate0={kind: imu}"}), folder / "run"),
      InputError);
  EXPECT_THROW(RunInto(MakeSmallScenario({"leaks.L1.id='a,b'"}), folder / "run"), InputError);
  EXPECT_FALSE(fs::exists(folder / "run"));
}

TEST(Run, RefusesExpectationsThatSayNothing) {
  EXPECT_THROW(MakeSmallScenario({"expect=[{path: /status}]"}), InputError);
  EXPECT_THROW(MakeSmallScenario({"expect=[{path: status, equals: ok}]"}), InputError);
  EXPECT_THROW(MakeSmallScenario({"expect=[{path: /a, min: 1, max: 0}]"}), InputError);
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
