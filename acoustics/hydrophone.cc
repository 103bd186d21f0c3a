#include "acoustics/hydrophone.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "acoustics/gaussian_frames.h"
#include "acoustics/listener_spectrum.h"
#include "acoustics/stem_frames.h"
#include "acoustics/tones.h"
#include "base/check.h"
#include "base/number.h"

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

void RequireBand(double f_low_Hz, double f_high_Hz, double rate_Hz) {
  if (f_low_Hz > 0 && f_low_Hz < f_high_Hz && f_high_Hz <= 0.5 * rate_Hz) return;
  throw InputError("the band " + FormatNumber(f_low_Hz) + " to " + FormatNumber(f_high_Hz) +
                       " Hz is not allowed; it must rise from above 0 to at most half the rate, " +
                       FormatNumber(0.5 * rate_Hz) + " Hz",
                   "band_Hz");
}

/// Of a spectrum that is constant over each bin.
double IntegrateBand(std::span<const float> psd, double bin_width_Hz, double f_low_Hz, double f_high_Hz) {
  double sum = 0;
  for (std::size_t k = 1; k < psd.size(); ++k) {
    const double begin_Hz = (static_cast<double>(k) - 0.5) * bin_width_Hz, end_Hz = begin_Hz + bin_width_Hz;
    const double width_Hz = std::min(end_Hz, f_high_Hz) - std::max(begin_Hz, f_low_Hz);
    if (width_Hz > 0) sum += width_Hz * static_cast<double>(psd[k]);
  }
  return sum;
}

std::vector<std::string> ListGaussianStems(const ListenerSpectrum& spectrum) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < spectrum.stems(); ++i) names.push_back(spectrum.StemName(i));
  return names;
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
        converter_noise_(CalcConverterNoisePsd(params)),
        psd_(frames_.bins()),
        mixed_(frames_.hop()),
        added_(frames_.hop()) {
    if (!params.stems) return;
    stem_names_ = ListGaussianStems(spectrum_);
    stems_.emplace(2 * frames_.hop(), frames_.bin_width_Hz(), random, stem_names_);
    stem_names_.insert(stem_names_.end(), {"knocks", "tones"});
    stems_Pa_.resize(stem_names_.size());
    for (std::vector<float>& stem : stems_Pa_) stem.reserve(static_cast<std::size_t>(params.block_samples));
  }

  Rate rate() const { return rate_; }
  std::int64_t hop_samples() const { return static_cast<std::int64_t>(frames_.hop()); }
  std::int64_t clipped_samples() const { return clipped_samples_; }
  std::int64_t dropped_samples() const { return faults_.dropped_samples(); }

  void Add(const Knock& knock) { impacts_.Add(knock); }

  const std::vector<std::string>& stem_names() const { return stem_names_; }
  std::span<const float> stem_Pa(std::size_t stem) const { return stems_Pa_[stem]; }

  void Render(const ListenerAt& listener, std::span<std::int32_t> counts) {
    for (std::vector<float>& stem : stems_Pa_) stem.clear();
    if (next_frame_ == 0) AdvanceFrame(listener);  // what frame 0 completes lies before sample 0
    while (!counts.empty()) {
      if (ready_.empty()) ready_ = AdvanceFrame(listener);
      const std::size_t n = std::min(counts.size(), ready_.size());
      Quantise(Mix(ready_.first(n)), counts.first(n));
      faults_.Drop(counts.first(n));
      counts = counts.subspan(n);
      if (stems_) KeepStems(n);
      ready_ = ready_.subspan(n);
    }
  }

  void CalcBandPower(const ListenerState& listener, double f_low_Hz, double f_high_Hz,
                     std::span<double> band_Pa2) {
    RequireBand(f_low_Hz, f_high_Hz, rate_.Hz());
    Demand(band_Pa2.size() == spectrum_.sources() + 1, "a number per source and one of the rest");
    std::fill(band_Pa2.begin(), band_Pa2.end(), 0.0);
    band_Pa2.back() = converter_noise_ * (f_high_Hz - f_low_Hz);
    for (std::size_t i = 0; i < spectrum_.stems(); ++i) {
      spectrum_.CalcStem(i, listener, psd_);
      band_Pa2[std::min(i, spectrum_.sources())] +=
          IntegrateBand(psd_, frames_.bin_width_Hz(), f_low_Hz, f_high_Hz);
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
    const std::span<const float> hop = frames_.Advance(next_frame_, psd_);
    if (stems_) AdvanceStems(state);
    ++next_frame_;
    return hop;
  }

  void AdvanceStems(const ListenerState& state) {
    for (std::size_t i = 0; i < stems_->stems(); ++i) {
      if (IsFinite(state)) {
        spectrum_.CalcStem(i, state, stems_->psd(i));
      } else {
        std::ranges::fill(stems_->psd(i), 0.F);
      }
    }
    stems_->Advance(next_frame_, frames_.spectrum());
  }

  /// Of the next n samples that are ready.
  void KeepStems(std::size_t n) {
    const std::size_t begin = frames_.hop() - ready_.size();
    for (std::size_t i = 0; i < stems_->stems(); ++i) {
      const auto part = stems_->hop(i).subspan(begin, n);
      stems_Pa_[i].insert(stems_Pa_[i].end(), part.begin(), part.end());
    }
  }

  std::span<const float> Mix(std::span<const float> pressure_Pa) {
    std::copy(pressure_Pa.begin(), pressure_Pa.end(), mixed_.begin());
    const std::span<float> mixed = std::span(mixed_).first(pressure_Pa.size());
    AddWaveform(impacts_, mixed, 2);
    AddWaveform(tones_, mixed, 1);
    faults_.Amplify(mixed);
    return mixed;
  }

  /// `from_end`: where its stem stands. A sample gets one number from it: kept apart or not, the sum is the
  /// same.
  template <class Waveform>
  void AddWaveform(Waveform& waveform, std::span<float> mixed, std::size_t from_end) {
    if (!stems_) return waveform.Render(mixed);
    const std::span<float> added = std::span(added_).first(mixed.size());
    std::fill(added.begin(), added.end(), 0.F);
    waveform.Render(added);
    std::transform(mixed.begin(), mixed.end(), added.begin(), mixed.begin(), std::plus<>());
    std::vector<float>& stem = stems_Pa_[stems_Pa_.size() - from_end];
    stem.insert(stem.end(), added.begin(), added.end());
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
  double converter_noise_;  // Pa^2/Hz
  std::vector<float> psd_;
  std::vector<float> mixed_, added_;
  std::optional<StemFrames> stems_;
  std::vector<std::string> stem_names_;
  std::vector<std::vector<float>> stems_Pa_;  // of the last Render
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

std::vector<std::string> Hydrophone::StemNames() const { return impl_->stem_names(); }
std::span<const float> Hydrophone::stem_Pa(std::size_t stem) const { return impl_->stem_Pa(stem); }

void Hydrophone::CalcBandPower(const ListenerState& listener, double f_low_Hz, double f_high_Hz,
                               std::span<double> band_Pa2) {
  impl_->CalcBandPower(listener, f_low_Hz, f_high_Hz, band_Pa2);
}

void Hydrophone::Add(const Knock& knock) { impl_->Add(knock); }

void Hydrophone::Render(const ListenerAt& listener, std::span<std::int32_t> counts) {
  impl_->Render(listener, counts);
}

std::int64_t Hydrophone::clipped_samples() const { return impl_->clipped_samples(); }

}  // namespace piperun::acoustics
