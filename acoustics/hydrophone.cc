#include "acoustics/hydrophone.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "acoustics/gaussian_frames.h"
#include "acoustics/listener_spectrum.h"
#include "acoustics/tones.h"

namespace piperun::acoustics {
namespace {

constexpr double kFrame_s = 0.064;

/// The power of two nearest to 64 ms, by ratio.
std::size_t CalcFrameSize(double rate_Hz) {
  return std::size_t{1} << std::lround(std::log2(kFrame_s * rate_Hz));
}

/// Nearest whole number, halves to even; |x| < 2^51. Unlike std::nearbyint it needs no library call.
double RoundToEven(double x) {
  constexpr double kRounder = 0x1.8p52;
  return (x + kRounder) - kRounder;
}

bool IsFinite(const ListenerState& s) {
  return std::isfinite(s.s_m) && std::isfinite(s.water_speed_m_s) && std::isfinite(s.slip_speed_m_s) &&
         std::isfinite(s.bore_radius_m);
}

const HydrophoneParams& Checked(const HydrophoneParams& params) {
  params.Check();
  return params;
}

}  // namespace

class Hydrophone::Impl {
 public:
  Impl(const HydrophoneParams& params, const AcousticScene& scene, const RandomStream& random)
      : rate_(Checked(params).rate_Hz),
        counts_per_Pa_(1 / params.scale_Pa()),
        largest_code_(static_cast<double>(params.largest_code())),
        frames_(CalcFrameSize(params.rate_Hz), params.rate_Hz, random),
        spectrum_(scene, params, frames_.bin_width_Hz(), frames_.bins()),
        impacts_(scene.ambient.impacts, scene.ball, scene.water.density_kg_m3, rate_, params.high_pass_Hz,
                 random),
        tones_(scene, rate_, params.high_pass_Hz, frames_.hop()),
        faults_(params.faults, rate_, random),
        psd_(frames_.bins()),
        mixed_(frames_.hop()) {}

  Rate rate() const { return rate_; }
  std::int64_t hop_samples() const { return static_cast<std::int64_t>(frames_.hop()); }
  std::int64_t clipped_samples() const { return clipped_samples_; }
  std::int64_t dropped_samples() const { return faults_.dropped_samples(); }

  void Add(const Knock& knock) { impacts_.Add(knock); }

  void Render(const ListenerAt& listener, std::span<std::int32_t> counts) {
    if (next_frame_ == 0) AdvanceFrame(listener);  // what frame 0 completes lies before sample 0
    while (!counts.empty()) {
      if (ready_.empty()) ready_ = AdvanceFrame(listener);
      const std::size_t n = std::min(counts.size(), ready_.size());
      Quantise(Mix(ready_.first(n)), counts.first(n));
      faults_.Drop(counts.first(n));
      counts = counts.subspan(n);
      ready_ = ready_.subspan(n);
    }
  }

 private:
  std::span<const float> AdvanceFrame(const ListenerAt& listener) {
    const ListenerState state = listener(SampleTime(next_frame_ * hop_samples(), rate_));
    if (IsFinite(state)) {
      spectrum_.Calc(state, psd_);
      tones_.Advance(state);
    } else {
      tones_.Advance({});
      std::fill(psd_.begin(), psd_.end(), 0.F);
    }
    return frames_.Advance(next_frame_++, psd_);
  }

  std::span<const float> Mix(std::span<const float> pressure_Pa) {
    std::copy(pressure_Pa.begin(), pressure_Pa.end(), mixed_.begin());
    const std::span<float> mixed = std::span(mixed_).first(pressure_Pa.size());
    impacts_.Render(mixed);
    tones_.Render(mixed);
    faults_.Amplify(mixed);
    return mixed;
  }

  void Quantise(std::span<const float> pressure_Pa, std::span<std::int32_t> counts) {
    const double gain = counts_per_Pa_, largest = largest_code_;
    std::int32_t clipped = 0;  // of a block: locals, so that the loop runs in vector registers
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double code = RoundToEven(gain * static_cast<double>(pressure_Pa[i]));
      clipped += static_cast<std::int32_t>(std::abs(code) > largest);
      counts[i] = static_cast<std::int32_t>(std::max(-largest, std::min(largest, code)));
    }
    clipped_samples_ += clipped;
  }

  Rate rate_;
  double counts_per_Pa_;
  double largest_code_;
  GaussianFrames frames_;
  ListenerSpectrum spectrum_;
  ImpactSound impacts_;
  Tones tones_;
  RecordFaults faults_;
  std::vector<float> psd_;
  std::vector<float> mixed_;
  std::int64_t next_frame_ = 0;
  std::span<const float> ready_;  // completed samples not yet handed out
  std::int64_t clipped_samples_ = 0;
};

Hydrophone::Hydrophone(const HydrophoneParams& params, const AcousticScene& scene, const RandomStream& random)
    : impl_(std::make_unique<Impl>(params, scene, random)) {}
Hydrophone::~Hydrophone() = default;
Hydrophone::Hydrophone(Hydrophone&&) noexcept = default;

Rate Hydrophone::rate() const { return impl_->rate(); }

Duration Hydrophone::lookahead() const {
  // sample times are rounded to the nanosecond one by one: a difference may be one longer
  return SampleOffset(impl_->hop_samples(), impl_->rate()) + Duration{1};
}

std::int64_t Hydrophone::dropped_samples() const { return impl_->dropped_samples(); }

void Hydrophone::Add(const Knock& knock) { impl_->Add(knock); }

void Hydrophone::Render(const ListenerAt& listener, std::span<std::int32_t> counts) {
  impl_->Render(listener, counts);
}

std::int64_t Hydrophone::clipped_samples() const { return impl_->clipped_samples(); }

}  // namespace piperun::acoustics
