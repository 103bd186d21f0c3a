#include "estimator/wavelet_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/check.h"
#include "base/random.h"

namespace piperun::estimator {
namespace {

constexpr double kRate_Hz = 16000;
constexpr double kScale_Pa = 1e-6;

std::vector<std::int32_t> WhiteCounts(std::size_t n, double sd_Pa) {
  const RandomStream random(1, "white", 0);
  std::vector<std::int32_t> counts(n);
  for (std::size_t i = 0; i < n; ++i)
    counts[i] = static_cast<std::int32_t>(std::lround(sd_Pa * random.Normals(i, 0)[0] / kScale_Pa));
  return counts;
}

std::vector<WaveletFrame> Cut(const std::vector<std::int32_t>& counts, std::size_t block) {
  WaveletFrames frames(BandParams{.frame_s = 0.2});
  std::vector<WaveletFrame> cut;
  for (std::size_t begin = 0; begin < counts.size(); begin += block) {
    const std::size_t size = std::min(block, counts.size() - begin);
    const RobotTime stamp(SampleOffset(static_cast<std::int64_t>(begin + size) - 1, Rate(kRate_Hz)));
    frames.Ingest({stamp, kRate_Hz, kScale_Pa, std::span(counts).subspan(begin, size)},
                  [&](const WaveletFrame& frame) { cut.push_back(frame); });
  }
  return cut;
}

TEST(WaveletStage, DetailsAndApproximationsHoldTheEnergyOfTheSignal) {
  // orthonormal: a signal that ends in silence as long as the wavelet keeps its sum of squares
  WaveletStage stage;
  const RandomStream random(2, "signal", 0);
  double in = 0, out = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    const double x = i < 990 ? random.Normals(i, 0)[0] : 0;
    in += x * x;
    if (const auto y = stage.Step(x)) out += y->detail * y->detail + y->approximation * y->approximation;
  }
  EXPECT_NEAR(out / in, 1, 1e-12);
}

TEST(WaveletStage, CubicsHaveNoDetail) {
  // four vanishing moments
  WaveletStage stage;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i;
    const auto y = stage.Step(2 - t + 0.5 * t * t - 0.1 * t * t * t);
    if (y && i > 8) {
      EXPECT_NEAR(y->detail, 0, 1e-10);
    }
  }
}

TEST(WaveletFrames, WhiteNoiseHasTheShareOfItsOctaves) {
  // middles at 5.7, 2.8, 1.4, 0.71, 0.35 kHz: 1 to 4 kHz is the band (3/8 of the power), 250 to 1000 the
  // reference (3/32). Of 10 s the first scatters by sqrt(2 / (160000 3/8)) = 0.6 %, the second by 1.2 %
  const auto frames = Cut(WhiteCounts(160000, 0.1), 1600);
  ASSERT_EQ(frames.size(), 50u);
  double power = 0, reference = 0;
  for (const WaveletFrame& frame : frames) {
    power += frame.power_Pa2 / 50;
    reference += frame.reference_power_Pa2 / 50;
  }
  EXPECT_NEAR(power / (0.01 * 3 / 8), 1, 0.024);
  EXPECT_NEAR(reference / (0.01 * 3 / 32), 1, 0.048);
}

TEST(WaveletFrames, AKnockIsImpulsiveAndGaussianNoiseIsNot) {
  auto counts = WhiteCounts(32000, 0.1);
  const std::size_t knock = 17000;  // in frame 5: 50 ms of 1 kHz, 20 dB over the noise's
  for (std::size_t i = 0; i < 800; ++i)
    counts[knock + i] += static_cast<std::int32_t>(std::lround(
        1.0 / kScale_Pa * std::sin(2 * std::numbers::pi * 1400 * static_cast<double>(i) / kRate_Hz)));
  const auto frames = Cut(counts, 1600);
  for (std::size_t n = 0; n < frames.size(); ++n) {
    if (n == 5) {
      EXPECT_GT(frames[n].impulsiveness, 10);
    } else {
      EXPECT_LT(frames[n].impulsiveness, 5) << n;  // the greatest of four octaves' in ten frames
    }
  }
}

TEST(WaveletFrames, BlockSizeChangesNoBit) {
  const auto counts = WhiteCounts(16000, 0.1);
  const auto one = Cut(counts, 16000);
  for (const std::size_t block : {std::size_t{1}, std::size_t{777}}) {
    const auto other = Cut(counts, block);
    ASSERT_EQ(other.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].time, other[i].time);
      EXPECT_EQ(one[i].power_Pa2, other[i].power_Pa2);
      EXPECT_EQ(one[i].impulsiveness, other[i].impulsiveness);
    }
  }
}

TEST(WaveletFrames, ABandWithoutAnOctaveIsRefused) {
  WaveletFrames frames(BandParams{.band_low_Hz = 1500, .band_high_Hz = 1600});
  const std::vector<std::int32_t> counts(16);
  EXPECT_THROW(frames.Ingest({RobotTime{}, kRate_Hz, 1, counts}, [](const WaveletFrame&) {}), InputError);
}

}  // namespace
}  // namespace piperun::estimator
