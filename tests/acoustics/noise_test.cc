#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "acoustics/decay.h"
#include "acoustics/gaussian_frames.h"
#include "tests/acoustics/statistics.h"

namespace piperun::acoustics {
namespace {

TEST(Decay, IsTheExponentialWithinSinglePrecision) {
  for (int i = 0; i <= 20000; ++i) {
    const auto x = static_cast<float>(i) * 0.004F;
    EXPECT_NEAR(CalcDecay(x) / std::exp(-static_cast<double>(x)), 1, 2e-7) << x;
  }
  EXPECT_EQ(CalcDecay(0), 1);
}

/// A million complex normal numbers.
class ComplexNormalsTest : public testing::Test {
 protected:
  static constexpr std::size_t kDraws = 1 << 20;
  ComplexNormalsTest() : exponentials_(kDraws), phasors_(kDraws) {
    ComplexNormals().Draw(RandomStream(7, "noise", 3), 11, 0, exponentials_, phasors_);
  }
  std::vector<float> exponentials_;
  std::vector<std::complex<float>> phasors_;
};

TEST_F(ComplexNormalsTest, HaveTheMomentsOfAnExponentialModulusSquared) {
  double m1 = 0, m2 = 0, m3 = 0;
  for (const double e : exponentials_) {
    m1 += e / kDraws;
    m2 += e * e / kDraws;
    m3 += e * e * e / kDraws;
  }
  // E[e^n] = n!, its estimate has the variance ((2n)! - n!^2) / draws; four sigma
  EXPECT_NEAR(m1, 1, 4 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(m2, 2, 4 * std::sqrt((24.0 - 4) / kDraws));
  EXPECT_NEAR(m3, 6, 4 * std::sqrt((720.0 - 36) / kDraws));
}

TEST_F(ComplexNormalsTest, HaveTheTailOfAnExponential) {
  for (const double threshold : {0.1, 1.0, 3.0, 6.0, 9.0}) {
    double beyond = 0;
    for (const double e : exponentials_) beyond += e > threshold;
    const double expected = std::exp(-threshold) * kDraws;
    EXPECT_NEAR(beyond, expected, 4 * std::sqrt(expected)) << threshold;
  }
}

TEST_F(ComplexNormalsTest, HaveUniformPhasesIndependentOfTheModulus) {
  std::complex<double> m1 = 0, m2 = 0, with_modulus = 0;
  for (std::size_t i = 0; i < kDraws; ++i) {
    const std::complex<double> u(phasors_[i]);
    m1 += u;
    m2 += u * u;
    with_modulus += u * (static_cast<double>(exponentials_[i]) - 1);
  }
  // each component is a sum of `draws` terms of variance one half
  const double bound = 4 * std::sqrt(0.5 * kDraws);
  for (const auto& sum : {m1, m2, with_modulus}) {
    EXPECT_LT(std::abs(sum.real()), bound);
    EXPECT_LT(std::abs(sum.imag()), bound);
  }
}

TEST_F(ComplexNormalsTest, DifferFromSampleToSample) {
  std::vector<float> e(64);
  std::vector<std::complex<float>> u(64);
  ComplexNormals().Draw(RandomStream(7, "noise", 3), 12, 0, e, u);
  EXPECT_FALSE(std::equal(e.begin(), e.end(), exponentials_.begin()));
}

TEST(GaussianFrames, KeepTheirPowerAllAlongAFrame) {
  const std::size_t size = 64;
  GaussianFrames frames(size, 64, RandomStream(1, "a", 0));
  const std::vector<float> psd(size / 2 + 1, 2.F);
  std::vector<double> power(size / 2, 0);
  const int count = 40000;
  for (int m = 0; m <= count; ++m) {
    const auto hop = frames.Advance(m, psd);
    for (std::size_t n = 0; n < hop.size() && m > 0; ++n) power[n] += hop[n] * hop[n] / count;
  }
  // 31 bins of 1 Hz; the variance of a squared Gaussian is twice its square; 4.5 sigma over 32 places
  for (const double p : power) EXPECT_NEAR(p / (2 * 31), 1, 4.5 * std::sqrt(2.0 / count));
}

TEST(GaussianFrames, HaveTheSpectrumTheyWereAskedFor) {
  // a flat band of 40 bins: the window keeps its power and its edges within two bins
  const std::size_t size = 256;
  GaussianFrames frames(size, 256, RandomStream(1, "b", 0));
  std::vector<float> psd(size / 2 + 1, 0.F);
  for (std::size_t k = 40; k < 80; ++k) psd[k] = 1;
  std::vector<double> signal;
  for (int m = 0; m <= 20000; ++m) {
    for (const float x : frames.Advance(m, psd)) signal.push_back(x);
  }
  signal.erase(signal.begin(), signal.begin() + size / 2);
  EXPECT_NEAR(MeanSquare(signal), 40, 40 * 4 / std::sqrt(40.0 * 10000));
  const std::vector<double> measured = Welch(signal, 1024, 256);
  for (std::size_t k = 180; k < 300; k += 13) {  // a quarter of a hertz each
    EXPECT_NEAR(measured[k], 1, 4 / std::sqrt(2500.0)) << k;
  }
  EXPECT_LT(measured[120], 1e-4);
  EXPECT_LT(measured[360], 1e-4);
}

}  // namespace
}  // namespace piperun::acoustics
