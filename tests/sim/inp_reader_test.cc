#include "sim/network/inp_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/random.h"
#include "tests/support/networks.h"

namespace piperun::sim {
namespace {

constexpr double kCubicFoot_m3 = 0.028316846592;

/// The smallest network: a reservoir, a pipe, a junction.
std::string SmallInp(const std::string& more = {}, const std::string& options = "Units LPS\nHeadloss H-W\n") {
  return "[JUNCTIONS]\n J 10 5\n[RESERVOIRS]\n R 50\n[PIPES]\n P R J 100 200 120 0.5 Open\n" + more +
         "[OPTIONS]\n" + options + "[END]\n";
}

HydraulicModel Read(const std::string& text) { return ReadInp(text, "net.inp"); }

bool HasNote(const HydraulicModel& model, const std::string& words) {
  return std::any_of(model.notes.begin(), model.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// The error a text gives, or an empty one.
InputError ErrorOf(const std::string& text) {
  try {
    Read(text);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("none");
}

TEST(InpReader, SiUnitsBecomeMetresAndCubicMetresPerSecond) {
  const HydraulicModel model = Read(SmallInp());
  EXPECT_EQ(model.junctions[0].id, "J");
  EXPECT_EQ(model.junctions[0].elevation_m, 10);
  EXPECT_EQ(model.reservoirs[0].head_m, 50);
  EXPECT_EQ(model.pipes[0].length_m, 100);
  EXPECT_DOUBLE_EQ(model.pipes[0].diameter_m, 0.2);
  EXPECT_EQ(model.pipes[0].roughness, 120);
  EXPECT_EQ(model.pipes[0].minor_loss, 0.5);
  EXPECT_DOUBLE_EQ(model.junctions[0].demands[0].base_m3_s, 5 * kCubicFoot_m3 / 28.317);
  EXPECT_EQ(model.pipes[0].from, 1);  // nodes are numbered junctions, reservoirs, tanks
  EXPECT_EQ(model.pipes[0].to, 0);
}

struct UnitCase {
  const char* name;
  double true_m3_s;  ///< what the unit is by its definition
  double rounding;   ///< how far EPANET's rounded factor is from it
  bool metric;
};

class InpUnits : public ::testing::TestWithParam<UnitCase> {};

TEST_P(InpUnits, FlowUnitIsTheTrueOneWithinEpanetsRounding) {
  const UnitCase& unit = GetParam();
  const HydraulicModel model = Read(SmallInp("", std::string("Units ") + unit.name + "\n"));
  EXPECT_NEAR(model.junctions[0].demands[0].base_m3_s / (5 * unit.true_m3_s), 1, unit.rounding);
  EXPECT_EQ(model.options.metric, unit.metric);
  EXPECT_DOUBLE_EQ(model.pipes[0].length_m, unit.metric ? 100 : 30.48);
  EXPECT_DOUBLE_EQ(model.pipes[0].diameter_m, unit.metric ? 0.2 : 5.08);
}

// gallon 3.785411784e-3 m3, imperial gallon 4.54609e-3 m3, acre-foot 43,560 ft3
INSTANTIATE_TEST_SUITE_P(
    AllFlowUnits, InpUnits,
    ::testing::Values(UnitCase{"CFS", kCubicFoot_m3, 1e-15, false},
                      UnitCase{"GPM", 3.785411784e-3 / 60, 1e-6, false},
                      UnitCase{"MGD", 3785.411784 / 86400, 1e-5, false},
                      UnitCase{"IMGD", 4546.09 / 86400, 1e-4, false},
                      UnitCase{"AFD", 43560 * kCubicFoot_m3 / 86400, 2e-4, false},
                      UnitCase{"LPS", 1e-3, 1e-5, true}, UnitCase{"LPM", 1e-3 / 60, 1e-5, true},
                      UnitCase{"MLD", 1e3 / 86400, 2e-5, true}, UnitCase{"CMH", 1.0 / 3600, 1e-5, true},
                      UnitCase{"CMD", 1.0 / 86400, 2e-5, true}, UnitCase{"CMS", 1, 1e-5, true}),
    [](const auto& info) { return info.param.name; });

TEST(InpReader, SectionsMayComeInAnyOrderAndCase) {
  const HydraulicModel model = Read(
      "[options]\nunits lps\n[Pipes]\nP R J 100 200 120\n[reservoirs]\nR 50\n[junc]\nJ 10 "
      "5\n[END]\n[nonsense]\n");
  EXPECT_EQ(model.pipes[0].to, 0);
  EXPECT_EQ(model.junctions[0].elevation_m, 10);
}

TEST(InpReader, CommentsCarriageReturnsAndByteOrderMarksAreNoData) {
  const std::string text =
      "\xEF\xBB\xBF; made by hand\r\n[JUNCTIONS]\r\n;id elev\r\n J 10 5 ;the only "
      "one\r\n[RESERVOIRS]\r\n\tR\t50\r\n"
      "[PIPES]\r\nP R J 100 200 120\r\n";
  EXPECT_EQ(Read(text).junctions.size(), 1u);
}

TEST(InpReader, Latin1BecomesUtf8AndUtf8Stays) {
  const std::string tags = "[TAGS]\nNODE J ";
  EXPECT_EQ(Read(SmallInp(tags + "Caf\xE9\n")).junctions[0].tag, "Caf\xC3\xA9");
  EXPECT_EQ(Read(SmallInp(tags + "Caf\xC3\xA9\n")).junctions[0].tag, "Caf\xC3\xA9");
}

TEST(InpReader, QuotedWordsKeepTheirSpaces) {
  EXPECT_EQ(Read(SmallInp("[TAGS]\nLINK P \"laid in 1921\"\n")).pipes[0].tag, "laid in 1921");
}

TEST(InpReader, DemandsReplaceTheJunctionsOwnAndAddUp) {
  const HydraulicModel model =
      Read(SmallInp("[DEMANDS]\nJ 2 ; homes\nJ 3 shop ; shops\n[PATTERNS]\nday 1 2\nshop 0 1\nshop 0.5\n",
                    "Units LPS\nPattern day\n"));
  const auto& demands = model.junctions[0].demands;
  ASSERT_EQ(demands.size(), 2u);
  EXPECT_NEAR(demands[0].base_m3_s, 0.002, 2e-8);
  EXPECT_EQ(model.patterns[static_cast<std::size_t>(demands[0].pattern)].id, "day");
  EXPECT_EQ(demands[0].name, "homes");
  EXPECT_EQ(model.patterns[static_cast<std::size_t>(demands[1].pattern)].multipliers,
            (std::vector<double>{0, 1, 0.5}));
}

TEST(InpReader, TimesAreReadInEveryNotation) {
  const HydraulicTimes times =
      Read(SmallInp(
               "[TIMES]\nDuration 36\nHydraulic Timestep 0:30\nPattern Timestep 90 min\nReport Timestep "
               "1:00:30\n"
               "Report Start 2 HOURS\nPattern Start 600 sec\nStart ClockTime 3:15 PM\nRule Timestep 0:01\n"))
          .times;
  EXPECT_EQ(times.duration_s, 129600);
  EXPECT_EQ(times.hydraulic_step_s, 1800);
  EXPECT_EQ(times.pattern_step_s, 5400);
  EXPECT_EQ(times.report_step_s, 3630);
  EXPECT_EQ(times.report_start_s, 7200);
  EXPECT_EQ(times.pattern_start_s, 600);
  EXPECT_EQ(times.start_clock_s, 15 * 3600 + 900);
  EXPECT_EQ(times.rule_step_s, 60);
}

TEST(InpReader, NoonAndMidnightAreTwelve) {
  EXPECT_EQ(Read(SmallInp("[TIMES]\nStart ClockTime 12 am\n")).times.start_clock_s, 0);
  EXPECT_EQ(Read(SmallInp("[TIMES]\nStart ClockTime 12:30 PM\n")).times.start_clock_s, 45000);
}

TEST(InpReader, AHydraulicStepServesTheShorterOfPatternAndReport) {
  EXPECT_EQ(Read(SmallInp("[TIMES]\nHydraulic Timestep 4\nPattern Timestep 2\n")).times.hydraulic_step_s,
            3600);
}

TEST(InpReader, PumpsAreWhatTheirCurvesMakeThem) {
  const HydraulicModel model = Read(SmallInp(
      "[PUMPS]\na R J HEAD one\nb R J HEAD three SPEED 0.9\nc R J HEAD many\nd R J POWER 2 PATTERN p\n"
      "[CURVES]\none 20 30\nthree 0 50\nthree 10 40\nthree 20 20\nmany 0 50\nmany 5 45\nmany 9 30\nmany 12 "
      "8\n"
      "[PATTERNS]\np 1 0.5\n"));
  EXPECT_EQ(model.pumps[0].kind, PumpKind::kPowerFunction);
  EXPECT_EQ(model.pumps[1].kind, PumpKind::kPowerFunction);
  EXPECT_EQ(model.pumps[1].speed, 0.9);
  EXPECT_EQ(model.pumps[2].kind, PumpKind::kCurve);
  EXPECT_NEAR(model.pumps[2].curve[2].x, 0.009, 1e-7);
  EXPECT_EQ(model.pumps[3].kind, PumpKind::kConstantPower);
  EXPECT_EQ(model.pumps[3].power_W, 2000);
  EXPECT_EQ(model.pumps[3].pattern, 0);
}

TEST(InpReader, StatusFixesPumpsPipesAndValves) {
  const std::string more =
      "[JUNCTIONS]\nK 5\nM 6\n[PIPES]\nQ K M 10 100 100\n[PUMPS]\nu R J POWER 1\n[VALVES]\nv J K 100 TCV 12\n"
      "w J M 100 TCV 3\n[STATUS]\nP Closed\nu 1.2\nv Open\nw 7\n";
  const HydraulicModel model = Read(SmallInp(more));
  EXPECT_EQ(model.pipes[0].status, LinkStatus::kClosed);
  EXPECT_EQ(model.pumps[0].speed, 1.2);
  EXPECT_EQ(model.valves[0].status, LinkStatus::kOpen);
  EXPECT_EQ(model.valves[1].setting, 7);
  EXPECT_EQ(model.valves[1].status, LinkStatus::kActive);
}

TEST(InpReader, PressureUnitsAreThoseOfTheUnitSystemUnlessGiven) {
  // 1 psi is 1/0.4333 ft of water for EPANET; 100 kPa is 10.2 m of water
  const std::string valve = "[JUNCTIONS]\nK 5\nM 5\n[PIPES]\nQ K M 100 100 100\n[VALVES]\nv J K 100 PRV 20\n";
  EXPECT_DOUBLE_EQ(Read(SmallInp(valve)).valves[0].setting, 20);
  EXPECT_NEAR(Read(SmallInp(valve, "Units GPM\n")).valves[0].setting, 20 * 0.3048 / 0.4333, 1e-12);
  EXPECT_NEAR(Read(SmallInp(valve, "Units LPS\nPressure KPA\n")).valves[0].setting, 20 / 9.80665, 0.002);
}

TEST(InpReader, ControlsTurnLevelsPressuresAndTimesIntoSi) {
  const HydraulicModel model = Read(SmallInp(
      "[TANKS]\nT 20 1 0 3 10\n[PIPES]\nQ J T 10 100 100\n[CONTROLS]\nLINK P CLOSED IF NODE T ABOVE 2.5\n"
      "LINK P OPEN IF NODE J BELOW 30\nLINK P CLOSED AT TIME 1:30\nLINK Q OPEN AT CLOCKTIME 6 PM "
      "DISABLED\n"));
  ASSERT_EQ(model.controls.size(), 4u);
  EXPECT_EQ(model.controls[0].head_m, 22.5);
  EXPECT_EQ(model.controls[0].action.status, LinkStatus::kClosed);
  EXPECT_EQ(model.controls[1].head_m, 40);
  EXPECT_EQ(model.controls[2].time_s, 5400);
  EXPECT_EQ(model.controls[3].time_s, 64800);
  EXPECT_FALSE(model.controls[3].enabled);
}

TEST(InpReader, RulesKeepTheirPremisesActionsAndPriority) {
  const HydraulicModel model = Read(
      SmallInp("[TANKS]\nT 20 1 0 3 10\n[PIPES]\nQ J T 10 100 100\n[RULES]\nRULE one\nIF TANK T LEVEL >= 2\n"
               "AND SYSTEM CLOCKTIME < 6 PM\nOR LINK Q FLOW BELOW 3\nTHEN PIPE P STATUS IS CLOSED\nELSE PIPE "
               "P STATUS IS OPEN\n"
               "PRIORITY 4\n"));
  ASSERT_EQ(model.rules.size(), 1u);
  const Rule& rule = model.rules[0];
  ASSERT_EQ(rule.premises.size(), 3u);
  EXPECT_EQ(rule.premises[0].relation, RulePremise::Relation::kGreaterOrEqual);
  EXPECT_EQ(rule.premises[0].value, 2);
  EXPECT_EQ(rule.premises[1].value, 64800);
  EXPECT_TRUE(rule.premises[2].is_alternative);
  EXPECT_NEAR(rule.premises[2].value, 0.003, 1e-7);
  EXPECT_EQ(rule.then_actions[0].status, LinkStatus::kClosed);
  EXPECT_EQ(rule.else_actions.size(), 1u);
  EXPECT_EQ(rule.priority, 4);
}

TEST(InpReader, GeometryOfTheMapIsKept) {
  const HydraulicModel model = Read(SmallInp("[COORDINATES]\nJ 1 2\nR -3 4.5\n[VERTICES]\nP 0 1\nP 0.5 2\n"));
  EXPECT_EQ(model.junctions[0].position->y, 2);
  EXPECT_EQ(model.reservoirs[0].position->x, -3);
  ASSERT_EQ(model.pipes[0].vertices.size(), 2u);
  EXPECT_EQ(model.pipes[0].vertices[1].x, 0.5);
}

TEST(InpReader, WhatIsNotHonouredIsNoted) {
  const HydraulicModel model =
      Read(SmallInp("[ENERGY]\nGlobal Price 0.1\n[QUALITY]\nJ 1\n[LABELS]\n1 2 \"hill\"\n"));
  EXPECT_TRUE(HasNote(model, "[ENERGY]"));
  EXPECT_TRUE(HasNote(model, "[QUALITY]"));
  EXPECT_TRUE(HasNote(model, "[LABELS]"));
}

TEST(InpReader, CoordinatesOfNodesThatAreGoneAreNoted) {
  EXPECT_TRUE(HasNote(Read(SmallInp("[COORDINATES]\nghost 1 2\n[VERTICES]\nghost 1 2\n")), "unknown"));
}

TEST(InpReader, StepsOfZeroAndAReportThatNeverBeginsAreNoted) {
  EXPECT_TRUE(HasNote(Read(SmallInp("[TIMES]\nHydraulic Timestep 0\n")), "default"));
  EXPECT_TRUE(HasNote(Read(SmallInp("[TIMES]\nDuration 2\nReport Start 3\n")), "REPORT START"));
  EXPECT_FALSE(HasNote(Read(SmallInp("[TIMES]\nDuration 0\nReport Start 0\n")), "[TIMES]"));
}

TEST(InpReader, AFileWithoutEndIsNoted) {
  std::string text = SmallInp();
  text.resize(text.find("[END]"));
  EXPECT_TRUE(HasNote(Read(text), "[END]"));
}

struct BadCase {
  const char* name;
  std::string text;
  const char* where;  ///< file, and line where there is one
  const char* section;
  const char* words;  ///< of the message
};

class BadInp : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadInp, IsRefusedWithLineSectionAndRemedy) {
  const BadCase& bad = GetParam();
  const InputError error = ErrorOf(bad.text);
  EXPECT_EQ(error.where(), bad.where) << error.what();
  EXPECT_NE(error.key_path().find(bad.section), std::string::npos) << error.what();
  EXPECT_NE(error.problem().find(bad.words), std::string::npos) << error.what();
}

// SmallInp puts its own lines 1..6, so that what is added begins at line 7
INSTANTIATE_TEST_SUITE_P(
    Inputs, BadInp,
    ::testing::Values(
        BadCase{"Binary",
                std::string("\x7F"
                            "ELF\x02\x01\0\0",
                            8),
                "net.inp:1", "", "byte"},
        BadCase{"NotAnInp", "hello\n", "net.inp:1", "", "before the first section"},
        BadCase{"CutInAHeading", "[JUNCTIONS]\nJ 1\n[R", "net.inp:3", "", "unknown section"},
        BadCase{"CutInALine", "[JUNCTIONS]\nJ 1\n[RESERVOIRS]\nR 5\n[PIPES]\nP R J 10", "net.inp:6",
                "[PIPES] 'P'", "at least 6"},
        BadCase{"CutAfterJunctions", "[JUNCTIONS]\nJ 1\n", "net.inp", "[RESERVOIRS]", "no reservoir"},
        BadCase{"Empty", "", "net.inp", "[JUNCTIONS]", "no junction"},
        BadCase{"UnknownNode", SmallInp("Q R X 10 100 100\n"), "net.inp:7", "[PIPES] 'Q'", "no node 'X'"},
        BadCase{"SameEnds", SmallInp("Q R R 10 100 100\n"), "net.inp:7", "[PIPES] 'Q'", "both ends"},
        BadCase{"NodeTwice", SmallInp("[RESERVOIRS]\nJ 3\n"), "net.inp:8", "[RESERVOIRS] 'J'", "used twice"},
        BadCase{"LinkTwice", SmallInp("P R J 10 100 100\n"), "net.inp:7", "[PIPES] 'P'", "used twice"},
        BadCase{"LengthZero", SmallInp("Q R J 0 100 100\n"), "net.inp:7", "[PIPES] 'Q'",
                "length is 0; allowed: > 0"},
        BadCase{"DiameterZero", SmallInp("Q R J 9 0 100\n"), "net.inp:7", "[PIPES] 'Q'", "diameter is 0"},
        BadCase{"RoughnessNegative", SmallInp("Q R J 9 100 -1\n"), "net.inp:7", "[PIPES] 'Q'",
                "roughness is -1"},
        BadCase{"NotANumber", SmallInp("Q R J nan 100 100\n"), "net.inp:7", "[PIPES] 'Q'",
                "must be a number"},
        BadCase{"StatusUnknown", SmallInp("Q R J 9 100 100 0 ajar\n"), "net.inp:7", "[PIPES] 'Q'",
                "OPEN, CLOSED, CV"},
        BadCase{"Disconnected", SmallInp("[JUNCTIONS]\nA 1\nB 2\n[PIPES]\nQ A B 9 100 100\n"), "net.inp:8",
                "[JUNCTIONS] 'A'", "leads"},
        BadCase{"PumpCurveRising",
                SmallInp("[PUMPS]\nu R J HEAD c\n[CURVES]\nc 0 10\nc 5 12\nc 9 15\nc 12 16\n"), "net.inp:8",
                "[PUMPS] 'u'", "must fall"},
        BadCase{"PumpCurveFlat", SmallInp("[PUMPS]\nu R J HEAD c\n[CURVES]\nc 0 10\nc 5 10\nc 9 4\n"),
                "net.inp:8", "[PUMPS] 'u'", "must fall"},
        BadCase{"PumpWithoutCurve", SmallInp("[PUMPS]\nu R J SPEED 1\n"), "net.inp:8", "[PUMPS] 'u'",
                "neither"},
        BadCase{"PumpCurveUnknown", SmallInp("[PUMPS]\nu R J HEAD c\n"), "net.inp:8", "[PUMPS] 'u'",
                "no curve 'c'"},
        BadCase{"CurveNotRising", SmallInp("[CURVES]\nc 5 1\nc 5 2\n"), "net.inp:9", "[CURVES] 'c'",
                "must rise"},
        BadCase{"TankLevels", SmallInp("[TANKS]\nT 20 5 1 3 10\n"), "net.inp:8", "[TANKS] 'T'",
                "do not agree"},
        BadCase{"TankWithoutWidth", SmallInp("[TANKS]\nT 20 2 1 3 0\n"), "net.inp:8", "[TANKS] 'T'",
                "diameter is 0"},
        BadCase{"TankCurveTooShort", SmallInp("[TANKS]\nT 20 2 1 3 5 0 c\n[CURVES]\nc 0 0\nc 2 9\n"),
                "net.inp:8", "[TANKS] 'T'", "does not reach"},
        BadCase{"UnitUnknown", SmallInp("", "Units FURLONGS\n"), "net.inp:8", "[OPTIONS] 'Units'",
                "allowed: CFS, GPM"},
        BadCase{"LawUnknown", SmallInp("", "Headloss X-Y\n"), "net.inp:8", "[OPTIONS] 'Headloss'",
                "H-W, D-W, C-M"},
        BadCase{"OptionUnknown", SmallInp("", "Colour blue\n"), "net.inp:8", "[OPTIONS] 'Colour'",
                "unknown option"},
        BadCase{"HydraulicsFile", SmallInp("", "Hydraulics Use a.hyd\n"), "net.inp:8", "[OPTIONS]",
                "not supported"},
        BadCase{"SectionUnknown", SmallInp("[PIPEZ]\n"), "net.inp:7", "", "unknown section"},
        BadCase{"ValveTypeUnknown", SmallInp("[JUNCTIONS]\nK 1\n[VALVES]\nv J K 100 XYZ 3\n"), "net.inp:10",
                "[VALVES] 'v'", "PRV, PSV"},
        BadCase{"ValveAtReservoir", SmallInp("[VALVES]\nv R J 100 PRV 3\n"), "net.inp:8", "[VALVES] 'v'",
                "reservoir or tank"},
        BadCase{"ValvesInSeries",
                SmallInp("[JUNCTIONS]\nK 1\nL 1\n[VALVES]\nv J K 100 PRV 3\nw K L 100 PRV 2\n"), "net.inp:12",
                "[VALVES] 'w'", "same node"},
        BadCase{"PatternUnknown", SmallInp("[DEMANDS]\nJ 1 day\n"), "net.inp:8", "[DEMANDS] 'J'",
                "no pattern 'day'"},
        BadCase{"TimeNegative", SmallInp("[TIMES]\nDuration -3\n"), "net.inp:8", "[TIMES] 'Duration'", "-3"},
        BadCase{"ControlOfCheckValve", SmallInp("Q R J 9 99 99 CV\n[CONTROLS]\nLINK Q OPEN AT TIME 3\n"),
                "net.inp:9", "[CONTROLS]", "check valve"},
        BadCase{"RuleOutOfPlace", SmallInp("[RULES]\nRULE r\nTHEN PIPE P STATUS IS OPEN\n"), "net.inp:9",
                "[RULES]", "out of place"},
        BadCase{"RuleWithoutAction", SmallInp("[RULES]\nRULE r\nIF NODE J PRESSURE > 3\n"), "net.inp:8",
                "[RULES]", "no THEN"},
        BadCase{"RuleCutByTheNext",
                SmallInp("[RULES]\nRULE r\nIF NODE J PRESSURE > 3\nRULE s\nIF NODE J PRESSURE > 3\n"
                         "THEN PIPE P STATUS IS OPEN\n"),
                "net.inp:8", "[RULES]", "'r' has no THEN"},
        BadCase{"ControlOfAnUnknownLink", SmallInp("[CONTROLS]\nLINK Z OPEN AT TIME 3\n"), "net.inp:8",
                "[CONTROLS]", "no link 'Z'"},
        BadCase{"CoordinateNoNumber", SmallInp("[COORDINATES]\nJ x 3\n"), "net.inp:8", "[COORDINATES] 'J'",
                "must be a number"},
        BadCase{"LengthBeyondDoubles", SmallInp("Q R J 1e400 100 100\n"), "net.inp:7", "[PIPES] 'Q'",
                "must be a number"},
        BadCase{"AccuracyOutOfRange", SmallInp("", "Accuracy 5\n"), "net.inp:8", "[OPTIONS] 'Accuracy'",
                "(0, 0.1]"},
        BadCase{"TimeNoTime", SmallInp("[TIMES]\nDuration soon\n"), "net.inp:8", "[TIMES] 'Duration'",
                "'soon'"},
        BadCase{"EmitterNegative", SmallInp("[EMITTERS]\nJ -1\n"), "net.inp:8", "[EMITTERS] 'J'", ">= 0"},
        BadCase{"Utf16", std::string("\xFF\xFE[\0J\0", 6), "net.inp:1", "", "byte 0"},
        BadCase{"LeakOfAPump", SmallInp("[PUMPS]\nu R J POWER 1\n[LEAKAGE]\nu 1 0\n"), "net.inp:10",
                "[LEAKAGE] 'u'", "not a pipe"}),
    [](const auto& info) { return info.param.name; });

TEST(InpReader, NoiseIsRefusedBySizeOrByItsFirstByteThatIsNoText) {
  const RandomStream stream(1, "noise", 0);
  std::string noise(100u << 20, ' ');
  for (std::size_t i = 0; i + 8 <= 4096; i += 8) {
    const std::uint64_t bits = stream.Bits(i, 0)[0];
    for (std::size_t k = 0; k < 8; ++k) noise[i + k] = static_cast<char>(bits >> (8 * k));
  }
  EXPECT_NE(ErrorOf(noise).problem().find("100 MiB"), std::string::npos);
  noise.resize(kMaxInpBytes);
  const InputError error = ErrorOf(noise);
  EXPECT_NE(error.problem(), "none");
  EXPECT_EQ(error.where().substr(0, 8), "net.inp:");
}

TEST(InpReader, EveryBeginningOfAFileReadsOrIsRefused) {
  const std::string text =
      piperun::testing::ReadText(piperun::testing::RepositoryRoot() / "assets/networks/laws_dw_cmh.inp");
  int refused = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    try {
      ReadInp(std::string_view(text).substr(0, length), "cut.inp");
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(error.where().substr(0, 7), "cut.inp") << error.what();
    }
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace piperun::sim
