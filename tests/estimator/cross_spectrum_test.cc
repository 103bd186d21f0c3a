#include "estimator/cross_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"

namespace piperun::estimator {
namespace {

constexpr double kRate_Hz = 8000;
constexpr std::size_t kSamples = 1 << 16, kSegment = 256;

std::vector<float> MakeWhite(const char* name) {
  const RandomStream random(3, name, 0);
  std::vector<float> white;
  for (std::uint64_t i = 0; i < kSamples; ++i) white.push_back(static_cast<float>(random.Normals(i, 0)[0]));
  return white;
}

/// Of Hann's window with itself, `shift` samples later: what a delay leaves of the segments' correlation.
double SumHannOverlap(std::size_t shift) {
  const auto hann = [](std::size_t n) {
    const double s = std::sin(std::numbers::pi * static_cast<double>(n) / kSegment);
    return s * s;
  };
  double products = 0, squares = 0;
  for (std::size_t n = 0; n < kSegment; ++n) {
    squares += hann(n) * hann(n);
    if (n + shift < kSegment) products += hann(n) * hann(n + shift);
  }
  return products / squares;
}

TEST(CrossSpectra, OfOneRecordWithItselfAreItsDensity) {
  const std::vector<float> white = MakeWhite("white");
  double power = 0;
  for (const float x : white) power += static_cast<double>(x) * static_cast<double>(x) / kSamples;
  const CrossSpectra spectra = CalcCrossSpectra(white, white, kRate_Hz, kSegment);
  double sum = 0;
  for (std::size_t k = 0; k < spectra.bins(); ++k) {
    EXPECT_NEAR(spectra.Coherence(k), 1, 1e-9);
    sum += spectra.aa[k] * spectra.bin_width_Hz;
  }
  EXPECT_NEAR(sum / power, 1, 0.02);  // the window weighs the record's ends less
}

TEST(CrossSpectra, OfALaterRecordTurnBackwardsWithFrequency) {
  constexpr std::size_t kDelay = 12;
  const std::vector<float> white = MakeWhite("white");
  const std::span<const float> a = std::span(white).subspan(kDelay), b = std::span(white).first(a.size());
  const CrossSpectra spectra = CalcCrossSpectra(a, b, kRate_Hz, kSegment);
  const double coherence = std::pow(SumHannOverlap(kDelay), 2);
  const double sigma_rad = std::sqrt((1 - coherence) / (2 * spectra.averages * coherence));
  double mean = 0;
  for (std::size_t k = 2; k + 2 < spectra.bins(); ++k) {
    const double late_rad = 2 * std::numbers::pi * static_cast<double>(k * kDelay) / kSegment;
    EXPECT_NEAR(std::arg(spectra.ab[k] * std::polar(1.0, late_rad)), 0, 5 * sigma_rad);
    mean += spectra.UnbiasedCoherence(k) / static_cast<double>(spectra.bins() - 4);
  }
  const double sigma = std::sqrt(2 * coherence / spectra.averages) * (1 - coherence);  // of a bin
  EXPECT_NEAR(mean, coherence, 4 * sigma / std::sqrt(125 / 1.5));
}

TEST(CrossSpectra, OfALaterRecordHeldInStepAreCoherentAndInPhase) {
  constexpr std::size_t kDelay = 12;
  const std::vector<float> white = MakeWhite("white");
  const std::span<const float> late = std::span(white).first(kSamples - kDelay);
  const std::span<const float> early = std::span(white).subspan(kDelay);
  for (const bool b_is_late : {true, false}) {
    const CrossSpectra spectra =
        b_is_late ? CalcCrossSpectra(early, late, kRate_Hz, kSegment, kDelay)
                  : CalcCrossSpectra(late, early, kRate_Hz, kSegment, -static_cast<std::int64_t>(kDelay));
    for (std::size_t k = 2; k + 1 < spectra.bins(); ++k) {
      EXPECT_NEAR(spectra.Coherence(k), 1, 1e-6);
      EXPECT_NEAR(std::arg(spectra.ab[k]), 0, 1e-5);
    }
  }
}

TEST(CrossSpectra, OfNoiseInNoiseHaveTheCoherenceOfTheirShares) {
  // twice the power shared in a, half in b: C = 2 / (2 + 1) * 0.5 / (0.5 + 1)
  const std::vector<float> shared = MakeWhite("shared");
  std::vector<float> a = MakeWhite("a"), b = MakeWhite("b");
  for (std::size_t i = 0; i < kSamples; ++i) {
    a[i] += std::sqrt(2.0F) * shared[i];
    b[i] += std::sqrt(0.5F) * shared[i];
  }
  const CrossSpectra spectra = CalcCrossSpectra(a, b, kRate_Hz, kSegment);
  constexpr double kCoherence = 2.0 / 9;
  double mean = 0;
  for (std::size_t k = 1; k + 1 < spectra.bins(); ++k) mean += spectra.UnbiasedCoherence(k) / 127;
  const double sigma = std::sqrt(2 * kCoherence / spectra.averages) * (1 - kCoherence);  // of a bin
  EXPECT_NEAR(mean, kCoherence, 4 * sigma / std::sqrt(127 / 1.5));  // neighbours share through the window
}

TEST(CrossSpectra, OfRecordsThatShareNothingHaveTheBiasOfTheirAverages) {
  const CrossSpectra spectra = CalcCrossSpectra(MakeWhite("a"), MakeWhite("b"), kRate_Hz, kSegment);
  double mean = 0;
  for (std::size_t k = 1; k + 1 < spectra.bins(); ++k) mean += spectra.Coherence(k) / 127;
  EXPECT_NEAR(mean * spectra.averages, 1, 4 / std::sqrt(127 / 1.5));
}

TEST(CrossSpectra, AverageAsOftenAsTheWindowsOverlapAllows) {
  const std::vector<float> white = MakeWhite("white");
  const std::span<const float> one = std::span(white).first(kSegment);
  EXPECT_EQ(CalcCrossSpectra(one, one, kRate_Hz, kSegment).averages, 1);
  // Hann's window correlates by 0.659 a quarter and 0.167 half a length on: Harris, Proc. IEEE 66, 51 (1978)
  const double count = static_cast<double>(CountSegments(kSamples, kSamples, kSegment));
  EXPECT_NEAR(CalcCrossSpectra(white, white, kRate_Hz, kSegment).averages * (1 + 2 * (0.434 + 0.028)) / count,
              1, 2e-3);
}

TEST(CrossSpectra, CountTheSegmentsThatFitBothRecords) {
  EXPECT_EQ(CountSegments(1000, 2000, 256), 12);      // (1000 - 256) / 64 = 11.6
  EXPECT_EQ(CountSegments(1000, 1000, 256, 300), 7);  // 700 in common: 444 / 64 = 6.9
  EXPECT_EQ(CountSegments(1000, 1000, 256, -300), 7);
  EXPECT_EQ(CountSegments(256, 256, 256), 1);
  EXPECT_EQ(CountSegments(256, 256, 256, 1), 0);
  EXPECT_EQ(CountSegments(256, 256, 256, -256), 0);
}

}  // namespace
}  // namespace piperun::estimator
