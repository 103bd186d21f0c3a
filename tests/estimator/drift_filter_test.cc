#include "estimator/drift_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace piperun::estimator {
namespace {

constexpr std::int64_t kHalf = 60;
constexpr double kBin_m = 0.1;

struct Filter {
  std::vector<Roof> roofs{Roof(4, 3, 20)};
  DriftFilter filter{{}, roofs, {kHalf, kHalf, kHalf, kBin_m, 1}};
  Eigen::VectorXd levels_dB = Eigen::VectorXd::Zero(2 * (2 * kHalf + 1));
};

TEST(DriftFilter, ConstantsAndTrendsAreNothing) {
  Filter f;
  for (std::int64_t i = 0; i <= 2 * kHalf; ++i) {
    f.levels_dB[i] = 70 + 0.3 * static_cast<double>(i);
    f.levels_dB[2 * kHalf + 1 + i] = 90 - 0.2 * static_cast<double>(i);
  }
  EXPECT_NEAR(f.filter.Eval(0, f.levels_dB).z, 0, 1e-8);
}

TEST(DriftFilter, ARoofReturnsItsAmplitude) {
  Filter f;
  for (std::int64_t i = 0; i <= 2 * kHalf; ++i) {
    f.levels_dB[i] = 50 + 1.7 * f.roofs[0].Level_dB(static_cast<double>(i - kHalf) * kBin_m);
    f.levels_dB[2 * kHalf + 1 + i] = 80;
  }
  EXPECT_NEAR(f.filter.Eval(0, f.levels_dB).amplitude, 1.7, 1e-9);
}

TEST(DriftFilter, WhatWasNotHeardCountsNothing) {
  Filter f;
  const DriftFilter clipped({}, f.roofs, {kHalf, 20, kHalf, kBin_m, 1});
  for (std::int64_t i = 0; i < kHalf - 20; ++i) f.levels_dB[i] = f.levels_dB[2 * kHalf + 1 + i] = 1000;
  EXPECT_NEAR(clipped.Eval(0, f.levels_dB).z, 0, 1e-8);
}

TEST(DriftFilter, WhiteScatterGivesAStandardNormal) {
  // without drift to speak of the statistic of white levels has variance 1: 4000 draws, 5 sigma = 5
  // sqrt(2/4000)
  LevelModel model;
  model.common_drift_dB = model.own_drift_dB = 1e-3;
  Filter f;
  const DriftFilter filter(model, f.roofs, {kHalf, kHalf, kHalf, kBin_m, 1});
  const RandomStream random(1, "levels", 0);
  double squares = 0;
  for (std::uint64_t draw = 0; draw < 4000; ++draw) {
    for (std::int64_t i = 0; i <= 2 * kHalf; ++i) {
      const auto normals = random.Normals(draw, static_cast<std::uint64_t>(i));
      f.levels_dB[i] = model.band_scatter_dB * normals[0];
      f.levels_dB[2 * kHalf + 1 + i] = model.reference_scatter_dB * normals[1];
    }
    const double z = filter.Eval(0, f.levels_dB).z;
    squares += z * z;
  }
  EXPECT_NEAR(squares / 4000, 1, 0.112);
}

}  // namespace
}  // namespace piperun::estimator
