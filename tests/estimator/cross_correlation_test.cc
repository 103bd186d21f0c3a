#include "estimator/cross_correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "base/random.h"
#include "estimator/real_fft.h"

namespace piperun::estimator {
namespace {

constexpr double kRate_Hz = 8000;
constexpr std::size_t kSamples = 1 << 15;

struct Pair {
  std::vector<float> a, b;
};

/// Gaussian noise between 200 and 2000 Hz in both records, b later by `delay_s` (round the end to the
/// beginning), and white noise of its own in each: the shared noise's density is `snr` times the other's.
Pair MakePair(double delay_s, double snr, std::uint64_t seed) {
  const RandomStream random(seed, "pair", 0);
  const double width_Hz = kRate_Hz / kSamples;
  RealFft fft(kSamples);
  std::vector<std::complex<float>> at_a(fft.bins()), at_b(fft.bins());
  for (std::size_t k = 1; k + 1 < fft.bins(); ++k) {
    const double f_Hz = width_Hz * static_cast<double>(k);
    const auto shared = random.Normals(k, 0), own = random.Normals(k, 1);
    const double level = f_Hz > 200 && f_Hz < 2000 ? std::sqrt(snr) : 0;
    const std::complex<double> z(level * shared[0], level * shared[1]);
    at_a[k] = std::complex<float>(z + std::complex<double>(own[0], own[1]));
    at_b[k] = std::complex<float>(z * std::polar(1.0, -2 * std::numbers::pi * f_Hz * delay_s) +
                                  std::complex<double>(own[2], own[3]));
  }
  Pair pair{std::vector<float>(kSamples), std::vector<float>(kSamples)};
  fft.Inverse(at_a, pair.a);
  fft.Inverse(at_b, pair.b);
  return pair;
}

CorrelationOptions InBand(CorrelationWeight weight) {
  CorrelationOptions options;
  options.weight = weight;
  options.band_low_Hz = 200;
  options.band_high_Hz = 2000;
  options.max_delay_s = 0.02;
  return options;
}

class CorrelationBy : public testing::TestWithParam<CorrelationWeight> {};

TEST_P(CorrelationBy, FindsADelayBetweenTheSamples) {
  for (const double delay_s : {-0.0153046, -31e-6, 0.0, 0.00217}) {
    const Pair pair = MakePair(delay_s, 1000, 1);
    const DelayEstimate estimate = EstimateDelay(pair.a, pair.b, kRate_Hz, InBand(GetParam()));
    EXPECT_TRUE(estimate.correlated);
    EXPECT_LT(estimate.sigma_s, 0.05 / kRate_Hz);
    EXPECT_NEAR(estimate.delay_s, delay_s, 4 * estimate.sigma_s);
    EXPECT_GT(estimate.correlation, 0.95);
  }
}

TEST_P(CorrelationBy, ScattersAsItSaysSlow) {
  constexpr int kSeeds = 200;
  double sum = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Pair pair = MakePair(0.004321, 0.5, static_cast<std::uint64_t>(seed));
    const DelayEstimate estimate = EstimateDelay(pair.a, pair.b, kRate_Hz, InBand(GetParam()));
    ASSERT_TRUE(estimate.correlated);
    const double error = (estimate.delay_s - 0.004321) / estimate.sigma_s;
    sum += error * error;
  }
  EXPECT_NEAR(std::sqrt(sum / kSeeds), 1, 4 / std::sqrt(2.0 * kSeeds));
}

INSTANTIATE_TEST_SUITE_P(Weights, CorrelationBy,
                         testing::Values(CorrelationWeight::kNone, CorrelationWeight::kPhat,
                                         CorrelationWeight::kScot));

TEST(CrossCorrelation, TakesRecordsThatShareNothingForCorrelatedAsOftenAsItSaysSlow) {
  CorrelationOptions options = InBand(CorrelationWeight::kScot);
  options.false_alarm = 0.1;
  constexpr int kPairs = 400;
  int found = 0;
  for (int seed = 0; seed < kPairs; ++seed) {
    const Pair pair = MakePair(0, 0, static_cast<std::uint64_t>(seed));
    found += EstimateDelay(pair.a, pair.b, kRate_Hz, options).correlated;
  }
  EXPECT_NEAR(found, 0.1 * kPairs, 4 * std::sqrt(0.09 * kPairs));
}

TEST(CrossCorrelation, OfAShortBandSharedTheSidePeaksAreHigh) {
  const Pair pair = MakePair(0.004, 1000, 1);
  CorrelationOptions narrow = InBand(CorrelationWeight::kScot);
  narrow.band_low_Hz = 950;
  narrow.band_high_Hz = 1050;
  EXPECT_GT(EstimateDelay(pair.a, pair.b, kRate_Hz, narrow).side_peak, 0.9);
  EXPECT_LT(EstimateDelay(pair.a, pair.b, kRate_Hz, InBand(CorrelationWeight::kScot)).side_peak, 0.7);
}

TEST(CrossCorrelation, RefusesWhatIsNoPairOfRecords) {
  const Pair good = MakePair(0, 1, 1);
  const auto key = [&](std::span<const float> a, std::span<const float> b, double low_Hz, double high_Hz) {
    CorrelationOptions options = InBand(CorrelationWeight::kScot);
    options.band_low_Hz = low_Hz;
    options.band_high_Hz = high_Hz;
    try {
      EstimateDelay(a, b, kRate_Hz, options);
    } catch (const InputError& e) {
      return std::string(e.key_path());
    }
    return std::string("accepted");
  };
  const std::vector<float> silent(kSamples, 0.5F);
  std::vector<float> broken = good.a;
  broken[77] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(key(silent, good.b, 200, 2000), "a");
  EXPECT_EQ(key(good.a, silent, 200, 2000), "b");
  EXPECT_EQ(key(broken, good.b, 200, 2000), "a");
  EXPECT_EQ(key(std::span(good.a).first(4000), good.b, 200, 2000), "a");
  EXPECT_EQ(key(good.a, good.b, 200, 4001), "band");
  EXPECT_EQ(key(good.a, good.b, 2000, 200), "band");
  EXPECT_EQ(key(good.a, good.b, 200, 210), "band");
  EXPECT_EQ(key(good.a, good.b, 200, 2000), "accepted");
}

}  // namespace
}  // namespace piperun::estimator
