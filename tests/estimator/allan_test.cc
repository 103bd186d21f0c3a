#include "estimator/allan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/random.h"
#include "tests/support/allan.h"

namespace piperun::estimator {
namespace {

std::vector<double> WhiteRecord(std::size_t n, double mean, std::uint64_t run = 0) {
  const RandomStream random(7, "allan", run);
  std::vector<double> y(n);
  for (std::size_t k = 0; k < n; ++k) y[k] = mean + random.Normals(k, 0)[0];
  return y;
}

TEST(Allan, AgreesWithTheTextbookAtEveryClusterWhateverTheChunks) {
  const std::vector<double> y = WhiteRecord(30001, 9.81);
  AllanAccumulator accumulator;
  std::span<const double> rest = y;
  for (std::size_t chunk = 1; !rest.empty(); chunk = chunk * 3 + 1) {
    const auto part = rest.first(std::min(chunk, rest.size()));
    accumulator.Append(part);
    rest = rest.subspan(part.size());
  }
  const auto points = accumulator.Points();
  EXPECT_EQ(points.size(), MakeAllanClusters({}, 15000).size());
  for (const AllanPoint& point : points) {
    const auto m = static_cast<std::size_t>(point.cluster.samples);
    EXPECT_EQ(point.count, static_cast<std::int64_t>(y.size() + 1 - 2 * m));
    EXPECT_NEAR(point.variance / testing::CalcAllanVariance(y, m), 1, 1e-9) << m;
  }
}

TEST(Allan, AgreesWithTheTextbookForTheRecordOfSourceDSlow) {
  const std::vector<double> y = WhiteRecord(882472, -0.05);
  const auto points = CalcAllanVariance(y);
  EXPECT_EQ(points.size(), 93U);
  EXPECT_GT(points.back().cluster.samples, 380000);
  for (const AllanPoint& point : points) {
    const auto m = static_cast<std::size_t>(point.cluster.samples);
    EXPECT_NEAR(point.variance / testing::CalcAllanVariance(y, m), 1, 1e-9) << m;
  }
}

/// Overlapping Allan deviations of the 1000-point test suite, NIST SP 1065 (2008), table 31: frequencies from
/// the prime-modulus generator n' = 16807 n mod 2147483647, n0 = 1234567890.
TEST(Allan, ReproducesThePublishedTestSuite) {
  std::vector<double> y;
  std::int64_t n = 1234567890;
  for (int i = 0; i < 1000; ++i) {
    y.push_back(static_cast<double>(n) / 2147483647.0);
    n = 16807 * n % 2147483647;
  }
  const std::map<std::int64_t, double> published{{1, 2.922319e-1}, {10, 9.159953e-2}, {100, 3.241343e-2}};
  std::size_t found = 0;
  for (const AllanPoint& point : CalcAllanVariance(y)) {
    const auto row = published.find(point.cluster.samples);
    if (row == published.end()) continue;
    EXPECT_NEAR(std::sqrt(point.variance) / row->second, 1, 2e-7);
    ++found;
  }
  EXPECT_EQ(found, published.size());
}

TEST(Allan, NoDifferenceReachesOverAGap) {
  const std::vector<double> a = WhiteRecord(700, 0, 1), b = WhiteRecord(400, 50, 2);
  AllanAccumulator accumulator;
  accumulator.Append(a);
  accumulator.StartSegment();
  accumulator.StartSegment();  // a gap within a gap is one gap
  accumulator.Append(b);
  for (const AllanPoint& point : accumulator.Points()) {
    const auto m = static_cast<std::size_t>(point.cluster.samples);
    const double in_a = static_cast<double>(a.size() + 1 - 2 * m);
    const double in_b = 2 * m <= b.size() ? static_cast<double>(b.size() + 1 - 2 * m) : 0;
    double sum = in_a * testing::CalcAllanVariance(a, m);
    if (in_b > 0) sum += in_b * testing::CalcAllanVariance(b, m);
    EXPECT_NEAR(point.variance / (sum / (in_a + in_b)), 1, 1e-9) << m;
  }
  const auto segments = accumulator.Segments();
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].samples, 700);
  EXPECT_EQ(segments[1].samples, 400);
}

TEST(Allan, BeyondFullOverlapTheStrideIsAPartOfTheCluster) {
  for (const AllanCluster& cluster : MakeAllanClusters({18, 4096}, std::int64_t{1} << 34)) {
    if (cluster.samples <= 4096) {
      EXPECT_EQ(cluster.stride, 1);
    } else {
      EXPECT_EQ(cluster.samples % cluster.stride, 0);
      EXPECT_GE(cluster.samples / cluster.stride, 256);
      EXPECT_LE(cluster.samples / cluster.stride, 512);
    }
  }
}

TEST(Allan, StridesAreThoseOfTheTextbookWithFewerDifferences) {
  const std::vector<double> y = WhiteRecord(20000, 3);
  const auto points = CalcAllanVariance(y, {18, 512});
  ASSERT_GT(points.back().cluster.stride, 4);
  std::vector<double> theta(y.size() + 1, 0);
  for (std::size_t i = 0; i < y.size(); ++i) theta[i + 1] = theta[i] + y[i];
  for (const AllanPoint& point : points) {
    const auto m = static_cast<std::size_t>(point.cluster.samples);
    const auto stride = static_cast<std::size_t>(point.cluster.stride);
    double sum = 0, count = 0;
    for (std::size_t j = 0; j + 2 * m < theta.size(); j += stride, ++count) {
      const double d = theta[j + 2 * m] - 2 * theta[j + m] + theta[j];
      sum += d * d;
    }
    const double expected = sum / (2 * count * static_cast<double>(m * m));
    EXPECT_NEAR(point.variance / expected, 1, 1e-8) << m;
  }
}

/// The covariance of overlapping second differences of white noise is piecewise linear in the lag: 2 m - 3 k
/// up to m, k - 2 m up to 2 m. Var V is proportional to the stride times the sum of its squares over the lags
/// taken.
TEST(Allan, AStrideOfACluster256thCostsNoConfidence) {
  const double m = 4096;
  const auto squared = [m](double k) {
    const double R = k < m ? 2 * m - 3 * k : k < 2 * m ? k - 2 * m : 0;
    return R * R;
  };
  const auto variance = [&](double stride) {
    double sum = squared(0);
    for (double k = stride; k < 2 * m; k += stride) sum += 2 * squared(k);
    return stride * sum;
  };
  EXPECT_NEAR(variance(16) / variance(1), 1, 1e-4);
  EXPECT_GT(variance(m) / variance(1), 1.3) << "without overlap a third is lost";
}

TEST(Allan, AnEmptyRecordHasNoPoints) {
  EXPECT_TRUE(AllanAccumulator().Points().empty());
  EXPECT_TRUE(CalcAllanVariance(std::vector<double>{1.0}).empty());
  EXPECT_EQ(CalcAllanVariance(std::vector<double>{1.0, 3.0}).at(0).variance, 2);
}

}  // namespace
}  // namespace piperun::estimator
