#include "acoustics/inverse_fft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"

namespace piperun::acoustics {
namespace {

class InverseRealFftOfSize : public testing::TestWithParam<std::size_t> {};

/// The sum as it is written in inverse_fft.h, in double precision.
double SumUp(const std::vector<std::complex<float>>& spectrum, std::size_t size, std::size_t n) {
  double sum = static_cast<double>(spectrum.front().real()) +
               (n % 2 == 0 ? 1 : -1) * static_cast<double>(spectrum.back().real());
  for (std::size_t k = 1; k < size / 2; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k * n % size) / static_cast<double>(size);
    sum += 2 * (std::complex<double>(spectrum[k]) * std::polar(1.0, angle)).real();
  }
  return sum;
}

TEST_P(InverseRealFftOfSize, IsItsDefinition) {
  const std::size_t size = GetParam();
  const RandomStream random(1, "fft", 0);
  std::vector<std::complex<float>> spectrum;
  for (std::size_t k = 0; k <= size / 2; ++k) {
    const auto z = random.Normals(k, 0);
    spectrum.emplace_back(static_cast<float>(z[0]), static_cast<float>(z[1]));
  }
  std::vector<float> signal(size);
  InverseRealFft fft(size);
  fft.Transform(spectrum, signal);
  double error = 0, power = 0;
  for (std::size_t n = 0; n < size; ++n) {
    const double expected = SumUp(spectrum, size, n), got = static_cast<double>(signal[n]);
    error += (got - expected) * (got - expected);
    power += expected * expected;
  }
  EXPECT_LT(10 * std::log10(error / power), -130);  // a few roundings of 2^-24 = -144 dB each
}

TEST_P(InverseRealFftOfSize, TakesOnlyTheRealPartsOfTheEnds) {
  const std::size_t size = GetParam();
  std::vector<std::complex<float>> spectrum(size / 2 + 1);
  spectrum.front() = {2, 5};
  spectrum.back() = {1, -7};
  std::vector<float> signal(size);
  InverseRealFft fft(size);
  fft.Transform(spectrum, signal);
  for (std::size_t n = 0; n < size; ++n) EXPECT_FLOAT_EQ(signal[n], n % 2 == 0 ? 3 : 1);
}

INSTANTIATE_TEST_SUITE_P(PowersOfTwo, InverseRealFftOfSize,
                         testing::Values(32, 64, 128, 512, 1024, 2048, 4096));

}  // namespace
}  // namespace piperun::acoustics
