#include "sim/pipe_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace piperun::sim {
namespace {

/// Mean of u(radius) over a disc by brute force: equal areas around the disc's own centre.
template <class Law>
double BruteMean(const Law& law, double lambda, double offset) {
  constexpr int kRings = 600, kSectors = 600;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double s = lambda * std::sqrt((i + 0.5) / kRings);
    for (int j = 0; j < kSectors; ++j) {
      const double c = std::cos(std::numbers::pi * (j + 0.5) / kSectors);
      const double rho = std::sqrt(std::max(0.0, offset * offset + s * s + 2 * offset * s * c));
      sum += law(rho);
    }
  }
  return sum / (kRings * kSectors);
}

double BruteDiscMean(double n, double lambda, double offset) {
  const double peak = (n + 1) * (2 * n + 1) / (2 * n * n);
  return BruteMean([&](double rho) { return peak * std::pow(std::max(0.0, 1 - rho), 1 / n); }, lambda,
                   offset);
}

/// The log law for f, with its sublayer cut off where it would be negative.
double ClippedLogLaw(double f, double rho) {
  const double slope = std::sqrt(f / 8) / 0.387;
  return std::max(0.0, 1 + slope * (std::log(std::max(1e-300, 1 - rho)) + 1.5));
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

TEST(LogLaw, OfTheReferencePipeHasItsShear) {
  // f = 0.02011: u*/U = sqrt(f/8) = 0.050137, over kappa = 0.387: 0.12955; the velocity on the axis is 1
  // + 1.5 of it, and half a radius from the wall (1 + 1.5 - ln 2)
  const VelocityProfile profile = CalcVelocityProfile(1.5e5, 0.02011, ProfileLaw::kLogLaw);
  EXPECT_NEAR(profile.log_slope, 0.12955, 1e-5);
  const DiscMeanTable point(1e-3);
  EXPECT_NEAR(point.Eval(profile, 0).velocity, 1 + 1.5 * 0.12955, 1e-4);
  EXPECT_NEAR(point.Eval(profile, 0.5).velocity, 1 + (1.5 - std::numbers::ln2) * 0.12955, 1e-4);
  EXPECT_NEAR(point.Eval(profile, 0.5).gradient, -0.12955 / 0.5, 1e-3);  // a/(1 - r)
}

TEST(LogLaw, HasTheBulkSpeed) {
  // the mean over all of the bore: 1, whatever the friction
  for (const double f : {0.01, 0.02, 0.05}) {
    const VelocityProfile profile = CalcVelocityProfile(1e6, f, ProfileLaw::kLogLaw);
    // a ball of 0.95 on the axis sees int 2 r u dr / 0.95^2; what it does not see is the ring 0.95 < r < 1:
    // int 2 r (ln(1 - r) + 3/2) dr over it = -(y^2 ln y - y^2/2 - 2 y ln y + 2 y) + 3/2 (1 - 0.95^2), y =
    // 0.05
    const double y = 0.05, a = profile.log_slope, log_y = std::log(y);
    const double ring = 2 * (y * log_y - y) - (y * y * log_y - 0.5 * y * y) + 1.5 * (1 - 0.9025);
    EXPECT_NEAR(DiscMeanTable(0.95).Eval(profile, 0).velocity * 0.9025 + (1 - 0.9025) + a * ring, 1, 1e-12);
  }
}

TEST(LogLaw, SeenByABallIsTheBruteMeanAndTheSublayerDoesNotMatter) {
  for (const double f : {0.012, 0.02, 0.04}) {
    const VelocityProfile profile = CalcVelocityProfile(1e6, f, ProfileLaw::kLogLaw);
    for (const double lambda : {0.2, 0.4, 0.8}) {
      const DiscMeanTable disc(lambda);
      for (const double share : {0.0, 0.3, 0.7, 0.97, 1.0}) {
        const double offset = share * (1 - lambda);
        const double brute = BruteMean([&](double rho) { return ClippedLogLaw(f, rho); }, lambda, offset);
        EXPECT_NEAR(disc.Eval(profile, offset).velocity, brute, 1e-4) << f << " " << lambda << " " << offset;
      }
    }
  }
}

TEST(LogLaw, GradientIsTheSlopeOfTheVelocityAndFluxItsIntegral) {
  const VelocityProfile profile = CalcVelocityProfile(1e6, 0.02, ProfileLaw::kLogLaw);
  const DiscMeanTable disc(0.4);
  constexpr double kStep = 0.004;
  for (const double offset : {0.1, 0.3, 0.5}) {
    const auto brute = [&](double x) {
      return BruteMean([&](double rho) { return ClippedLogLaw(0.02, rho); }, 0.4, x);
    };
    const double slope = (brute(offset + kStep) - brute(offset - kStep)) / (2 * kStep);
    EXPECT_NEAR(disc.Eval(profile, offset).gradient, slope, 2e-3) << offset;
    double flux = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      const double x = offset * (i + 0.5) / kSteps;
      flux += disc.Eval(profile, x).velocity * x * offset / kSteps;
    }
    EXPECT_NEAR(disc.EvalFlux(profile, offset), flux, 1e-7) << offset;
  }
}

TEST(LogLaw, GoesOverIntoTheParabola) {
  // halfway between laminar and turbulent, Re = 3150: the mean of both
  const VelocityProfile profile = CalcVelocityProfile(3150, 0.04, ProfileLaw::kLogLaw);
  ASSERT_NEAR(profile.turbulent_fraction, 0.5, 1e-12);
  const DiscMeanTable disc(0.4);
  const double turbulent = disc.Eval({.turbulent_fraction = 1, .log_slope = profile.log_slope}, 0.3).velocity;
  EXPECT_NEAR(disc.Eval(profile, 0.3).velocity, 0.5 * (turbulent + 2 * (1 - 0.09 - 0.08)), 1e-12);
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
