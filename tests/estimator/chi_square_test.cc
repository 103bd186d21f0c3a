#include "estimator/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace piperun::estimator {
namespace {

TEST(ChiSquare, QuantilesAreThoseOfTheTables) {
  // Abramowitz & Stegun, table 26.8, and R's qchisq for the odd ones
  EXPECT_NEAR(CalcChiSquareQuantile(0.95, 10), 18.307038, 1e-6);
  EXPECT_NEAR(CalcChiSquareQuantile(0.975, 1), 5.0238862, 1e-7);
  EXPECT_NEAR(CalcChiSquareQuantile(0.025, 1), 9.8206912e-4, 1e-11);
  EXPECT_NEAR(CalcChiSquareQuantile(0.025, 30), 16.790772, 1e-6);
  EXPECT_NEAR(CalcChiSquareQuantile(0.975, 100), 129.5612, 1e-4);
}

TEST(ChiSquare, TwoDegreesOfFreedomAreAnExponential) {
  for (const double p : {1e-6, 0.025, 0.5, 0.975, 1 - 1e-6}) {
    EXPECT_NEAR(CalcChiSquareQuantile(p, 2) / (-2 * std::log1p(-p)), 1, 1e-9) << p;
  }
}

TEST(ChiSquare, ManyDegreesOfFreedomJoinTheNormalApproximation) {
  // Wilson & Hilferty err by less than 1e-8 there, so the two branches must meet at their border
  EXPECT_NEAR(CalcChiSquareQuantile(0.975, 0.99e6) / 0.99e6, 1 + 1.959964 * std::sqrt(2 / 0.99e6), 3e-6);
  EXPECT_NEAR(CalcChiSquareQuantile(0.975, 1.01e6) / 1.01e6, 1 + 1.959964 * std::sqrt(2 / 1.01e6), 3e-6);
}

TEST(ChiSquare, NormalQuantileIsThatOfTheTables) {
  EXPECT_NEAR(CalcNormalQuantile(0.975), 1.959963985, 1e-9);
  EXPECT_NEAR(CalcNormalQuantile(0.5), 0, 1e-12);
}

TEST(ChiSquare, IntervalOfAVarianceWithoutDoubtIsAPoint) {
  const Interval sure = CalcVarianceInterval(2, std::numeric_limits<double>::infinity(), 0.95);
  EXPECT_EQ(sure.low, 2);
  EXPECT_EQ(sure.high, 2);
  const Interval one = CalcVarianceInterval(2, 1, 0.95);
  EXPECT_NEAR(one.low, 2 / 5.0238862, 1e-7);
  EXPECT_NEAR(one.high, 2 / 9.8206912e-4, 1e-4);
}

}  // namespace
}  // namespace piperun::estimator
