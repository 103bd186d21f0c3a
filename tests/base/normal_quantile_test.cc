#include "base/normal_quantile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace piperun {
namespace {

constexpr std::uint32_t kHighestBit = 0x80000000;

/// x with half the complementary error function of x / sqrt 2 equal to q, by bisection.
double Bisect(double q) {
  double low = 0, high = 10;
  while (high - low > 1e-13) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(x / std::sqrt(2.0)) > q ? low : high) = x;
  }
  return low;
}

double TailOf(std::uint32_t n) { return (static_cast<double>(n & ~kHighestBit) + 0.5) / 4294967296.0; }

TEST(NormalQuantiles, InvertTheNormalDistribution) {
  const NormalQuantiles quantile;
  for (std::uint32_t n = 0; n < 300; ++n) {  // the outermost tail, cell by cell
    ASSERT_NEAR(quantile(kHighestBit | n), Bisect(TailOf(n)), 1e-10) << n;
  }
  for (std::uint64_t n = 300; n < kHighestBit; n += n / 150 + 1) {  // all pieces of all octaves
    const auto word = static_cast<std::uint32_t>(n);
    ASSERT_NEAR(quantile(kHighestBit | word), Bisect(TailOf(word)), 1e-10) << n;
  }
}

TEST(NormalQuantiles, SidesAreEachOthersImage) {
  const NormalQuantiles quantile;
  for (std::uint32_t n = 0; n < kHighestBit - 99991; n += 99991) {
    ASSERT_EQ(quantile(kHighestBit | n), -quantile(n)) << n;
    ASSERT_GT(quantile(kHighestBit | n), 0) << n;
  }
}

// tables of the normal distribution: 2.5 % beyond 1.959964, 0.1 % beyond 3.090232, 1e-6 beyond 4.753424
TEST(NormalQuantiles, AgreeWithThePrintedTable) {
  const NormalQuantiles quantile;
  const auto word = [](double q) { return static_cast<std::uint32_t>(q * 4294967296.0); };
  EXPECT_NEAR(quantile(kHighestBit | word(0.025)), 1.959964, 1e-6);
  EXPECT_NEAR(quantile(word(0.001)), -3.090232, 1e-6);
  EXPECT_NEAR(quantile(word(1e-6)), -4.753424, 3e-5);  // a cell is 5e-5 wide there
}

}  // namespace
}  // namespace piperun
