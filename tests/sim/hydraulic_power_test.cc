#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "sim/network/fixed_power.h"

namespace piperun::sim {
namespace {

class FixedPowers : public ::testing::TestWithParam<double> {};

// Roundings: two table values (the library's pow is within one ulp), their product, the inner series and its
// product, the last sum; a times that of r; and up to one for the terms cut off, (a over 6) 2^-48 < 1e-16.
TEST_P(FixedPowers, AreWithinAFewRoundingsOfTheTruePower) {
  const double exponent = GetParam();
  const FixedPower power(exponent);
  const RandomStream stream(1, "powers", 0);
  constexpr double kHalfUlp = std::numeric_limits<double>::epsilon() / 2;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    const double x = std::exp2(stream.Uniforms(i, 0)[0] * 127.9 - 63.95);
    const long double truth = std::pow(static_cast<long double>(x), static_cast<long double>(exponent));
    const auto error = static_cast<double>(std::abs(static_cast<long double>(power(x)) / truth - 1));
    ASSERT_LE(error, (8 + exponent) * kHalfUlp) << x;
  }
}

TEST_P(FixedPowers, AreThoseOfTheLibraryWhereTheTablesEnd) {
  const double exponent = GetParam();
  const FixedPower power(exponent);
  for (const double x : {0.0, 1e-300, 1e-25, 1e25, 1e300, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(power(x), std::pow(x, exponent));
  EXPECT_TRUE(std::isnan(power(-1.5)));
  EXPECT_TRUE(std::isnan(power(std::numeric_limits<double>::quiet_NaN())));
}

TEST_P(FixedPowers, HaveNoStepBetweenTheirParts) {
  const FixedPower power(GetParam());
  for (int i = 1; i <= 512; ++i) {
    const double edge = 1 + i / 128.0, below = std::nextafter(edge, 0.0);
    EXPECT_NEAR(power(below) / power(edge), 1, 2e-15) << edge;
  }
}

INSTANTIATE_TEST_SUITE_P(Exponents, FixedPowers, ::testing::Values(0.852, 0.9, 0.4, 1.7, 1.99));

}  // namespace
}  // namespace piperun::sim
