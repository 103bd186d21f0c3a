#include "estimator/ricker_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace piperun::estimator {
namespace {

/// Levels every 5 cm over a way of so many metres: white scatter, a trend, and a bump.
template <class Bump>
std::vector<RickerPeak> Map(double length_m, std::uint64_t seed, Bump bump_dB) {
  std::vector<RickerPeak> peaks;
  RickerMap map({1, 0.1, 1}, [&](const RickerPeak& peak) { peaks.push_back(peak); });
  const RandomStream random(seed, "levels", 0);
  for (std::int64_t i = 0; static_cast<double>(i) * 0.05 < length_m; ++i) {
    TrackPoint ball;
    ball.chainage_m = 0.05 * static_cast<double>(i);
    ball.chainage_sd_m = 0.01;
    ball.time = RobotTime(FromSeconds(ball.chainage_m / 0.5));
    const double scatter = 0.5 * random.Normals(static_cast<std::uint64_t>(i), 0)[0];
    const double level = 30 + 0.05 * ball.chainage_m + scatter + bump_dB(ball.chainage_m);
    map.Add(ball, {level, level, 0, level});
  }
  map.Complete();
  return peaks;
}

TEST(RickerMap, FindsABumpOnATrend) {
  const auto peaks = Map(300, 1, [](double x_m) { return 5 * std::exp(-std::abs(x_m - 151.3)); });
  ASSERT_EQ(peaks.size(), 1u);
  EXPECT_NEAR(peaks[0].place.chainage_m, 151.3, 0.3);
  EXPECT_LT(peaks[0].posterior.low_m, 151.3 + 0.05);
  EXPECT_GT(peaks[0].posterior.high_m, 151.3 - 0.05);
}

TEST(RickerMap, QuietPipeGivesNoFalseAlarmSlow) {
  // 4 km at 0.1 per km: more than three would have a probability of 1 in 1000
  EXPECT_LE(Map(4000, 2, [](double) { return 0; }).size(), 3u);
}

TEST(RickerMap, ADipIsNotALeak) {
  EXPECT_TRUE(Map(300, 3, [](double x_m) { return -6 * std::exp(-0.2 * std::abs(x_m - 150)); }).empty());
}

}  // namespace
}  // namespace piperun::estimator
