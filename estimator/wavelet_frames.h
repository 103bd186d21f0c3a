#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/measurement.h"
#include "estimator/band_frames.h"

namespace piperun::estimator {

/// One level of the discrete wavelet transform of Daubechies' orthonormal wavelet with four vanishing moments
/// (Comm. Pure Appl. Math. 41, 909, 1988, table 1): every second sample it gives a detail (the upper half of
/// its band) and an approximation (the lower half, at half the rate).
class WaveletStage {
 public:
  struct Output {
    double detail = 0, approximation = 0;
  };
  std::optional<Output> Step(double x);

 private:
  static constexpr std::size_t kTaps = 8;
  std::array<double, 2 * kTaps> last_{};  // twice over, so that the newest kTaps always lie in a row
  std::size_t next_ = 0;
};

/// One stretch of the hydrophone's record by octaves.
struct WaveletFrame {
  RobotTime time{};                ///< its middle
  double power_Pa2 = 0;            ///< mean square in the octaves of the band
  double reference_power_Pa2 = 0;  ///< and of the reference
  double impulsiveness = 0;  ///< greatest (kurtosis - 3) / sqrt(24 / n) of all these octaves: standard normal
                             ///< for Gaussian sound

  bool silent() const { return !(power_Pa2 > 0 && reference_power_Pa2 > 0); }
};

/// Cuts audio into frames and transforms each by a cascade of wavelet stages; octave j holds fs / 2^(j+1) to
/// fs / 2^j. An octave belongs to the band, or to the reference, when its geometric middle does. The kurtosis
/// of an octave's n details in a frame is m4 / m2^2; that of Gaussian noise is 3, with a standard deviation
/// of sqrt(24 / n) (Kendall & Stuart I, 12.18). Frames are a whole number of the coarsest octave's samples
/// long, and begin there counted from the first sample, whatever the size of the blocks. Throws InputError
/// (key "band_high_Hz") when no octave's middle lies in a band, and when the rate changes.
class WaveletFrames {
 public:
  using Frame = WaveletFrame;
  explicit WaveletFrames(const BandParams& params) : params_(params) { params_.Check(); }

  template <class Sink>
  void Ingest(const AudioBlock& block, Sink&& sink) {
    Prepare(block);
    const std::int64_t last = static_cast<std::int64_t>(block.counts.size()) - 1;
    for (std::int64_t i = 0; i <= last; ++i) {
      Transform(block.scale_Pa * block.counts[static_cast<std::size_t>(i)]);
      if (++count_ == frame_samples_) sink(Cut(block.stamp, last - i));
    }
  }

 private:
  enum class Use { kNone, kReference, kBand };
  struct Octave {
    WaveletStage stage;
    Use use = Use::kNone;
    double square = 0, fourth = 0;
    std::int64_t count = 0;
  };

  void Prepare(const AudioBlock& block);
  void Transform(double pressure_Pa);
  WaveletFrame Cut(RobotTime block_stamp, std::int64_t samples_before_stamp);

  BandParams params_;
  double rate_Hz_ = 0;
  std::int64_t frame_samples_ = 0;
  std::vector<Octave> octaves_;  // finest first
  std::int64_t count_ = 0;
};

}  // namespace piperun::estimator
