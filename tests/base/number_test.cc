#include "base/number.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace piperun {
namespace {

TEST(FormatNumber, WritesTheShortestDecimalThatReadsBack) {
  EXPECT_EQ(FormatNumber(0.1), "0.1");
  EXPECT_EQ(FormatNumber(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(FormatNumber(150), "150");
  EXPECT_EQ(FormatNumber(3.5e9), "3.5e+09");
  EXPECT_EQ(FormatNumber(-0.0), "-0");
}

// every finite bit pattern, subnormals included
RC_GTEST_PROP(FormatNumber, EveryFiniteDoubleReadsBackBitForBit, (std::uint64_t bits)) {
  const double value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  const auto back = ParseNumber(FormatNumber(value));
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::bit_cast<std::uint64_t>(*back) == bits);
}

TEST(FormatNumber, TheEndsOfTheRangeReadBack) {
  using Limits = std::numeric_limits<double>;
  for (const double x :
       {Limits::max(), Limits::lowest(), Limits::min(), Limits::denorm_min(), Limits::epsilon()}) {
    EXPECT_EQ(ParseNumber(FormatNumber(x)), x);
  }
}

TEST(AppendNumber, LeavesWhatStandsBefore) {
  std::string row = "1,";
  AppendNumber(row, 2.5);
  EXPECT_EQ(row, "1,2.5");
}

TEST(ParseNumber, ReadsTheUsualSpellings) {
  EXPECT_EQ(ParseNumber("+5"), 5);
  EXPECT_EQ(ParseNumber("-1.5e-3"), -0.0015);
  EXPECT_EQ(ParseNumber("165E9"), 165e9);
  EXPECT_EQ(ParseNumber(".5"), 0.5);
  EXPECT_EQ(ParseNumber("007"), 7);
}

TEST(ParseNumber, RefusesWhatIsNotANumberFromEndToEnd) {
  for (const char* text : {"", "+", "-", "abc", "1.2.3", "5 m", " 5", "5 ", "0x10", "1e", "+-5", "++5", "1,5",
                           "inf", "-Infinity", "nan", "NaN", "1e999"}) {
    EXPECT_FALSE(ParseNumber(text).has_value()) << "'" << text << "'";
  }
}

}  // namespace
}  // namespace piperun
