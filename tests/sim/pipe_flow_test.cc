#include "sim/pipe_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace piperun::sim {
namespace {

/// Disc mean of the power law by brute force: equal areas around the disc's own centre.
double BruteDiscMean(double n, double lambda, double offset) {
  constexpr int kRings = 600, kSectors = 600;
  const double peak = (n + 1) * (2 * n + 1) / (2 * n * n);
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double s = lambda * std::sqrt((i + 0.5) / kRings);
    for (int j = 0; j < kSectors; ++j) {
      const double c = std::cos(std::numbers::pi * (j + 0.5) / kSectors);
      const double rho = std::sqrt(std::max(0.0, offset * offset + s * s + 2 * offset * s * c));
      sum += std::pow(std::max(0.0, 1 - rho), 1 / n);
    }
  }
  return peak * sum / (kRings * kSectors);
}

TEST(DiscMean, OfABallOnTheWallMatchesTheTable) {
  constexpr double kRatio[] = {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  constexpr double kTable[3][10] = {{0.747, 0.837, 0.936, 0.997, 1.040, 1.069, 1.085, 1.087, 1.077, 1.053},
                                    {0.780, 0.860, 0.946, 0.999, 1.035, 1.060, 1.074, 1.075, 1.067, 1.046},
                                    {0.805, 0.877, 0.953, 0.999, 1.031, 1.053, 1.065, 1.066, 1.059, 1.041}};
  for (int k = 0; k < 10; ++k) {
    const DiscMeanTable disc(kRatio[k]);
    for (int n = 6; n <= 8; ++n) {
      EXPECT_NEAR(disc.Eval({double(n), 1}, 1 - kRatio[k]).velocity, kTable[n - 6][k], 6e-4)
          << kRatio[k] << " n " << n;
    }
  }
}

TEST(DiscMean, OfACentredBallMatchesTheTable) {
  constexpr double kRatio[] = {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  constexpr double kCentred[] = {1.219, 1.212, 1.200, 1.186, 1.170, 1.153, 1.135, 1.113, 1.087, 1.054};
  for (int k = 0; k < 10; ++k) {
    EXPECT_NEAR(DiscMeanTable(kRatio[k]).Eval({7, 1}, 0).velocity, kCentred[k], 6e-4) << kRatio[k];
  }
}

TEST(DiscMean, MatchesBruteForceBetweenItsNodes) {
  const DiscMeanTable disc(0.4);
  for (const double n : {3.7, 6.3, 7.9, 11.1}) {
    for (const double offset : {0.003, 0.211, 0.397, 0.583, 0.6}) {
      EXPECT_NEAR(disc.Eval({n, 1}, offset).velocity, BruteDiscMean(n, 0.4, offset), 1e-4)
          << n << " " << offset;
    }
  }
}

TEST(DiscMean, GradientIsTheSlopeOfTheVelocity) {
  const DiscMeanTable disc(0.4);
  constexpr double kStep = 0.004;
  for (const double offset : {0.1, 0.3, 0.5}) {
    const double slope =
        (BruteDiscMean(7, 0.4, offset + kStep) - BruteDiscMean(7, 0.4, offset - kStep)) / (2 * kStep);
    EXPECT_NEAR(disc.Eval({7, 1}, offset).gradient, slope, 2e-3) << offset;
  }
  EXPECT_NEAR(disc.Eval({7, 1}, 0).gradient, 0, 1e-9);  // symmetry
}

TEST(DiscMean, OfLaminarFlowIsTheParabolasMean) {
  // mean of 2(1 - r^2) over a disc of radius 0.4 at 0.5: 2 (1 - 0.25 - 0.08)
  const DiscMean mean = DiscMeanTable(0.4).Eval({.turbulent_fraction = 0}, 0.5);
  EXPECT_NEAR(mean.velocity, 1.34, 1e-12);
  EXPECT_NEAR(mean.gradient, -2, 1e-12);
}

TEST(Friction, SatisfiesColebrook) {
  for (const double re : {5e3, 1.5e5, 3e6}) {
    for (const double e : {0.0, 1e-4, 6.7e-4, 0.02}) {
      const double x = 1 / std::sqrt(CalcFrictionFactor(re, e));
      EXPECT_NEAR(x, -2 * std::log10(e / 3.7 + 2.51 * x / re), 1e-12) << re << " " << e;
    }
  }
}

TEST(Friction, OfTheReferencePipeIsTheTabulatedOne) {
  EXPECT_NEAR(CalcFrictionFactor(1.5e5, 0.1e-3 / 0.15), 0.02011, 5e-6);
}

TEST(Friction, IsLaminarBelowAndContinuousThrough) {
  EXPECT_DOUBLE_EQ(CalcFrictionFactor(1000, 0.01), 0.064);
  EXPECT_EQ(CalcFrictionFactor(0, 0.01), 0);
  double before = CalcFrictionFactor(2000, 0);
  for (double re = 2001; re < 5000; re += 1) {
    const double now = CalcFrictionFactor(re, 0);
    EXPECT_NEAR(now, before, 3e-5) << re;
    before = now;
  }
}

}  // namespace
}  // namespace piperun::sim
