#include "scenarios/wall_feature_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "scenarios/assemble.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

constexpr char kFeatures[] = R"(
wall_features:
  - {id: J, pipe: P1, kind: joint, spacing_m: 1.5, spacing_sd_mm: 20, gap_mm: 6, gap_sd_mm: 1, offset_mm: 1}
  - {id: W, pipe: "*", kind: weld_bead, s_m: 2.2, height_mm: 1}
  - {id: V, pipe: P1, kind: gate_valve, s_m: 5.2, opening_mm: 110, clock_deg: 30}
)";

Scenario WithFeatures(const std::string& features = kFeatures, const std::vector<std::string>& set = {}) {
  return ParseScenario(kSmallScenario + features, "small.yaml", set);
}

TEST(WallFeatureList, NamesTheFeaturesOfASeriesByTheirNumber) {
  const auto assembly = Assemble(WithFeatures());
  std::vector<std::string> ids;
  for (const WallFeatureLabel& label : assembly->wall_features) ids.push_back(label.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"J[1]", "J[2]", "J[3]", "W", "V"}));
  ASSERT_EQ(assembly->bore->features().size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(assembly->bore->features()[i].s_m, assembly->wall_features[i].s_m);
  }
  EXPECT_EQ(assembly->wall_features[3].kind, "weld_bead");
}

TEST(WallFeatureList, IsAFunctionOfSeedAndRunAndOfNoOtherEntry) {
  const auto places = [](const std::string& features, const std::vector<std::string>& set) {
    const auto assembly = Assemble(WithFeatures(features, set));
    std::vector<double> s;
    for (const WallFeatureLabel& label : assembly->wall_features) {
      if (label.kind == "joint") s.push_back(label.s_m);
    }
    return s;
  };
  const std::string text = kFeatures;
  const std::string alone = text.substr(0, text.find("  - {id: W"));
  EXPECT_EQ(places(text, {}), places(text, {}));
  EXPECT_EQ(places(text, {}), places(alone, {}));
  EXPECT_NE(places(text, {}), places(text, {"run=1"}));
  EXPECT_NE(places(text, {}), places(text, {"seed=8"}));
}

TEST(WallFeatureList, TheEffectiveScenarioReadsBackToTheSameBytes) {
  const std::string once = WriteScenario(WithFeatures());
  EXPECT_EQ(WriteScenario(ParseScenario(once, "again.yaml")), once);
  EXPECT_NE(once.find("wall_features:"), std::string::npos);
}

/// Key path and place of what is refused.
std::string Refused(const std::string& entry) {
  try {
    Assemble(WithFeatures("wall_features:\n  - {id: J, pipe: P1, kind: joint, s_m: 1}\n  - " + entry + "\n"));
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "none";
}

TEST(WallFeatureList, RefusesWithTheKeyOfWhatIsWrong) {
  EXPECT_EQ(Refused("{id: J, pipe: P1, kind: joint, s_m: 2}"), "wall_features[1].id");
  EXPECT_EQ(Refused("{id: K, pipe: P2, kind: joint, s_m: 2}"), "wall_features[1].pipe");
  EXPECT_EQ(Refused("{id: K, pipe: P1, kind: joint, s_m: 7}"), "wall_features[1].s_m");
  EXPECT_EQ(Refused("{id: K, pipe: P1, kind: joint, s_m: 2, gap_mm: 60}"), "wall_features[1].gap_m");
  EXPECT_EQ(Refused("{id: K, pipe: P1, kind: joint, s_m: 2}"), "none");
}

TEST(WallFeatureList, ARunWritesWhereItsFeaturesAre) {
  TemporaryFolder out;
  Scenario scenario = WithFeatures();
  scenario.estimators.clear();
  scenario.sensors.clear();
  RunOptions options;
  options.out = out / "run";
  const RunResult result = scenarios::Run(scenario, options);
  EXPECT_EQ(result.status, "ok");
  std::istringstream csv(ReadTextFile(out / "run" / "truth/features.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "id,kind,pipe,s_m,chainage_m");
  std::vector<std::string> rows;
  while (std::getline(csv, line)) rows.push_back(line);
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[3], "W,weld_bead,P1,2.2,2.2");
}

TEST(WallFeatureList, AGateTooLowEndsTheRunWithABallThatIsStuck) {
  TemporaryFolder out;
  Scenario scenario =
      WithFeatures("wall_features:\n  - {id: V, pipe: P1, kind: gate_valve, s_m: 3, opening_mm: 50}\n",
                   {"mission.stuck_after_s=3"});
  scenario.estimators.clear();
  scenario.sensors.clear();
  RunOptions options;
  options.out = out / "run";
  EXPECT_EQ(scenarios::Run(scenario, options).status, "ball_stuck");
}

}  // namespace
}  // namespace piperun::scenarios
