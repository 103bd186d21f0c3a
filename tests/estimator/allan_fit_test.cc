#include "estimator/allan_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/random.h"
#include "estimator/nonnegative_fit.h"

namespace piperun::estimator {
namespace {

/// White noise and flicker of eight poles, one channel; sigma and decay written down from their definition.
std::vector<double> MakeRecord(std::size_t n, double period_s, double N, double B, double K,
                               std::uint64_t run) {
  const RandomStream random(3, "fit", run);
  std::array<double, 8> decay{}, drive{}, pole{};
  const double sigma = B * std::sqrt(std::numbers::ln10 / std::numbers::pi);
  for (int i = 0; i < 8; ++i) {
    decay[i] = std::exp(-period_s / std::pow(10.0, i - 2));
    drive[i] = sigma * std::sqrt(1 - decay[i] * decay[i]);
    pole[i] = sigma * random.Normals(0, 4 + static_cast<std::uint64_t>(i))[0];
  }
  std::vector<double> y(n);
  double walk = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto a = random.Normals(k, 0), b = random.Normals(k, 1), c = random.Normals(k, 2);
    double sum = N / std::sqrt(period_s) * c[0] + (walk += K * std::sqrt(period_s) * c[1]);
    for (int i = 0; i < 8 && B > 0; ++i) {
      sum += pole[i] = decay[i] * pole[i] + drive[i] * (i < 4 ? a[i] : b[i - 4]);
    }
    y[k] = sum;
  }
  return y;
}

AllanFit FitRecord(const std::vector<double>& y, double period_s, const AllanFitOptions& options = {}) {
  AllanAccumulator accumulator;
  accumulator.Append(y);
  return FitAllan(accumulator.Points(), accumulator.Segments(), period_s, options);
}

bool Covers(const FittedTerm& term, double truth) {
  return term.interval.low <= truth && truth <= term.interval.high;
}

TEST(NonnegativeFit, SolutionsKeepTheKuhnTuckerConditions) {
  const RandomStream random(11, "nnls", 0);
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Eigen::MatrixXd A(12, 5);
    Eigen::VectorXd b(12);
    for (Eigen::Index i = 0; i < 12; ++i) {
      const auto n = random.Normals(trial, static_cast<std::uint64_t>(i));
      const auto more = random.Normals(trial, 100 + static_cast<std::uint64_t>(i));
      A.row(i) << n[0], n[1], n[2], n[3], more[0];
      b(i) = more[1];
    }
    const NonnegativeFit fit = FitNonnegative(A, b);
    const Eigen::VectorXd gradient = A.transpose() * (A * fit.x - b);
    for (Eigen::Index j = 0; j < 5; ++j) {
      EXPECT_GE(fit.x(j), 0);
      EXPECT_GT(gradient(j), -1e-9);
      EXPECT_NEAR(gradient(j) * fit.x(j), 0, 1e-9);
    }
  }
}

// a lost packet every half second: the few longest stretches must not be taken for all of them
TEST(AllanFit, ManyGapsLeaveWhiteNoiseWhatItIs) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const RandomStream random(seed, "gaps", 0);
    AllanAccumulator accumulator;
    for (std::uint64_t k = 0; k < 360000; ++k) {
      if (random.Uniforms(k, 1)[0] < 0.02) {
        accumulator.StartSegment();
        continue;
      }
      const double y = 0.1 * random.SixNormals(k, 0)[0];
      accumulator.Append({&y, 1});
    }
    const AllanFit fit = FitAllan(accumulator.Points(), accumulator.Segments(), 0.01, {});
    const FittedTerm& white = fit.terms[Index(NoiseTerm::kWhite)];
    EXPECT_NEAR(white.value, 0.01, 1e-4) << seed;
    EXPECT_TRUE(white.identifiable) << seed;
    EXPECT_LT(white.interval.high - white.interval.low, 2e-4) << seed;
    EXPECT_FALSE(fit.terms[Index(NoiseTerm::kQuantisation)].identifiable) << seed;
  }
}

