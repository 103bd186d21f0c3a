#include "estimator/leak_between.h"

#include <gtest/gtest.h>

#include <cmath>

namespace piperun::estimator {
namespace {

TEST(LeakBetween, LiesHalfTheDifferenceOfTheWaysFromTheMiddle) {
  // 30 m from a and 70 m from b: sound is at b (70 - 30) / 1250 s later than at a
  const LeakBetween leak = LocateBetween({{{100, 1250}}, 0, 0}, 40.0 / 1250, 0);
  EXPECT_NEAR(leak.from_a_m, 30, 1e-12);
  EXPECT_EQ(leak.sigma_m, 0);
  EXPECT_FALSE(leak.maybe_beyond_a);
  EXPECT_FALSE(leak.maybe_beyond_b);
}

TEST(LeakBetween, AlongTwoMaterialsTakesEachAtItsSpeed) {
  // 60 m of PVC, then 125 m of iron; the leak 50 m into the iron: 0.15 + 0.04 s to a, 0.06 s to b
  const SoundWay way{{{60, 400}, {125, 1250}}, 0, 0};
  EXPECT_NEAR(CalcLength_m(way), 185, 1e-12);
  EXPECT_NEAR(CalcTravelTime_s(way), 0.25, 1e-15);
  EXPECT_NEAR(LocateBetween(way, 0.06 - 0.19, 0).from_a_m, 110, 1e-10);
}

TEST(LeakBetween, AddsUpTheVariancesOfLengthSpeedAndDelay) {
  // sigma^2 = (1 + (0.032 * 25)^2 + (1250 * 1e-3)^2) / 4, a relative sigma of the speed of 2 %
  const LeakBetween leak = LocateBetween({{{100, 1250}}, 1, 0.02}, 0.032, 1e-3);
  EXPECT_NEAR(leak.sigma_m, 0.5 * std::sqrt(1 + 0.64 + 1.5625), 1e-12);
  EXPECT_NEAR(leak.interval.high_m - leak.interval.low_m, 2 * 1.959964 * leak.sigma_m, 1e-5);
}

TEST(LeakBetween, SaysWhenTheSoundMayComeFromBeyondASensor) {
  const SoundWay way{{{100, 1000}}, 0.1, 0};
  EXPECT_TRUE(LocateBetween(way, 0.1, 1e-5).maybe_beyond_a);
  EXPECT_TRUE(LocateBetween(way, -0.1, 1e-5).maybe_beyond_b);
  EXPECT_FALSE(LocateBetween(way, 0.098, 1e-5).maybe_beyond_a);
}

}  // namespace
}  // namespace piperun::estimator
