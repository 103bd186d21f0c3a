#include "scenarios/physical_unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::scenarios {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGravity = 9.80665;

struct UnitCase {
  const char* text;
  double si;
  const char* unit;
};

// By hand: an hour is 3600 s, sqrt(h) 60 sqrt(s), g = 9.80665 m/s^2, 1 / sqrt(Hz) = sqrt(s).
const UnitCase kCases[] = {
    {"deg/h", kDegree / 3600, "rad/s"},
    {"deg/sqrt(h)", kDegree / 60, "rad/s/sqrt(Hz)"},
    {"deg/s/sqrt(Hz)", kDegree, "rad/s/sqrt(Hz)"},
    {"\xC2\xB0/s/\xE2\x88\x9AHz", kDegree, "rad/s/sqrt(Hz)"},
    {"dps/rtHz", kDegree, "rad/s/sqrt(Hz)"},
    {"mdps/sqrt(Hz)", 1e-3 * kDegree, "rad/s/sqrt(Hz)"},
    {"deg/h/sqrt(h)", kDegree / 216000, "rad/s^2/sqrt(Hz)"},
    {"rad s^-1", 1, "rad/s"},
    {"m s^-2", 1, "m/s^2"},
    {"g", kGravity, "m/s^2"},
    {"\xC2\xB5g/\xE2\x88\x9AHz", 1e-6 * kGravity, "m/s^2/sqrt(Hz)"},
    {"m/s/sqrt(h)", 1.0 / 60, "m/s^2/sqrt(Hz)"},
    {"m/s^2/sqrt(Hz)", 1, "m/s^2/sqrt(Hz)"},
    {"ppm", 1e-6, "1"},
    {"%", 0.01, "1"},
    {"mG", 1e-7, "T"},
    {"arcsec", kDegree / 3600, "rad"},
    {"deg/s/g", kDegree / kGravity, "rad s/m"},
};

TEST(PhysicalUnit, DataSheetUnitsAreWorthWhatTheyAreByHand) {
  for (const UnitCase& c : kCases) {
    const PhysicalUnit unit = ParseUnit(c.text, "");
    EXPECT_NEAR(unit.factor / c.si, 1, 1e-14) << c.text;
    EXPECT_EQ(SiUnitText(unit), c.unit) << c.text;
  }
}

TEST(PhysicalUnit, EveryListedDataSheetUnitMeasuresItsQuantity) {
  for (const char* si : {"1", "rad", "rad/s", "rad/s/sqrt(Hz)", "rad/s^2", "rad/s^2/sqrt(Hz)", "m/s", "m/s^2",
                         "m/s^2/sqrt(Hz)", "m/s^3", "m/s^3/sqrt(Hz)", "T", "T/sqrt(Hz)", "Pa", "rad s/m"}) {
    EXPECT_FALSE(DataSheetUnits(ParseUnit(si, "")).empty()) << si;
    for (const auto other : DataSheetUnits(ParseUnit(si, "")))
      EXPECT_EQ(SiUnitText(ParseUnit(other, "")), si) << other;
  }
}

TEST(PhysicalUnit, FullScaleAndCountsReferToTheRange) {
  const FullScale scale{2000 * kDegree, "rad/s", 16};
  EXPECT_NEAR(ConvertToSi(0.1, "%FS", scale).value, 2 * kDegree, 1e-15);
  EXPECT_NEAR(ConvertToSi(1, "LSB", scale).value, 4000 * kDegree / 65536, 1e-15);
  const SiValue density = ConvertToSi(2, "LSB/sqrt(Hz)", scale);
  EXPECT_EQ(SiUnitText(density.unit), "rad/s/sqrt(Hz)");
  EXPECT_THROW(ConvertToSi(1, "LSB", {}), InputError);
  EXPECT_THROW(ConvertToSi(1, "LSB", {1, "m/s^2", {}}), InputError);
}

TEST(PhysicalUnit, UnknownUnitsAreNamed) {
  for (const char* text : {"dge/s", "", "/", "deg/", "sqrt", "m^x", "furlong"}) {
    EXPECT_THROW(ParseUnit(text, "--unit"), InputError) << text;
  }
  try {
    ParseUnit("dge/s", "--unit");
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'dge'"), std::string::npos);
  }
}

}  // namespace
}  // namespace piperun::scenarios
