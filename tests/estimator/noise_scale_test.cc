#include "estimator/noise_scale.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace piperun::estimator {
namespace {

constexpr std::int64_t kBins = 10000;

/// Normal values of a standard deviation, every tenth replaced by `odd` if that is above zero.
NoiseScale Fill(double sd, double odd) {
  NoiseScale scale(kBins, 100);
  const RandomStream random(1, "z", 0);
  for (std::int64_t i = 0; i < kBins; ++i) {
    const double normal = sd * random.Normals(static_cast<std::uint64_t>(i), 0)[0];
    scale.Add(i, odd > 0 && i % 10 == 0 ? odd : normal);
  }
  return scale;
}

TEST(NoiseScale, IsTheStandardDeviation) {
  // a median of n absolute normals has the relative standard deviation 1.17 / sqrt(n): 1.2 %
  EXPECT_NEAR(*Fill(1, 0).Calc(0, kBins), 1, 0.04);
  EXPECT_NEAR(*Fill(2.5, 0).Calc(0, kBins), 2.5, 0.1);
}

TEST(NoiseScale, WhatStandsOutDoesNotCount) { EXPECT_NEAR(*Fill(1, 20).Calc(0, kBins), 1, 0.04); }

TEST(NoiseScale, MoreThanHalfMayStandOut) {
  NoiseScale scale(kBins, 100);
  const RandomStream random(1, "z", 0);
  for (std::int64_t i = 0; i < kBins; ++i)
    scale.Add(i, i % 3 == 0 ? random.Normals(static_cast<std::uint64_t>(i), 0)[0]
                            : 8 + 0.001 * static_cast<double>(i));
  EXPECT_NEAR(*scale.Calc(0, kBins), 1, 0.07);
}

TEST(NoiseScale, FarMoreThanExpectedIsFound) { EXPECT_NEAR(*Fill(10, 0).Calc(0, kBins), 10, 0.4); }

TEST(NoiseScale, OldValuesAndThoseOutsideAreForgotten) {
  NoiseScale scale(1000, 100);
  const RandomStream random(1, "z", 0);
  for (std::int64_t i = 0; i < 3000; ++i)
    scale.Add(i, (i < 2000 ? 50 : 1) * random.Normals(static_cast<std::uint64_t>(i), 0)[0]);
  EXPECT_NEAR(*scale.Calc(0, 3000), 1, 0.15);
  EXPECT_FALSE(scale.Calc(0, 2050));
}

TEST(NoiseScale, WhatIsForgottenDoesNotCount) {
  NoiseScale scale = Fill(1, 0);
  scale.Forget(100, kBins - 50);
  EXPECT_TRUE(scale.Calc(0, kBins));
  EXPECT_FALSE(scale.Calc(60, kBins));
}

TEST(NoiseScale, GapsDoNotCount) {
  NoiseScale scale(1000, 100);
  const RandomStream random(1, "z", 0);
  for (std::int64_t i = 0; i < 500; ++i) scale.Add(i, random.Normals(static_cast<std::uint64_t>(i), 0)[0]);
  scale.Add(100000, 1);
  EXPECT_FALSE(scale.Calc(0, 100001));
}

}  // namespace
}  // namespace piperun::estimator
