#include "estimator/allan_noise.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "estimator/allan_covariance.h"
#include "tests/support/allan.h"

namespace piperun::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

NoiseModel Only(NoiseTerm term, double coefficient, NoiseShape shape = {}) {
  NoiseModel model{shape, {}};
  model.coefficients[Index(term)] = coefficient;
  return model;
}

/// Covariance of n successive samples of a model, written down from what the terms are.
MatrixXd SampleCovariance(const NoiseModel& model, Eigen::Index n) {
  const double dt = model.shape.period_s;
  const auto c2 = [&](NoiseTerm t) { return model.coefficients[Index(t)] * model.coefficients[Index(t)]; };
  MatrixXd C(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double lag = static_cast<double>(std::abs(i - j)) * dt;
      double sum = c2(NoiseTerm::kWhite) / dt * (i == j);
      sum += c2(NoiseTerm::kQuantisation) / (dt * dt) * (i == j ? 2 : std::abs(i - j) == 1 ? -1 : 0);
      sum += c2(NoiseTerm::kRateRandomWalk) * dt * static_cast<double>(std::min(i, j));
      sum += c2(NoiseTerm::kGaussMarkov) * std::exp(-lag / model.shape.gauss_markov_time_s);
      for (int pole = -2; pole <= 5; ++pole) {
        sum += c2(NoiseTerm::kFlicker) * std::numbers::ln10 / std::numbers::pi *
               std::exp(-lag / std::pow(10.0, pole));
      }
      C(i, j) = sum;
    }
  }
  return C;
}

/// The Allan variance of n samples as a quadratic form y^T A y, differences within segments only.
MatrixXd AllanForm(const std::vector<Eigen::Index>& segments, Eigen::Index m) {
  Eigen::Index n = 0, count = 0;
  for (const Eigen::Index length : segments) n += length;
  MatrixXd A = MatrixXd::Zero(n, n);
  Eigen::Index begin = 0;
  for (const Eigen::Index length : segments) {
    for (Eigen::Index j = begin; j + 2 * m <= begin + length; ++j, ++count) {
      VectorXd z = VectorXd::Zero(n);
      z.segment(j, m).setConstant(-1);
      z.segment(j + m, m).setConstant(1);
      A += z * z.transpose();
    }
    begin += length;
  }
  return A / (2.0 * static_cast<double>(count * m * m));
}

TEST(AllanNoise, UnitVariancesAreTracesOfTheProcessCovariance) {
  const NoiseShape shape{0.04, FlickerForm::kPoles, 0.7};
  for (const NoiseTerm term : {NoiseTerm::kQuantisation, NoiseTerm::kWhite, NoiseTerm::kFlicker,
                               NoiseTerm::kRateRandomWalk, NoiseTerm::kGaussMarkov}) {
    const NoiseModel model = Only(term, 1, shape);
    for (const Eigen::Index m : {1, 2, 5, 23}) {
      const double expected = (AllanForm({2 * m}, m) * SampleCovariance(model, 2 * m)).trace();
      EXPECT_NEAR(CalcUnitAllanVariance(term, shape, m) / expected, 1, 1e-8) << Index(term) << " " << m;
    }
  }
}

TEST(AllanNoise, ContinuousLimitsAreThoseOfIeee952) {
  const NoiseShape shape{0.01, FlickerForm::kIdeal, 50};
  const std::int64_t m = 100000;
  const double tau = 1000;
  EXPECT_NEAR(CalcUnitAllanVariance(NoiseTerm::kRateRandomWalk, shape, m) / (tau / 3), 1, 1e-9);
  EXPECT_NEAR(CalcUnitAllanVariance(NoiseTerm::kRamp, shape, m), tau * tau / 2, 1e-6);
  EXPECT_NEAR(std::sqrt(CalcUnitAllanVariance(NoiseTerm::kFlicker, shape, m)), 0.664, 5e-4);
  const double T = 50;
  const double markov =
      2 * T / tau * (1 - T / (2 * tau) * (3 - 4 * std::exp(-tau / T) + std::exp(-2 * tau / T)));
  EXPECT_NEAR(CalcUnitAllanVariance(NoiseTerm::kGaussMarkov, shape, m) / markov, 1, 1e-6);
}

TEST(AllanNoise, EightPolesAreFlatWithinTheirClaim) {
  for (double tau = 0.3; tau < 1000; tau *= 1.3) {
    const double V = CalcUnitAllanVariance(NoiseTerm::kFlicker, {0.01}, std::llround(tau / 0.01));
    EXPECT_NEAR(std::sqrt(V * std::numbers::pi / (2 * std::numbers::ln2)), 1, 0.013) << tau;
  }
}

TEST(AllanNoise, SlowPolesDoNotCancel) {
  // For a m -> 0 the variance of an Ornstein-Uhlenbeck process is that of its random walk: a (2 m^2 + 1) / 3
  // m
  for (const double T : {1e3, 1e5, 1e7}) {
    const double a = 0.01 / T;
    const double V = CalcUnitAllanVariance(NoiseTerm::kGaussMarkov, {0.01, FlickerForm::kPoles, T}, 3);
    EXPECT_NEAR(V / (a * (2 * 9 + 1) / 9.0), 1, 1e-7 + 6 * a) << T;
  }
}

