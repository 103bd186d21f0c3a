#include "scenarios/material_rules.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "base/check.h"
#include "scenarios/output_file.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

PipeTraits Traits(std::string_view tag, double diameter_mm, double hazen_williams) {
  return {tag, diameter_mm / 1000, hazen_williams, std::nullopt};
}

TEST(MatchesGlob, KnowsStarAndQuestionMarkAndNoCase) {
  EXPECT_TRUE(MatchesGlob("*", ""));
  EXPECT_TRUE(MatchesGlob("", ""));
  EXPECT_FALSE(MatchesGlob("", "x"));
  EXPECT_TRUE(MatchesGlob("*pvc*", "old PVC-U 1978"));
  EXPECT_TRUE(MatchesGlob("DI?", "di9"));
  EXPECT_FALSE(MatchesGlob("DI?", "di"));
  EXPECT_FALSE(MatchesGlob("DI", "DIN"));
  EXPECT_TRUE(MatchesGlob("a*b*c", "aXbXbc"));
  EXPECT_FALSE(MatchesGlob("a*b*c", "aXcXb"));
  // many stars on a text that nearly matches: linear in their product, not exponential
  EXPECT_FALSE(MatchesGlob("a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*b", std::string(2000, 'a')));
}

// EN 545 K9: DN 100 4.5 + 0.9 = 5.4, at least 6.0; DN 300 7.2; DN 600 9.9 mm
TEST(DefaultRules, DuctileIronHasTheWallOfItsClass) {
  const MaterialRules rules;
  for (const auto& [bore_mm, wall_mm] : {std::pair{100.0, 6.0}, {300.0, 7.2}, {600.0, 9.9}}) {
    const PipeWall wall = rules.ChooseWall(Traits("", bore_mm, 125));
    EXPECT_EQ(wall.material, "ductile_iron");
    EXPECT_NEAR(wall.thickness_m, wall_mm / 1000, 1e-15);
  }
}

// outside diameter 110 mm, SDR 26: e = 4.23 mm (EN ISO 1452-2 rounds up to 4.2 + tolerance), bore 101.54 mm
TEST(DefaultRules, ThePlasticsHaveTheRatioOfTheirSeries) {
  const MaterialRules rules;
  const double bore_mm = 110 - 2 * 110.0 / 26;
  const PipeWall pvc = rules.ChooseWall(Traits("", bore_mm, 150));
  EXPECT_EQ(pvc.material, "pvc_u");
  EXPECT_NEAR(pvc.thickness_m, 0.110 / 26, 1e-15);
  const PipeWall pe = rules.ChooseWall(Traits("HDPE", 630 - 2 * 630.0 / 17, 100));
  EXPECT_EQ(pe.material, "pe_hd");
  EXPECT_NEAR(pe.thickness_m, 0.630 / 17, 1e-15);
}

TEST(DefaultRules, ATagCountsMoreThanTheRoughness) {
  const MaterialRules rules;
  EXPECT_EQ(rules.ChooseWall(Traits("steel 1960", 300, 150)).material, "steel");
  EXPECT_EQ(rules.ChooseWall(Traits("AC", 300, 150)).material, "asbestos_cement");
  EXPECT_EQ(rules.ChooseWall(Traits("main street", 300, 90)).material, "cast_iron");
}

TEST(DefaultRules, ALawWithoutEitherRoughnessFallsThrough) {
  EXPECT_EQ(MaterialRules().ChooseWall({"", 0.3, std::nullopt, std::nullopt}).material, "ductile_iron");
  EXPECT_EQ(MaterialRules().ChooseWall({"", 0.3, std::nullopt, 5e-6}).material, "pvc_u");
  EXPECT_EQ(MaterialRules().ChooseWall({"", 0.3, std::nullopt, 2e-3}).material, "cast_iron");
}

MaterialRules MakeRules(const std::string& rules) {
  return MaterialRules("name: mine\nrules:\n" + rules, "mine.yaml");
}

