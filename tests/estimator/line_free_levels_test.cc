#include "estimator/line_free_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"

namespace piperun::estimator {
namespace {

constexpr double kRate_Hz = 16000;
constexpr std::size_t kFrame = 800;

std::vector<float> WhiteFrame(std::uint64_t n) {
  const RandomStream random(1, "white", n);
  std::vector<float> frame(kFrame);
  for (std::size_t i = 0; i < kFrame; ++i) frame[i] = static_cast<float>(random.Normals(i, 0)[0]);
  return frame;
}

/// Level in dB of each of many frames of white noise, 1 to 4 kHz.
std::vector<double> WhiteLevels_dB(int frames) {
  LineFreeLevels levels(kFrame, kRate_Hz);
  std::vector<double> level_dB;
  for (int n = 0; n < frames; ++n) {
    levels.Transform(WhiteFrame(static_cast<std::uint64_t>(n)));
    level_dB.push_back(10 * std::log10(levels.CalcMeanSquare_Pa2(1000, 4000)));
  }
  return level_dB;
}

TEST(LineFreeLevels, AToneFarAboveTheNoiseChangesNothing) {
  LineFreeLevels levels(kFrame, kRate_Hz);
  std::vector<float> frame = WhiteFrame(1);
  levels.Transform(frame);
  const double quiet = levels.CalcMeanSquare_Pa2(200, 1000);
  for (std::size_t i = 0; i < kFrame; ++i)
    frame[i] +=
        static_cast<float>(3 * std::sin(2 * std::numbers::pi * 345 * static_cast<double>(i) / kRate_Hz));
  levels.Transform(frame);
  // the tone is 4.5, the band's noise 0.1: 16.5 dB. Hann's main lobe covers 4 of 41 bins, so that the median
  // moves by at most two ranks of the exponential's order statistics: 4.343 * 2 / (41 * 0.5 * ln 2) = 0.6 dB
  EXPECT_NEAR(10 * std::log10(levels.CalcMeanSquare_Pa2(200, 1000) / quiet), 0, 1.2);
}

TEST(LineFreeLevels, NoiseThatFallsAsAssumedHasItsPower) {
  // white noise filtered by 1 / f^1.25 in a sum of cosines on the transform's own bins: power in band
  // is the sum of the squares of its amplitudes over two
  LineFreeLevels levels(kFrame, kRate_Hz);
  double sum = 0, truth = 0;
  const int frames = 400;
  for (int n = 0; n < frames; ++n) {
    const RandomStream random(2, "falling", static_cast<std::uint64_t>(n));
    std::vector<double> frame(kFrame);
    for (std::size_t k = 5; k < 399; ++k) {
      const double f_Hz = 20 * static_cast<double>(k);
      const auto normals = random.Normals(k, 0);
      const double amplitude = std::pow(f_Hz / 1000, -1.25);
      if (f_Hz >= 990 && f_Hz <= 4010) truth += amplitude * amplitude / frames;
      for (std::size_t i = 0; i < kFrame; ++i) {
        const double phase = 2 * std::numbers::pi * static_cast<double>((k * i) % kFrame) / kFrame;
        frame[i] += amplitude * (normals[0] * std::cos(phase) + normals[1] * std::sin(phase));
      }
    }
    levels.Transform(std::vector<float>(frame.begin(), frame.end()));
    sum += levels.CalcMeanSquare_Pa2(1000, 4000) / frames;
  }
  // the mean of 400 medians scatters by 0.65 dB / 20; a median of some 94 independent exponentials exceeds
  // the distribution's by 1 / (2 * 94 * ln 2) of it, and the sum over bins differs from the integral by half
  // a bin at its steep end: 0.1 dB in all
  EXPECT_NEAR(10 * std::log10(sum / truth), 0, 0.15);
}

TEST(LineFreeLevels, ScatterIsAsStated) {
  const std::vector<double> level_dB = WhiteLevels_dB(2000);
  double mean = 0, squares = 0;
  for (const double l : level_dB) mean += l / 2000;
  for (const double l : level_dB) squares += (l - mean) * (l - mean) / 1999;
  // white noise is not flat after f^2.5: fewer bins count; the standard deviation of 2000 draws is 1.6 % of
  // it
  EXPECT_NEAR(std::sqrt(squares), CalcLineFreeScatter_dB(1000, 4000, 0.05), 0.15);
}

TEST(LineFreeLevels, AToneIsPartOfThePower) {
  // a sine of amplitude 2 has the mean square 2; Hann's main lobe lies within the band
  LineFreeLevels levels(kFrame, kRate_Hz);
  std::vector<float> frame(kFrame);
  for (std::size_t i = 0; i < kFrame; ++i)
    frame[i] =
        static_cast<float>(2 * std::sin(2 * std::numbers::pi * 2000 * static_cast<double>(i) / kRate_Hz));
  levels.Transform(frame);
  EXPECT_NEAR(levels.CalcPower_Pa2(1000, 4000), 2, 1e-3);
}

TEST(LineFreeLevels, ABandBetweenTwoBinsIsNotResolved) {
  const LineFreeLevels levels(32, kRate_Hz);  // bins of 500 Hz
  EXPECT_FALSE(levels.Resolves(510, 990));
  EXPECT_TRUE(levels.Resolves(200, 1000));
}

}  // namespace
}  // namespace piperun::estimator
