#include "estimator/wavelet_frames.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"

namespace piperun::estimator {
namespace {

/// Scaling coefficients h_0 .. h_7; the wavelet's are g_k = (-1)^k h_(7-k).
constexpr std::array<double, 8> kScaling = {0.23037781330885523,  0.7148465705525415,   0.6308807679295904,
                                            -0.02798376941698385, -0.18703481171888114, 0.030841381835986965,
                                            0.032883011666982945, -0.010597401784997278};

}  // namespace

std::optional<WaveletStage::Output> WaveletStage::Step(double x) {
  const std::size_t slot = next_ % kTaps;
  last_[slot] = last_[slot + kTaps] = x;
  ++next_;
  if (next_ % 2 != 0) return std::nullopt;
  const double* oldest = last_.data() + (slot + 1) % kTaps;
  Output output;
  for (std::size_t k = 0; k < kTaps; ++k) {
    output.approximation += kScaling[k] * oldest[kTaps - 1 - k];
    output.detail +=
        (k % 2 == 0 ? kScaling[kTaps - 1 - k] : -kScaling[kTaps - 1 - k]) * oldest[kTaps - 1 - k];
  }
  return output;
}

void WaveletFrames::Prepare(const AudioBlock& block) {
  if (block.rate_Hz == rate_Hz_) return;
  if (rate_Hz_ != 0) {
    throw InputError("the sampling rate changes from " + FormatNumber(rate_Hz_) + " to " +
                     FormatNumber(block.rate_Hz) + " Hz within the record");
  }
  rate_Hz_ = block.rate_Hz;
  bool band = false, reference = false;
  for (double top_Hz = 0.5 * rate_Hz_; top_Hz > params_.reference_low_Hz; top_Hz *= 0.5) {
    const double middle_Hz = top_Hz / std::sqrt(2.0);
    Octave octave;
    if (params_.band_low_Hz <= middle_Hz && middle_Hz <= params_.band_high_Hz) {
      octave.use = Use::kBand;
      band = true;
    } else if (params_.reference_low_Hz <= middle_Hz && middle_Hz <= params_.reference_high_Hz) {
      octave.use = Use::kReference;
      reference = true;
    }
    octaves_.push_back(octave);
  }
  if (!band || !reference) {
    throw InputError("the octaves below " + FormatNumber(0.5 * rate_Hz_) +
                         " Hz have none whose middle lies in " + (band ? "the reference band" : "the band") +
                         "; widen it",
                     "band_high_Hz");
  }
  const double coarsest = std::ldexp(1.0, static_cast<int>(octaves_.size()));
  frame_samples_ = std::llround(std::max(1.0, std::round(params_.frame_s * rate_Hz_ / coarsest)) * coarsest);
}

void WaveletFrames::Transform(double pressure_Pa) {
  double x = pressure_Pa;
  for (Octave& octave : octaves_) {
    const auto output = octave.stage.Step(x);
    if (!output) return;
    const double square = output->detail * output->detail;
    octave.square += square;
    octave.fourth += square * square;
    ++octave.count;
    x = output->approximation;
  }
}

WaveletFrame WaveletFrames::Cut(RobotTime block_stamp, std::int64_t samples_before_stamp) {
  const Duration to_last = SampleOffset(samples_before_stamp, Rate(rate_Hz_));
  WaveletFrame frame{block_stamp - to_last - SampleOffset(count_ - 1, Rate(rate_Hz_)) / 2};
  for (Octave& octave : octaves_) {
    const double n = static_cast<double>(octave.count);
    if (octave.use != Use::kNone && octave.square > 0) {
      // orthonormal: details' squares add up to the octave's energy
      (octave.use == Use::kBand ? frame.power_Pa2 : frame.reference_power_Pa2) +=
          octave.square / static_cast<double>(count_);
      const double kurtosis = n * octave.fourth / (octave.square * octave.square);
      frame.impulsiveness = std::max(frame.impulsiveness, (kurtosis - 3) / std::sqrt(24 / n));
    }
    octave.square = octave.fourth = 0;
    octave.count = 0;
  }
  count_ = 0;
  return frame;
}

}  // namespace piperun::estimator