TEST(AllanFit, FindsEveryTermInTheCurveOfIeee952) {
  // the curve itself, without noise: hand-written continuous forms, at clusters where they equal the discrete
  const double Q = 3e-4, N = 0.01, B = 0.02, K = 2e-3, R = 2e-5, dt = 1e-4;
  std::vector<AllanPoint> points;
  for (const AllanCluster& cluster : MakeAllanClusters({12}, 100000000)) {
    if (cluster.samples < 100) continue;
    const double tau = dt * static_cast<double>(cluster.samples);
    const double V = 3 * Q * Q / tau / tau + N * N / tau + 2 * std::numbers::ln2 / std::numbers::pi * B * B +
                     K * K * tau / 3 + R * R * tau * tau / 2;
    points.push_back({cluster, 1, V});
  }
  AllanFitOptions options;
  options.flicker = FlickerForm::kIdeal;
  const std::vector<SegmentGroup> one{{1, 1000000000}};
  const NoiseModel model = FitNoiseModel(points, one, dt, options);
  const std::array<double, 5> truth{Q, N, B, K, R};
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(model.coefficients[i] / truth[i], 1, 1e-3) << i;
}

TEST(AllanFit, ANoiseFreeRampIsFoundToRounding) {
  std::vector<double> y(100000);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = 2e-5 * 0.01 * static_cast<double>(k);
  const AllanFit fit = FitRecord(y, 0.01);
  EXPECT_NEAR(fit.model.coefficients[Index(NoiseTerm::kRamp)] / 2e-5, 1, 1e-6);
}

TEST(AllanFit, IntervalsCoverTheTruthAsOftenAsTheySaySlow) {
  // Records of N and B at 10 Hz. Coverage of 95 % is binomial: standard deviation 2.2 %, bounds at 3.
  constexpr int kRecords = 100;
  int white = 0, flicker = 0, walk = 0;
  for (std::uint64_t run = 0; run < kRecords; ++run) {
    const AllanFit fit = FitRecord(MakeRecord(20000, 0.1, 0.01, 0.003, 0, run), 0.1);
    white += Covers(fit.terms[Index(NoiseTerm::kWhite)], 0.01);
    flicker += Covers(fit.terms[Index(NoiseTerm::kFlicker)], 0.003);
    walk += Covers(fit.terms[Index(NoiseTerm::kRateRandomWalk)], 0);
  }
  EXPECT_NEAR(white / double{kRecords}, 0.95, 0.066);
  EXPECT_GE(flicker / double{kRecords}, 0.884) << "a bound at zero can only help";
  EXPECT_GE(walk / double{kRecords}, 0.884);
}

TEST(AllanFit, ARealisticRateRandomWalkIsNotIdentifiableFromTwoHoursSlow) {
  const double N = 0.01, B = 10.0 / 3600, K = 1e-4;  // deg/s
  const AllanFit fit = FitRecord(MakeRecord(882472, 0.01, N, B, K, 0), 0.01);
  EXPECT_TRUE(fit.terms[Index(NoiseTerm::kWhite)].identifiable);
  EXPECT_NEAR(fit.model.coefficients[Index(NoiseTerm::kWhite)] / N, 1, 0.004);
  EXPECT_TRUE(fit.terms[Index(NoiseTerm::kFlicker)].identifiable);
  EXPECT_NEAR(fit.model.coefficients[Index(NoiseTerm::kFlicker)] / B, 1, 0.2);
  EXPECT_FALSE(fit.terms[Index(NoiseTerm::kRateRandomWalk)].identifiable);
  EXPECT_TRUE(Covers(fit.terms[Index(NoiseTerm::kRateRandomWalk)], K));
  EXPECT_FALSE(fit.terms[Index(NoiseTerm::kRamp)].identifiable);
  EXPECT_LT(fit.worst_misfit, 4);
}

TEST(AllanFit, AStrongRateRandomWalkIsIdentified) {
  const AllanFit fit = FitRecord(MakeRecord(100000, 0.01, 0.01, 0, 0.01, 0), 0.01);
  const FittedTerm& walk = fit.terms[Index(NoiseTerm::kRateRandomWalk)];
  EXPECT_TRUE(walk.identifiable);
  EXPECT_TRUE(Covers(walk, 0.01));
}

TEST(AllanFit, ANoiseThatTheTermsDoNotDescribeShows) {
  std::vector<double> y = MakeRecord(100000, 0.01, 0.001, 0, 0, 0);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] += 0.1 * std::sin(0.01 * static_cast<double>(k));
  EXPECT_GT(FitRecord(y, 0.01).worst_misfit, 10);
}

TEST(AllanFit, RefusesTooFewPointsAndDeadSensors) {
  EXPECT_THROW(FitRecord({1, 2, 3}, 0.01), InputError);
  EXPECT_THROW(FitRecord(std::vector<double>(1000, 4.5), 0.01), InputError);
}

}  // namespace
}  // namespace piperun::estimator
