// Lost, repeated and saturated samples through the whole house, and records at rest.

#include <gtest/gtest.h>

#include <fstream>

#include "scenarios/rest_record.h"
#include "scenarios/run.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> Lines(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

RunResult ReplayInto(const fs::path& run, const fs::path& out) {
  ReplayOptions options;
  options.run_folder = run;
  options.out = out;
  return Replay(options);
}

const std::vector<std::string> kFaults{
    "sensors.imu0.sampling={loss_probability: 0.01, loss_length: 4, "
    "duplicate_probability: 0.02, jitter_s: 4e-4, stamp_jitter_s: 2e-4}",
    "sensors.imu0.gyro.range_rad_s=12", "ball.clock_drift_ppm=80"};

TEST(ImuFaults, LiveEqualsReplayWithLossesDuplicatesJitterAndSaturation) {
  const TemporaryFolder folder;
  const RunResult live = RunInto(MakeSmallScenario(kFaults), folder / "run");
  ASSERT_TRUE(fs::exists(folder / "run/mav0/imu0/flags.csv"));
  const RunResult again = ReplayInto(folder / "run", folder / "again");
  for (const char* name : {"ekf/track.csv", "ekf/leaks.csv", "thesis/track.csv"}) {
    EXPECT_EQ(FileText(folder / "run/estimates" / name), FileText(folder / "again/estimates" / name)) << name;
  }
  EXPECT_EQ(live.status, "ok");
}

TEST(ImuFaults, FlagsStandBesideTheSamplesTheyAreAbout) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario(kFaults), folder / "run");
  const auto data = Lines(folder / "run/mav0/imu0/data.csv"),
             flags = Lines(folder / "run/mav0/imu0/flags.csv");
  EXPECT_EQ(flags.front(), "#timestamp [ns],saturated [],duplicated []");
  std::map<std::string, std::size_t> row_of;
  std::vector<std::string> values{""};
  for (std::size_t i = 1; i < data.size(); ++i) {
    const auto comma = data[i].find(',');
    row_of[data[i].substr(0, comma)] = i;
    values.push_back(data[i].substr(comma + 1));
  }
  std::size_t saturated = 0, duplicated = 0;
  for (std::size_t i = 1; i < flags.size(); ++i) {
    const auto comma = flags[i].find(',');
    const auto found = row_of.find(flags[i].substr(0, comma));
    ASSERT_NE(found, row_of.end()) << flags[i];
    const std::string& value = values[found->second];
    const bool at_range =
        (',' + value).find(",12,") != std::string::npos || (',' + value).find(",-12,") != std::string::npos;
    if (flags[i].substr(comma + 1).starts_with("0,") == at_range) ADD_FAILURE() << flags[i] << " " << value;
    saturated += at_range;
    if (!flags[i].ends_with(",1")) continue;
    EXPECT_EQ(value, values[found->second - 1]);
    ++duplicated;
  }
  EXPECT_GT(saturated, 100U);
  EXPECT_GT(duplicated, 20U);
  // about 0.01 x 4 of the samples are missing
  const double taken = 400e-9 * std::stod(data.back().substr(0, data.back().find(',')));
  const double arrived = static_cast<double>(row_of.size()) / taken;
  EXPECT_LT(arrived, 0.98);
  EXPECT_GT(arrived, 0.94);
}

TEST(ImuFaults, AFlagForNoSampleIsRefused) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario(kFaults), folder / "run");
  std::ofstream(folder / "run/mav0/imu0/flags.csv", std::ios::app) << "999999999999,1,0\n";
  try {
    ReplayInto(folder / "run", folder / "again");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("999999999999"), std::string::npos) << e.what();
  }
}

TEST(ImuFaults, AFaultlessSensorWritesNoFlags) {
  const TemporaryFolder folder;
  RunInto(MakeSmallScenario({"mission.time_limit_s=2"}), folder / "run");
  EXPECT_FALSE(fs::exists(folder / "run/mav0/imu0/flags.csv"));
}

std::vector<RestChannel> RecordInto(const std::string& source, const RestOptions& rest, const fs::path& out) {
  RunOptions options;
  options.out = out;
  return RecordRest(LoadRestScenario(source, rest), rest.duration_s, options);
}

const std::string kSensorFile = R"(
sensors:
  imu0: {kind: imu, rate_Hz: 200, gyro: {noise_deg_s_sqrtHz: 0.01, bias_instability_deg_h: 10, quantisation_rad: 1e-6}, accel: {noise_ug_sqrtHz: 200, gauss_markov_sd_mg: 1}}
  mag0: {kind: magnetometer, rate_Hz: 50, noise_sd_uT: 0.3}
)";

TEST(RestRecord, IsWhatARunOfItsScenarioWrites) {
  for (const char* filter : {"none", "low_pass_2"}) {
    const TemporaryFolder folder;
    WriteTextFile(folder / "board.yaml", kSensorFile);
    const RestOptions rest{5, 100, {std::string("sensors.imu0.gyro.filter.digital=") + filter}};
    const auto channels = RecordInto((folder / "board.yaml").string(), rest, folder / "rest");
    ASSERT_EQ(channels.size(), 2U);
    EXPECT_EQ(channels[0].name, "imu0");
    EXPECT_EQ(channels[0].samples, 500);
    EXPECT_EQ(channels[1].samples, 251);  // an instant at the start, too
    RunInto(LoadScenario((folder / "rest/scenario.yaml").string()), folder / "run");
    for (const char* name : {"imu0", "mag0"}) {
      const auto fast = Lines(folder / "rest/mav0" / name / "data.csv");
      const auto slow = Lines(folder / "run/mav0" / name / "data.csv");
      ASSERT_GE(slow.size(), fast.size() - 2);  // a run ends where it can no longer look ahead
      for (std::size_t i = 0; i < slow.size(); ++i) ASSERT_EQ(fast[i], slow[i]) << name << ':' << i;
      EXPECT_EQ(FileText(folder / "rest/mav0" / name / "sensor.yaml"),
                FileText(folder / "run/mav0" / name / "sensor.yaml"));
    }
  }
}

TEST(RestRecord, TakesTheSensorsOfAScenario) {
  const TemporaryFolder folder;
  const auto channels = RecordInto("quickstart", {2, std::nullopt, {}}, folder / "rest");
  std::vector<std::string> names;
  for (const RestChannel& channel : channels) names.push_back(channel.name);
  EXPECT_EQ(names, (std::vector<std::string>{"imu0", "mag0", "pressure0"}));
  EXPECT_EQ(channels[0].samples, 800);
}

TEST(RestRecord, RefusesAScenarioWithoutSensors) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "board.yaml", "sensors: {hydrophone0: {kind: hydrophone}}\n");
  EXPECT_THROW(LoadRestScenario((folder / "board.yaml").string(), {1, {}, {}}), InputError);
}

}  // namespace
}  // namespace piperun::scenarios
