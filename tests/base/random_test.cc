#include "base/random.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace piperun {
namespace {

using Block = std::array<std::uint64_t, 4>;

// The three vectors "philox4x64 10" of Random123's own tests/kat_vectors (D. E. Shaw Research): all zeros,
// all ones, and the digits of pi.
TEST(Philox, GivesThePublishedKnownAnswers) {
  EXPECT_EQ(Philox4x64({0, 0, 0, 0}, {0, 0}),
            (Block{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  constexpr std::uint64_t kOnes = ~std::uint64_t{0};
  EXPECT_EQ(Philox4x64({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}));
  EXPECT_EQ(Philox4x64({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
                       {0x452821e638d01377, 0xbe5466cf34e90c6c}),
            (Block{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}));
}

// Appendix C of the FNV specification (Eastlake et al., draft-eastlake-fnv; Noll's test suite)
TEST(HashName, GivesThePublishedFnv1aVectors) {
  EXPECT_EQ(HashName(""), 0xcbf29ce484222325);
  EXPECT_EQ(HashName("a"), 0xaf63dc4c8601ec8c);
  EXPECT_EQ(HashName("b"), 0xaf63df4c8601f1a5);
  EXPECT_EQ(HashName("foobar"), 0x85944171f73967e8);
}

TEST(RandomStream, FillsWithTheWordsOfOneSlotAfterTheOther) {
  const RandomStream stream(42, "imu0", 7);
  for (const std::size_t count : {0, 1, 4, 7, 12}) {
    std::vector<std::uint64_t> words(count);
    stream.FillBits(5, 3, words);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(words[i], stream.Bits(5, 3 + i / 4)[i % 4]);
  }
}

TEST(RandomStream, IsPhiloxUnderSeedAndNameAtSampleSlotAndRun) {
  const RandomStream stream(42, "foobar", 7);
  EXPECT_EQ(stream.Bits(5, 3), Philox4x64({5, 3, 7, 0}, {42, 0x85944171f73967e8}));
}

TEST(RandomStream, EveryPartOfTheKeyAndCounterChangesTheBits) {
  std::set<Block> blocks;
  for (const std::uint64_t seed : {1, 2}) {
    for (const char* name : {"imu0", "imu1"}) {
      for (const std::uint64_t run : {0, 1}) {
        const RandomStream stream(seed, name, run);
        for (const std::uint64_t sample : {0, 1}) {
          for (const std::uint64_t slot : {0, 1}) blocks.insert(stream.Bits(sample, slot));
        }
      }
    }
  }
  EXPECT_EQ(blocks.size(), 32u);
}

constexpr int kSamples = 100'000;  // four numbers each

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

std::vector<double> DrawNormals(const RandomStream& stream, std::uint64_t first_sample, std::uint64_t slot) {
  std::vector<double> all;
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    for (const double n : stream.Normals(first_sample + k, slot)) all.push_back(n);
  }
  return all;
}

// standard error of a correlation of n independent normals: 1/sqrt(n); five of them
TEST(RandomStream, NeighboursInNameRunSampleAndSlotAreUncorrelated) {
  const auto base = DrawNormals(RandomStream(1, "imu0", 0), 0, 0);
  const double bound = 5 / std::sqrt(4.0 * kSamples);
  EXPECT_LT(std::abs(Correlation(base, DrawNormals(RandomStream(2, "imu0", 0), 0, 0))), bound) << "seed";
  EXPECT_LT(std::abs(Correlation(base, DrawNormals(RandomStream(1, "imu1", 0), 0, 0))), bound) << "name";
  EXPECT_LT(std::abs(Correlation(base, DrawNormals(RandomStream(1, "imu0", 1), 0, 0))), bound) << "run";
  EXPECT_LT(std::abs(Correlation(base, DrawNormals(RandomStream(1, "imu0", 0), 1, 0))), bound) << "sample";
  EXPECT_LT(std::abs(Correlation(base, DrawNormals(RandomStream(1, "imu0", 0), 0, 1))), bound) << "slot";
}

TEST(RandomStream, TheFourNumbersOfABlockAreUncorrelated) {
  const RandomStream stream(1, "imu0", 0);
  std::array<std::vector<double>, 4> column;
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    const auto n = stream.Normals(k, 0);
    for (std::size_t i = 0; i < 4; ++i) column[i].push_back(n[i]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_LT(std::abs(Correlation(column[i], column[j])), 5 / std::sqrt(1.0 * kSamples)) << i << ", " << j;
    }
  }
}

// Uniform: mean 1/2, variance 1/12; standard errors sqrt(1/12/n) and sqrt(1/180/n) (fourth central moment
// 1/80)
TEST(RandomStream, UniformsHaveTheMomentsOfTheUniformDistribution) {
  const RandomStream stream(3, "pressure0", 0);
  const double n = 4.0 * kSamples;
  double sum = 0, squares = 0;
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    for (const double u : stream.Uniforms(k, 0)) {
      ASSERT_GT(u, 0);
      ASSERT_LT(u, 1);
      sum += u - 0.5;
      squares += (u - 0.5) * (u - 0.5);
    }
  }
  EXPECT_NEAR(sum / n, 0, 5 * std::sqrt(1 / 12.0 / n));
  EXPECT_NEAR(squares / n, 1 / 12.0, 5 * std::sqrt(1 / 180.0 / n));
}

// Normal: moments 0, 1, 0, 3; standard errors sqrt(1, 2, 15, 96 over n)
TEST(RandomStream, NormalsHaveTheMomentsOfTheNormalDistribution) {
  const auto values = DrawNormals(RandomStream(4, "imu0", 0), 0, 0);
  const double n = static_cast<double>(values.size());
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  for (const double x : values) {
    m1 += x;
    m2 += x * x;
    m3 += x * x * x;
    m4 += x * x * x * x;
  }
  EXPECT_NEAR(m1 / n, 0, 5 * std::sqrt(1 / n));
  EXPECT_NEAR(m2 / n, 1, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(m3 / n, 0, 5 * std::sqrt(15 / n));
  EXPECT_NEAR(m4 / n, 3, 5 * std::sqrt(96 / n));
}

// the share beyond one, two and three sigma: erfc(k/sqrt(2)), binomial standard error
TEST(RandomStream, NormalsHaveTheTailsOfTheNormalDistribution) {
  const auto values = DrawNormals(RandomStream(5, "imu0", 0), 0, 0);
  const double n = static_cast<double>(values.size());
  for (const double k : {1.0, 2.0, 3.0}) {
    double beyond = 0;
    for (const double x : values) beyond += std::abs(x) > k;
    const double p = std::erfc(k / std::sqrt(2.0));
    EXPECT_NEAR(beyond / n, p, 5 * std::sqrt(p * (1 - p) / n)) << k << " sigma";
  }
}

TEST(RandomStream, SixNormalsFollowFromTheHalvesOfTheBitsByInversion) {
  const RandomStream stream(6, "turbulence", 2);
  for (std::uint64_t sample = 0; sample < 2000; ++sample) {
    const auto bits = stream.Bits(sample, 1);
    const auto n = stream.SixNormals(sample, 1);
    for (std::size_t i = 0; i < 6; ++i) {
      const std::uint64_t half = i % 2 == 0 ? bits[i / 2] >> 32 : bits[i / 2] & 0xffffffff;
      const double tail = (static_cast<double>(half & 0x7fffffff) + 0.5) / 4294967296.0;
      EXPECT_EQ(n[i] > 0, half >= 0x80000000);
      EXPECT_NEAR(0.5 * std::erfc(std::abs(n[i]) / std::sqrt(2.0)), tail, 1e-10);
    }
  }
}

TEST(RandomStream, SixNormalsHaveTheMomentsOfTheNormalDistribution) {
  const RandomStream stream(7, "turbulence", 0);
  constexpr int kSamples = 100000;
  Eigen::Matrix<double, 6, 6> second = Eigen::Matrix<double, 6, 6>::Zero();
  double fourth = 0;
  for (std::uint64_t k = 0; k < kSamples; ++k) {
    const auto n = stream.SixNormals(k, 0);
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> x(n.data());
    second += x * x.transpose() / kSamples;
    fourth += x.array().square().square().mean() / kSamples;
  }
  // variances 2/n and 1/n, 96/(6 n): five standard deviations
  const Eigen::Matrix<double, 6, 6> off = second - Eigen::Matrix<double, 6, 6>::Identity();
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 5 * std::sqrt(2.0 / kSamples));
  EXPECT_NEAR(fourth, 3, 5 * std::sqrt(16.0 / kSamples));
}

// Box and Muller by hand from the raw bits of one block
TEST(RandomStream, NormalsFollowFromTheBitsByBoxAndMuller) {
  const RandomStream stream(6, "mag0", 2);
  const auto bits = stream.Bits(9, 1);
  const auto n = stream.Normals(9, 1);
  const auto uniform = [](std::uint64_t b) { return std::ldexp(static_cast<double>(b >> 12) + 0.5, -52); };
  const double r = std::sqrt(-2 * std::log(uniform(bits[0])));
  EXPECT_DOUBLE_EQ(n[0], r * std::cos(2 * M_PI * uniform(bits[1])));
  EXPECT_DOUBLE_EQ(n[0] * n[0] + n[1] * n[1], r * r);
}

}  // namespace
}  // namespace piperun
