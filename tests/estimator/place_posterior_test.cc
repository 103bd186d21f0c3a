#include "estimator/place_posterior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace piperun::estimator {
namespace {

constexpr double kQuantile975 = 1.959963984540054;  // of the standard normal

/// -(x - centre)^2 / (2 sd^2) at 0, step, 2 step ..
std::vector<double> Parabola(double centre_m, double sd_m, double step_m, std::size_t n) {
  std::vector<double> l;
  for (std::size_t i = 0; i < n; ++i) {
    const double off = static_cast<double>(i) * step_m - centre_m;
    l.push_back(-0.5 * off * off / (sd_m * sd_m));
  }
  return l;
}

TEST(PlacePosterior, NormalLikelihoodAndNormalTrackGiveANormal) {
  // sums of normals: sd = sqrt(0.3^2 + 0.4^2) = 0.5; the cubic passes through a parabola exactly
  const PlacePosterior p = CalcPlacePosterior(100, 0.1, Parabola(2.03, 0.3, 0.1, 41), 0.4);
  EXPECT_NEAR(p.mean_m, 102.03, 1e-6);
  EXPECT_NEAR(p.sigma_m, 0.5, 1e-4);
  EXPECT_NEAR(p.low_m, 102.03 - kQuantile975 * 0.5, 1e-3);
  EXPECT_NEAR(p.high_m, 102.03 + kQuantile975 * 0.5, 1e-3);
}

TEST(PlacePosterior, ALikelihoodNarrowerThanTheTableIsFollowedBetweenItsRows) {
  const PlacePosterior p = CalcPlacePosterior(0, 0.1, Parabola(1.037, 0.03, 0.1, 21), 0);
  EXPECT_NEAR(p.mean_m, 1.037, 1e-4);
  EXPECT_NEAR(p.sigma_m, 0.03, 5e-4);
}

TEST(PlacePosterior, TwoPlacesAlikeMakeOneWideInterval) {
  // half the probability at 1 m, half at 3 m: sd 1, and the interval holds both
  std::vector<double> l(41, -200.0);
  l[10] = l[30] = 0;
  const PlacePosterior p = CalcPlacePosterior(0, 0.1, l, 0.05);
  EXPECT_NEAR(p.mean_m, 2, 1e-9);
  EXPECT_NEAR(p.sigma_m, 1, 2e-3);
  EXPECT_LT(p.low_m, 1);
  EXPECT_GT(p.high_m, 3);
}

TEST(PlacePosterior, ASharpLikelihoodLeavesTheTracksOwnError) {
  const PlacePosterior p = CalcPlacePosterior(0, 0.1, Parabola(1, 0.02, 0.1, 21), 2);
  EXPECT_NEAR(p.sigma_m, 2, 1e-3);
  EXPECT_NEAR(p.high_m - p.low_m, 2 * kQuantile975 * 2, 2e-3);
}

TEST(PlacePosterior, NothingHeardIsUniform) {
  // over 4 m: sd 4 / sqrt(12), the interval the middle 95 %
  const PlacePosterior p = CalcPlacePosterior(0, 0.1, std::vector<double>(41, 7.0), 0);
  EXPECT_NEAR(p.sigma_m, 4 / std::sqrt(12.0), 0.005);
  EXPECT_NEAR(p.high_m - p.low_m, 3.8, 0.01);
}

}  // namespace
}  // namespace piperun::estimator
