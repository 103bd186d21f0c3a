#include "estimator/band_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/number.h"

namespace piperun::estimator {
namespace {

void CheckBand(double low_Hz, double high_Hz, const char* key) {
  if (low_Hz < high_Hz) return;
  throw InputError("a band from " + FormatNumber(low_Hz) + " Hz to " + FormatNumber(high_Hz) +
                       " Hz is empty; its lower end must lie below its upper end",
                   key);
}

}  // namespace

void BandParams::Visit(ParamVisitor& v) {
  v.Number({"band_low_Hz", "Lower end of the band the leak is listened for in."}, Range::Positive(),
           band_low_Hz);
  v.Number({"band_high_Hz", "Its upper end."}, Range::Positive(), band_high_Hz);
  v.Number({"reference_low_Hz", "Lower end of the band that tells the background."}, Range::Positive(),
           reference_low_Hz);
  v.Number({"reference_high_Hz", "Its upper end."}, Range::Positive(), reference_high_Hz);
  v.Number({"frame_s", "Length of the frames that band energies are measured in."}, Range::Between(0.002, 1),
           frame_s);
}

void BandParams::Check() const {
  CheckBand(band_low_Hz, band_high_Hz, "band_low_Hz");
  CheckBand(reference_low_Hz, reference_high_Hz, "reference_low_Hz");
}

void BandFrames::Prepare(const AudioBlock& block) {
  if (rate_Hz_ == block.rate_Hz) return;
  if (rate_Hz_ != 0) {
    throw InputError("the audio rate changes from " + FormatNumber(rate_Hz_) + " Hz to " +
                     FormatNumber(block.rate_Hz) + " Hz within the record");
  }
  if (!(std::max(params_.band_high_Hz, params_.reference_high_Hz) < 0.5 * block.rate_Hz)) {
    throw InputError("the hydrophone's " + FormatNumber(block.rate_Hz) + " Hz carry sound below " +
                         FormatNumber(0.5 * block.rate_Hz) + " Hz only; lower the band",
                     "band_high_Hz");
  }
  rate_Hz_ = block.rate_Hz;
  frame_samples_ = std::llround(params_.frame_s * rate_Hz_);
  samples_Pa_.resize(static_cast<std::size_t>(frame_samples_));
  spectrum_.emplace(samples_Pa_.size(), rate_Hz_);
  for (const auto& [low_Hz, high_Hz] : {std::pair{params_.band_low_Hz, params_.band_high_Hz},
                                        std::pair{params_.reference_low_Hz, params_.reference_high_Hz}}) {
    if (spectrum_->Resolves(low_Hz, high_Hz)) continue;
    throw InputError(FormatNumber(params_.frame_s) + " s do not resolve " + FormatNumber(low_Hz) + " to " +
                         FormatNumber(high_Hz) + " Hz; lengthen the frames",
                     "frame_s");
  }
  band_ = ButterworthBand(params_.band_low_Hz, params_.band_high_Hz, rate_Hz_);
}

BandFrame BandFrames::Cut(RobotTime block_stamp, std::int64_t samples_before_stamp) {
  const double n = static_cast<double>(count_);
  const Duration to_last = SampleOffset(samples_before_stamp, Rate(rate_Hz_));
  const Duration half_frame = SampleOffset(count_ - 1, Rate(rate_Hz_)) / 2;
  spectrum_->Transform(samples_Pa_);
  const BandFrame frame{
      block_stamp - to_last - half_frame,
      spectrum_->CalcPower_Pa2(params_.band_low_Hz, params_.band_high_Hz),
      rectified_ / n,
      spectrum_->CalcMeanSquare_Pa2(params_.band_low_Hz, params_.band_high_Hz),
      spectrum_->CalcMeanSquare_Pa2(params_.reference_low_Hz, params_.reference_high_Hz),
  };
  rectified_ = 0;
  count_ = 0;
  return frame;
}

}  // namespace piperun::estimator
