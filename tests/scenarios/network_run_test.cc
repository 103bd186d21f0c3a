// Runs through an EPANET file's pipes: a tee of three pipes.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/random_network.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

using Json = nlohmann::json;

/// A fifth of the water turns off at a right angle, four metres on; L2 lies there, L1 and L3 ahead and
/// behind.
constexpr const char* kTee = R"(
schema: piperun.scenario/1
name: tee
seed: 3
network: {inp: nets/tee.inp, map_unit_m: 1}
leaks:
  - {id: L1, pipe: P1, s_m: 2.4, hole_diameter_mm: 2}
  - {id: L2, pipe: P3, s_m: 1.2, hole_diameter_mm: 3}
  - {id: L3, pipe: P2, s_m: 1.5, hole_diameter_mm: 2}
mission: {launch: N1, retrieve: N3, time_limit_s: 60, lateral_sd_mm: 5}
sensors:
  imu0: {kind: imu, rate_Hz: 400, gyro: {noise_deg_s_sqrtHz: 0.01, bias_sd_deg_s: 0.05}, accel: {noise_ug_sqrtHz: 200}}
  mag0: {kind: magnetometer, rate_Hz: 50, noise_sd_uT: 0.3}
  pressure0: {kind: pressure, rate_Hz: 50, noise_sd_Pa: 100}
  hydrophone0: {kind: hydrophone, rate_Hz: 16000}
estimators:
  ekf: {kind: quaternion_ekf, locator: {kind: matched_filter}}
output: {truth_rate_Hz: 100}
)";

class TeeRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    std::filesystem::create_directory(*folder_ / "nets");
    WriteTextFile(*folder_ / "nets/tee.inp", MakeBranching(0, 90, 0.2, 0.5).network.inp_text);
    WriteTextFile(*folder_ / "tee.yaml", kTee);
    result_ = new RunResult(RunInto(Load(), Folder()));
  }
  static void TearDownTestSuite() {
    delete result_;
    delete folder_;
  }
  static Scenario Load() { return LoadScenario((*folder_ / "tee.yaml").string()); }
  static std::filesystem::path Folder() { return *folder_ / "run"; }
  static const TrueLeak& TruthOf(std::size_t leak) { return result_->leaks[leak]; }

  static TemporaryFolder* folder_;
  static RunResult* result_;
};
TemporaryFolder* TeeRun::folder_ = nullptr;
RunResult* TeeRun::result_ = nullptr;

TEST_F(TeeRun, GoesStraightOnAndArrives) {
  EXPECT_EQ(result_->status, "ok");
  EXPECT_EQ(result_->route_pipes, (std::vector<std::string>{"P1", "P2"}));
  EXPECT_EQ(result_->planned_pipes, result_->route_pipes);
  EXPECT_NEAR(result_->route_length_m, 4 + 3, 1e-9);
}

TEST_F(TeeRun, ChainagesOfLeaksCountAlongTheWayTaken) {
  ASSERT_EQ(result_->leaks.size(), 3u);
  EXPECT_NEAR(TruthOf(0).chainage_m.value(), 2.4, 1e-9);
  EXPECT_NEAR(TruthOf(2).chainage_m.value(), 4 + 1.5, 1e-9);
  EXPECT_TRUE(TruthOf(0).t_cpa_ns);
  EXPECT_TRUE(TruthOf(2).t_cpa_ns);
}

TEST_F(TeeRun, ALeakOffTheWayHasNoChainageAndIsNeitherMissedNorMatched) {
  const TrueLeak& aside = TruthOf(1);
  EXPECT_FALSE(aside.chainage_m);
  EXPECT_FALSE(aside.t_cpa_ns);
  EXPECT_FALSE(aside.snr_dB);
  // the junction is at x = 4 from N1, the branch to the left
  EXPECT_NEAR(std::abs(aside.p_W.y() - TruthOf(0).p_W.y()), 1.2, 1e-9);
  const LeakScore& score = result_->estimators.at(0).leaks;
  for (const std::string& id : score.missed) EXPECT_NE(id, "L2");
  for (const ScoredLeak& leak : score.leaks) EXPECT_NE(leak.match.value_or(""), "L2");
  const Json json = Json::parse(result_->json);
  EXPECT_TRUE(json["truth"]["leaks"][1]["chainage_m"].is_null());
  EXPECT_GT(json["truth"]["leaks"][1]["flow_m3_s"].get<double>(), 0);
}

TEST_F(TeeRun, TheSameScenarioGivesTheSameBytes) {
  const TemporaryFolder other;
  EXPECT_EQ(RunInto(Load(), other / "run").file_hashes, result_->file_hashes);
}

TEST_F(TeeRun, TheFolderRunsAgainWithoutTheFileItCameFrom) {
  const TemporaryFolder other;
  std::filesystem::copy(Folder() / "scenario.yaml", other.path());
  std::filesystem::copy(Folder() / "network.inp", other.path());
  const RunResult again = RunInto(LoadScenario((other / "scenario.yaml").string()), other / "run");
  EXPECT_TRUE(again.file_hashes.contains("network.inp"));
  EXPECT_TRUE(again.file_hashes.contains("scenario.yaml"));
  EXPECT_EQ(again.file_hashes, result_->file_hashes);
}

TEST_F(TeeRun, ReplayGivesTheSameBitsAsTheLoop) {
  const TemporaryFolder other;
  ReplayOptions options;
  options.run_folder = Folder();
  options.out = other / "replay";
  const RunResult replayed = Replay(options);
  for (const char* name :
       {"estimates/ekf/track.csv", "estimates/ekf/trajectory.tum", "estimates/ekf/leaks.csv"}) {
    EXPECT_TRUE(FileText(Folder() / name) == FileText(other / "replay" / name)) << name;
  }
  const Json live = Json::parse(result_->json), again = Json::parse(replayed.json);
  EXPECT_EQ(again["estimators"], live["estimators"]);
  EXPECT_EQ(again["truth"], live["truth"]);
  EXPECT_EQ(again["route"], live["route"]);
}

TEST_F(TeeRun, PinnedToTheBranchItTurnsThere) {
  const TemporaryFolder other;
  Scenario scenario = Load();
  scenario.mission.retrieve = "N4";
  scenario.mission.branches = "pinned";
  scenario.network.inp_text =
      MakeBranching(0, 90, 0.5, 0.5).network.inp_text;  // enough to roll on against friction
  const RunResult result = RunInto(scenario, other / "run");
  EXPECT_EQ(result.status, "ok");
  EXPECT_EQ(result.route_pipes, (std::vector<std::string>{"P1", "P3"}));
  EXPECT_NEAR(result.leaks[1].chainage_m.value(), 4 + 1.2, 1e-9);
  EXPECT_FALSE(result.leaks[2].chainage_m);
}

}  // namespace
}  // namespace piperun::scenarios
