#include "acoustics/hydrophone.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "acoustics/gaussian_frames.h"
#include "acoustics/listener_spectrum.h"
#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

constexpr double kFrame_s = 0.064;

/// The power of two nearest to 64 ms, by ratio.
std::size_t CalcFrameSize(double rate_Hz) {
  return std::size_t{1} << std::lround(std::log2(kFrame_s * rate_Hz));
}

void RequireRange(double value, const Range& range, const char* key) {
  if (std::isfinite(value) && range.Contains(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; the range is " + range.Text(), key);
}

const HydrophoneParams& Checked(const HydrophoneParams& p) {
  RequireRange(p.rate_Hz, Range::Between(1000, 384000), "rate_Hz");
  RequireRange(p.full_scale_Pa, Range::Positive(), "full_scale_Pa");
  RequireRange(p.high_pass_Hz, Range::NonNegative(), "high_pass_Hz");
  RequireRange(p.face_radius_m, Range::Between(0, 0.1), "face_radius_m");
  RequireRange(p.self_noise_dB_re_1uPa2_Hz, Range::Between(-200, 200), "self_noise_dB_re_1uPa2_Hz");
  if (p.bits != 16 && p.bits != 24) {
    throw InputError(std::to_string(p.bits) + " is not allowed; a converter has 16 or 24 bits", "bits");
  }
  return p;
}

}  // namespace

class Hydrophone::Impl {
 public:
  Impl(const HydrophoneParams& params, const AcousticScene& scene, const RandomStream& random)
      : rate_(Checked(params).rate_Hz),
        counts_per_Pa_(1 / params.scale_Pa()),
        largest_code_((std::int64_t{1} << (params.bits - 1)) - 1),
        frames_(CalcFrameSize(params.rate_Hz), params.rate_Hz, random),
        spectrum_(scene, params, frames_.bin_width_Hz(), frames_.bins()),
        psd_(frames_.bins()) {}

  Rate rate() const { return rate_; }
  std::int64_t hop_samples() const { return static_cast<std::int64_t>(frames_.hop()); }
  std::int64_t clipped_samples() const { return clipped_samples_; }

  void Render(const ListenerAt& listener, std::span<std::int32_t> counts) {
    if (next_frame_ == 0) AdvanceFrame(listener);  // what frame 0 completes lies before sample 0
    while (!counts.empty()) {
      if (ready_.empty()) ready_ = AdvanceFrame(listener);
      const std::size_t n = std::min(counts.size(), ready_.size());
      for (std::size_t i = 0; i < n; ++i) counts[i] = Quantise(ready_[i]);
      counts = counts.subspan(n);
      ready_ = ready_.subspan(n);
    }
  }

 private:
  std::span<const float> AdvanceFrame(const ListenerAt& listener) {
    spectrum_.Calc(listener(SampleTime(next_frame_ * hop_samples(), rate_)), psd_);
    return frames_.Advance(next_frame_++, psd_);
  }

  std::int32_t Quantise(float pressure_Pa) {
    const auto code =
        static_cast<std::int64_t>(std::llrint(counts_per_Pa_ * static_cast<double>(pressure_Pa)));
    if (std::abs(code) <= largest_code_) return static_cast<std::int32_t>(code);
    ++clipped_samples_;
    return static_cast<std::int32_t>(code > 0 ? largest_code_ : -largest_code_);
  }

  Rate rate_;
  double counts_per_Pa_;
  std::int64_t largest_code_;
  GaussianFrames frames_;
  ListenerSpectrum spectrum_;
  std::vector<double> psd_;
  std::int64_t next_frame_ = 0;
  std::span<const float> ready_;  // completed samples not yet handed out
  std::int64_t clipped_samples_ = 0;
};

Hydrophone::Hydrophone(const HydrophoneParams& params, AcousticScene scene, const RandomStream& random)
    : impl_(std::make_unique<Impl>(params, scene, random)) {}
Hydrophone::~Hydrophone() = default;
Hydrophone::Hydrophone(Hydrophone&&) noexcept = default;

Rate Hydrophone::rate() const { return impl_->rate(); }

Duration Hydrophone::lookahead() const {
  // sample times are rounded to the nanosecond one by one: a difference may be one longer
  return SampleOffset(impl_->hop_samples(), impl_->rate()) + Duration{1};
}

void Hydrophone::Render(const ListenerAt& listener, std::span<std::int32_t> counts) {
  impl_->Render(listener, counts);
}

std::int64_t Hydrophone::clipped_samples() const { return impl_->clipped_samples(); }

}  // namespace piperun::acoustics