TEST(AllanCovariance, IsThatOfQuadraticForms) {
  NoiseModel model{{0.04, FlickerForm::kPoles, 0.7}, {0.002, 0.1, 0.4, 0.3, 0.2, 0.5}};
  const std::vector<Eigen::Index> segments{150, 90};
  const std::vector<SegmentGroup> groups{{1, 150}, {1, 90}};
  MatrixXd C = SampleCovariance(model, 240);
  C.topRightCorner(150, 90).setZero();  // the segments of a record lie far apart
  C.bottomLeftCorner(90, 150).setZero();
  VectorXd mean(240);
  for (Eigen::Index i = 0; i < 240; ++i) mean(i) = 0.2 * 0.04 * static_cast<double>(i);
  for (const Eigen::Index m1 : {1, 2, 7, 30, 60}) {
    for (const Eigen::Index m2 : {1, 3, 31, 70}) {
      const MatrixXd A1 = AllanForm(segments, m1), A2 = AllanForm(segments, m2);
      const double expected = 2 * (A1 * C * A2 * C).trace() + 4 * mean.dot(A1 * C * A2 * mean);
      const double found = CalcAllanCovariance(model, groups, {m1, 1}, {m2, 1});
      const double scale = std::sqrt(2 * (A1 * C * A1 * C).trace() * 2 * (A2 * C * A2 * C).trace());
      EXPECT_NEAR(found / scale, expected / scale, 2e-4) << m1 << " " << m2;
    }
  }
}

TEST(AllanCovariance, QuadratureEqualsTheSumLagByLag) {
  const std::vector<SegmentGroup> one{{1, 40000}};
  for (const NoiseTerm term : {NoiseTerm::kWhite, NoiseTerm::kFlicker, NoiseTerm::kRateRandomWalk}) {
    const NoiseModel model = Only(term, 1);
    for (const auto& [m1, m2] : {std::pair<std::int64_t, std::int64_t>{20, 20}, {20, 600}, {300, 600}}) {
      const DifferenceCovariance R(model, m1, m2);
      const double M1 = 40001.0 - 2 * static_cast<double>(m1), M2 = 40001.0 - 2 * static_cast<double>(m2);
      double sum = 0;
      for (double k = 1 - M1; k < M2; ++k) {
        sum += (std::min(M1, M2 - k) - std::max(0.0, -k)) * 2 * R.Eval(k) * R.Eval(k);
      }
      const double product = static_cast<double>(m1 * m2);
      const double expected = sum / (4 * product * product * M1 * M2);
      EXPECT_NEAR(CalcAllanCovariance(model, one, {m1, 1}, {m2, 1}) / expected, 1, 2e-4) << m1 << " " << m2;
    }
  }
}

/// For long records edf = a n / m. White noise: the covariance of differences is piecewise linear (1 - 3 u /
/// 2, u / 2 - 1), the integral of its square 2 / 3. Random walk: it is 3 / 2 of the cubic B-spline, whose
/// square integrates to the seventh one's middle, 151 / 315.
TEST(AllanCovariance, DegreesOfFreedomAreThoseOfIntegralsByHand) {
  const std::vector<SegmentGroup> one{{1, 10000000}};
  for (const std::int64_t m : {100, 1000}) {
    const double clusters = 1e7 / static_cast<double>(m);
    EXPECT_NEAR(CalcDegreesOfFreedom(Only(NoiseTerm::kWhite, 2), one, {m, 1}) / clusters, 1.5, 2e-3) << m;
    EXPECT_NEAR(CalcDegreesOfFreedom(Only(NoiseTerm::kRateRandomWalk, 2), one, {m, 1}) / clusters,
                315.0 / 151 * 4 / 9, 2e-3)
        << m;
  }
}

/// Formulas that Howe, Allan & Barnes (1981) fitted to simulations: NIST SP 1065, table 5.
TEST(AllanCovariance, DegreesOfFreedomAreNearThePublishedFits) {
  const std::vector<SegmentGroup> one{{1, 100000}};
  const NoiseShape ideal{0.01, FlickerForm::kIdeal};
  for (const std::size_t m : {1, 4, 16, 64, 1000, 10000}) {
    const AllanCluster cluster{static_cast<std::int64_t>(m), 1};
    EXPECT_NEAR(CalcDegreesOfFreedom(Only(NoiseTerm::kWhite, 2), one, cluster),
                testing::CalcEdfWhite(100000, m), 0.03 * testing::CalcEdfWhite(100000, m));
    EXPECT_NEAR(CalcDegreesOfFreedom(Only(NoiseTerm::kRateRandomWalk, 2), one, cluster),
                testing::CalcEdfRandomWalk(100000, m), 0.08 * testing::CalcEdfRandomWalk(100000, m));
    EXPECT_NEAR(CalcDegreesOfFreedom(Only(NoiseTerm::kFlicker, 2, ideal), one, cluster),
                testing::CalcEdfFlicker(100000, m), 0.12 * testing::CalcEdfFlicker(100000, m));
  }
}

TEST(AllanCovariance, ASingleDifferenceHasOneDegreeOfFreedom) {
  for (const NoiseTerm term : {NoiseTerm::kQuantisation, NoiseTerm::kWhite, NoiseTerm::kRateRandomWalk}) {
    const std::vector<SegmentGroup> one{{1, 20}};
    EXPECT_NEAR(CalcDegreesOfFreedom(Only(term, 1), one, {10, 1}), 1, 1e-9);
  }
}

}  // namespace
}  // namespace piperun::estimator
