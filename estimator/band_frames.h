#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/measurement.h"
#include "base/params.h"
#include "estimator/biquad.h"
#include "estimator/line_free_levels.h"

namespace piperun::estimator {

struct BandParams {
  double band_low_Hz = 1000;
  double band_high_Hz = 4000;
  double reference_low_Hz = 200;
  double reference_high_Hz = 1000;
  double frame_s = 0.05;

  /// Throws InputError when a band's ends are in the wrong order.
  void Check() const;
  void Visit(ParamVisitor& v);
};

/// One short stretch of the hydrophone's record: the whole band behind a Butterworth filter, the noise in
/// both bands by LineFreeLevels.
struct BandFrame {
  RobotTime time{};                ///< its middle
  double power_Pa2 = 0;            ///< mean square in the band
  double rectified_Pa = 0;         ///< mean absolute value behind a Butterworth filter; 0 unless asked for
  double noise_Pa2 = 0;            ///< mean square in the band without its tones
  double reference_noise_Pa2 = 0;  ///< the same of the reference band

  bool silent() const { return !(power_Pa2 > 0 && noise_Pa2 > 0 && reference_noise_Pa2 > 0); }
};

/// Cuts audio into frames and measures two bands in each. Frames begin at multiples of their length, counted
/// in samples from the first one, whatever the size of the blocks: the same samples give the same bits. A
/// frame's time comes from the stamp of the block its last sample is in, less half a frame and less the group
/// delay that fourth-order filters have in the middle of the band (below a millisecond; left out).
/// Throws InputError when a band's ends are in the wrong order, (key "band_high_Hz") when a band reaches
/// beyond half the sampling rate, and when the rate changes within the record.
class BandFrames {
 public:
  using Frame = BandFrame;
  /// `rectify`: rectified_Pa is wanted, which takes a Butterworth filter.
  explicit BandFrames(const BandParams& params, bool rectify = false) : params_(params), rectify_(rectify) {
    params_.Check();
  }

  /// Calls sink(frame) for each frame that ends in this block.
  template <class Sink>
  void Ingest(const AudioBlock& block, Sink&& sink) {
    Prepare(block);
    const std::int64_t last = static_cast<std::int64_t>(block.counts.size()) - 1;
    for (std::int64_t i = 0; i <= last; ++i) {
      Accumulate(block.scale_Pa * block.counts[static_cast<std::size_t>(i)]);
      if (count_ == frame_samples_) sink(Cut(block.stamp, last - i));
    }
  }

 private:
  void Prepare(const AudioBlock& block);
  void Accumulate(double pressure_Pa) {
    if (rectify_) rectified_ += std::abs(band_.Step(pressure_Pa));
    samples_Pa_[static_cast<std::size_t>(count_++)] = static_cast<float>(pressure_Pa);
  }
  BandFrame Cut(RobotTime block_stamp, std::int64_t samples_before_stamp);

  BandParams params_;
  bool rectify_;
  double rate_Hz_ = 0;
  std::int64_t frame_samples_ = 0;
  BiquadCascade band_;
  std::optional<LineFreeLevels> spectrum_;
  std::vector<float> samples_Pa_;
  double rectified_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace piperun::estimator
