#include "scenarios/yaml_document.h"

#include <gtest/gtest.h>

#include <numbers>

#include "base/check.h"
#include "scenarios/load.h"
#include "scenarios/unit_alias.h"
#include "tests/scenarios/small_scenario.h"

namespace piperun::scenarios {
namespace {

/// A struct with one field of every type.
struct Sample {
  struct Part {
    std::string id;
    double length_m = 1;
    void Visit(ParamVisitor& v) {
      v.Text({"id", "Name.", true}, id);
      v.Number({"length_m", "Length."}, Range::Positive(), length_m);
    }
  };
  double rate_rad_s = 2;
  std::optional<double> limit;
  std::int64_t count = 3;
  bool flag = false;
  std::string text = "abc";
  std::string choice = "red";
  Vector3d vector{1, 2, 3};
  std::vector<double> table;
  std::vector<Part> parts;

  void Visit(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kColours{"red", "blue"};
    v.Number({"rate_rad_s", "A rate."}, Range::Between(-10, 10), rate_rad_s);
    v.NumberOr({"limit", "A limit."}, Range::NonNegative(), "none", limit);
    v.Integer({"count", "A count."}, 0, 9, count);
    v.Flag({"flag", "A flag."}, flag);
    v.Text({"text", "A text."}, text);
    v.Choice({"colour", "A colour."}, kColours, choice);
    v.Vector({"vector_m", "A vector."}, Range::Any(), vector);
    v.Table({"table", "Rows."}, Range::Any(), 2, table);
    v.Items({"parts", "Parts."}, parts);
  }
};

Sample Read(const std::string& text, const std::vector<std::string>& set = {}) {
  YamlDocument document(text, "test.yaml");
  for (const std::string& assignment : set) document.Set(assignment);
  Sample sample;
  document.Read([&](ParamVisitor& v) { sample.Visit(v); });
  return sample;
}

std::string ErrorOf(const std::string& text, const std::vector<std::string>& set = {}) {
  try {
    Read(text, set);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(YamlDocument, ReadsEveryTypeOfField) {
  const Sample s = Read(
      "rate_rad_s: -1.5\nlimit: 4\ncount: 9\nflag: true\ntext: x y\ncolour: blue\nvector_m: [1e-3, +2, -3]\n"
      "table: [[1, 2], [3, 4]]\nparts: [{id: a}, {id: b, length_m: 7}]\n");
  EXPECT_EQ(s.rate_rad_s, -1.5);
  EXPECT_EQ(s.limit, 4);
  EXPECT_EQ(s.count, 9);
  EXPECT_TRUE(s.flag);
  EXPECT_EQ(s.text, "x y");
  EXPECT_EQ(s.choice, "blue");
  EXPECT_EQ(s.vector, Vector3d(1e-3, 2, -3));
  EXPECT_EQ(s.table, (std::vector<double>{1, 2, 3, 4}));
  ASSERT_EQ(s.parts.size(), 2u);
  EXPECT_EQ(s.parts[0].length_m, 1);
  EXPECT_EQ(s.parts[1].length_m, 7);
}

TEST(YamlDocument, WritesWhatItReads) {
  Sample s = Read(
      "rate_deg_s: 33.3\nlimit: 0.1\ntext: 'true: #1 \"q\"'\ntable: [[0.1, 1e-300]]\nparts: [{id: a b}]\n");
  const auto visit = [&](ParamVisitor& v) { s.Visit(v); };
  const std::string text = WriteYaml(visit);
  Sample again = Read(text);
  EXPECT_EQ(again.rate_rad_s, s.rate_rad_s);
  EXPECT_EQ(again.text, s.text);
  EXPECT_EQ(again.table, s.table);
  EXPECT_EQ(WriteYaml([&](ParamVisitor& v) { again.Visit(v); }), text);
}

TEST(YamlDocument, ConvertsOtherUnitsOnce) {
  EXPECT_DOUBLE_EQ(Read("rate_deg_s: 180").rate_rad_s, std::numbers::pi);
  EXPECT_DOUBLE_EQ(Read("rate_deg_h: 648000").rate_rad_s, std::numbers::pi);
  EXPECT_EQ(Read("vector_mm: [1000, 0, 0]").vector, Vector3d(1, 0, 0));
}

TEST(UnitAlias, LeavesKeysAloneThatAreNoPlainUnit) {
  EXPECT_TRUE(FindUnitAliases("slope_dB_m").empty());
  EXPECT_TRUE(FindUnitAliases("poses_s_m_rad").empty());
  EXPECT_TRUE(FindUnitAliases("rate_Hz").empty());
  EXPECT_TRUE(AreSpellingsOfOne("radius_mm", "radius_cm"));
  EXPECT_FALSE(AreSpellingsOfOne("radius_mm", "diameter_mm"));
}

TEST(YamlDocument, RefusesAValueGivenInTwoUnits) {
  EXPECT_EQ(ErrorOf("rate_rad_s: 1\nrate_deg_s: 2"),
            "test.yaml:2: rate_deg_s: the same value is already given as 'rate_rad_s'");
}

TEST(YamlDocument, NamesTheNearestKnownKey) {
  EXPECT_EQ(ErrorOf("count: 1\ncolor: red"), "test.yaml:2: color: unknown key; did you mean 'colour'?");
  EXPECT_EQ(ErrorOf("parts: [{id: a, lenght_m: 3}]"),
            "test.yaml:1: parts[0].lenght_m: unknown key; did you mean 'length_m'?");
  EXPECT_EQ(ErrorOf("zzzzzzzz: 1"), "test.yaml:1: zzzzzzzz: unknown key");
}

TEST(YamlDocument, RefusesAKeyGivenTwice) {
  EXPECT_EQ(ErrorOf("count: 1\nflag: true\ncount: 2"), "test.yaml:3: count: this key is given twice");
}

TEST(YamlDocument, RefusesWrongTypes) {
  EXPECT_EQ(ErrorOf("rate_rad_s: fast"), "test.yaml:1: rate_rad_s: expected a number, found 'fast'");
  EXPECT_EQ(ErrorOf("rate_rad_s: [1]"), "test.yaml:1: rate_rad_s: expected a number, found a list");
  EXPECT_EQ(ErrorOf("rate_rad_s: .nan"), "test.yaml:1: rate_rad_s: expected a number, found '.nan'");
  EXPECT_EQ(ErrorOf("rate_rad_s:"), "test.yaml:1: rate_rad_s: expected a number, found nothing");
  EXPECT_EQ(ErrorOf("limit: nothing"), "test.yaml:1: limit: expected a number or 'none', found 'nothing'");
  EXPECT_EQ(ErrorOf("count: 1.5"), "test.yaml:1: count: expected a whole number, found '1.5'");
  EXPECT_EQ(ErrorOf("flag: yes"), "test.yaml:1: flag: expected true or false, found 'yes'");
  EXPECT_EQ(ErrorOf("vector_m: [1, 2]"), "test.yaml:1: vector_m: expected a list of 3 numbers, found 2");
  EXPECT_EQ(ErrorOf("parts: {id: a}"), "test.yaml:1: parts: expected a list, found a map");
  EXPECT_EQ(ErrorOf("colour: green"), "test.yaml:1: colour: 'green' is not known; allowed: red blue");
}

TEST(YamlDocument, RefusesValuesOutOfRange) {
  EXPECT_EQ(ErrorOf("rate_rad_s: 11"), "test.yaml:1: rate_rad_s: 11 is out of range; allowed: [-10, 10]");
  EXPECT_EQ(ErrorOf("count: 10"), "test.yaml:1: count: 10 is out of range; allowed: 0 to 9");
  EXPECT_NE(ErrorOf("rate_deg_s: 3600").find("3600 is out of range; allowed: [-10, 10] (in SI"),
            std::string::npos);
}

TEST(YamlDocument, NamesAMissingKey) {
  EXPECT_EQ(ErrorOf("parts: [{length_m: 1}]"), "test.yaml:1: parts[0]: the key 'id' is missing: Name.");
}

TEST(YamlDocument, RefusesWhatIsNotYaml) {
  EXPECT_NE(ErrorOf("a: [1, 2\nb: }").find("this is not YAML"), std::string::npos);
  EXPECT_EQ(ErrorOf("just words"), "test.yaml: this is not a YAML map of keys");
  EXPECT_THROW(YamlDocument::FromFile("does/not/exist.yaml"), InputError);
}

TEST(YamlDocument, AnOverrideReplacesTheValueInWhateverUnit) {
  EXPECT_EQ(Read("rate_deg_s: 5", {"rate_rad_s=0.5"}).rate_rad_s, 0.5);
  EXPECT_DOUBLE_EQ(Read("rate_rad_s: 5", {"rate_deg_s=180"}).rate_rad_s, std::numbers::pi);
  EXPECT_DOUBLE_EQ(Read("rate_deg_h: 5", {"rate_deg_s=180"}).rate_rad_s, std::numbers::pi);
}

TEST(YamlDocument, RefusesEmptyFilesAndSecondDocuments) {
  EXPECT_EQ(ErrorOf(""), "test.yaml: this file is empty");
  EXPECT_EQ(ErrorOf("count: 1\n---\ncount: 2"), "test.yaml: this file holds more than one YAML document");
}

TEST(YamlDocument, OverridesByIndexAndById) {
  const std::string text = "count: 1\nparts: [{id: a}, {id: b}]";
  EXPECT_EQ(Read(text, {"count=2"}).count, 2);
  EXPECT_EQ(Read(text, {"rate_rad_s=0.5"}).rate_rad_s, 0.5);
  EXPECT_EQ(Read(text, {"parts[1].length_m=5"}).parts[1].length_m, 5);
  EXPECT_EQ(Read(text, {"parts.a.length_m=6"}).parts[0].length_m, 6);
  EXPECT_EQ(ErrorOf(text, {"count=12"}), "--set: count: 12 is out of range; allowed: 0 to 9");
  EXPECT_NE(ErrorOf(text, {"parts.c.length_m=6"}).find("there is no item with id 'c'"), std::string::npos);
  EXPECT_NE(ErrorOf(text, {"count"}).find("not of the form key=value"), std::string::npos);
}

TEST(Scenario, KeepsEveryValueThroughAFile) {
  const Scenario scenario = MakeSmallScenario();
  const std::string text = WriteScenario(scenario);
  EXPECT_EQ(WriteScenario(ParseScenario(text, "again.yaml")), text);
}

}  // namespace
}  // namespace piperun::scenarios