TEST(RuleFiles, TheFirstRuleThatMatchesCountsAndWallsFollowTheBore) {
  const MaterialRules rules = MakeRules(
      "  - {min_diameter_mm: 100, max_diameter_mm: 200, material: steel, wall_mm: 5}\n"
      "  - {min_diameter_mm: 200, material: concrete, wall_classes: [{up_to_diameter_mm: 300, wall_mm: 30}, "
      "{up_to_diameter_mm: 500, wall_mm: 50}]}\n"
      "  - {material: copper, sdr: 22}\n");
  EXPECT_EQ(rules.ChooseWall(Traits("", 200, 100)).material, "steel");
  EXPECT_EQ(rules.ChooseWall(Traits("", 200, 100)).thickness_m, 0.005);
  EXPECT_EQ(rules.ChooseWall(Traits("", 300, 100)).thickness_m, 0.03);
  EXPECT_EQ(rules.ChooseWall(Traits("", 301, 100)).thickness_m, 0.05);
  EXPECT_EQ(rules.ChooseWall(Traits("", 900, 100)).thickness_m, 0.05);
  EXPECT_NEAR(rules.ChooseWall(Traits("", 20, 100)).thickness_m, 0.001, 1e-15);
}

struct BadRules {
  const char* name;
  const char* rules;
  int line;  ///< of the file, whose rules begin in line 3
  const char* words;
};
void PrintTo(const BadRules& bad, std::ostream* out) { *out << bad.name; }

class RuleFileRefuses : public testing::TestWithParam<BadRules> {};

TEST_P(RuleFileRefuses, WithTheLineAndTheProblem) {
  try {
    MakeRules(GetParam().rules);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.where(), "mine.yaml:" + std::to_string(GetParam().line));
    EXPECT_NE(e.problem().find(GetParam().words), std::string::npos) << e.what();
  }
}

const BadRules kBadRules[] = {
    {"NoWall", "  - {material: steel}\n", 3, "give one of sdr"},
    {"TwoWalls", "  - {material: steel, sdr: 20, wall_mm: 4}\n", 3, "only one"},
    {"LastWithCondition", "  - {tag: A, material: steel, sdr: 20}\n", 3, "must match every pipe"},
    {"FirstWithout", "  - {material: steel, sdr: 20}\n  - {material: copper, sdr: 20}\n", 3, "never count"},
    {"ClassesFall",
     "  - {material: steel, wall_classes: [{up_to_diameter_mm: 9, wall_mm: 1}, {up_to_diameter_mm: 9, "
     "wall_mm: "
     "2}]}\n",
     3, "must rise"},
    {"UnknownMaterial", "  - {tag: A, material: steel, sdr: 20}\n  - {material: stee, sdr: 20}\n", 4,
     "steel"},
    {"UnknownKey", "  - {material: steel, sdr: 20, sdrr: 1}\n", 3, "unknown key"},
};
INSTANTIATE_TEST_SUITE_P(BadInput, RuleFileRefuses, testing::ValuesIn(kBadRules),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(RuleFiles, AMissingFileIsNamedWithTheLineThatNamesIt) {
  const char* text =
      "schema: piperun.scenario/1\n"
      "name: s\n"
      "network:\n"
      "  inp: neighbourhood\n"
      "  material_rules: no/such/rules.yaml\n";
  const TemporaryFolder folder;
  const std::string path = (folder / "s.yaml").string();
  WriteTextFile(path, text);
  try {
    LoadScenario(path);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), "network.material_rules");
    EXPECT_EQ(e.where(), path + ":5");
    EXPECT_NE(e.problem().find((folder / "no/such/rules.yaml").string()), std::string::npos) << e.what();
  }
}

TEST(RuleFiles, AreReadFromBesideTheScenario) {
  const TemporaryFolder folder;
  const std::string path = (folder / "s.yaml").string();
  const std::string rules = "name: mine\nrules: [{material: copper, wall_mm: 2}]\n";
  WriteTextFile(folder / "mine.yaml", rules);
  WriteTextFile(
      path,
      "schema: piperun.scenario/1\nname: s\nnetwork: {inp: neighbourhood, material_rules: mine.yaml}\n");
  EXPECT_EQ(LoadScenario(path).network.material_rules_text, rules);
}

}  // namespace
}  // namespace piperun::scenarios
