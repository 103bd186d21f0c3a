#include "acoustics/tones.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/level.h"
#include "acoustics/scene.h"
#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::size_t kStretch = 64;
constexpr double kInaudible_Pa = 1e-9;

/// H = i f / (f_c + i f) of the first-order input stage.
std::complex<double> CalcInputStage(double f_Hz, double high_pass_Hz) {
  return std::complex<double>(0, f_Hz) / std::complex<double>(high_pass_Hz, f_Hz);
}

/// exp(2 pi i f n / rate), whole turns taken off before the exponential.
std::complex<double> CalcTurn(double f_Hz, std::int64_t sample, double rate_Hz) {
  const double turns = f_Hz * static_cast<double>(sample) / rate_Hz;
  return std::polar(1.0, kTwoPi * (turns - std::floor(turns)));
}

void RequireBelowNyquist(const ToneSource& source, double rate_Hz) {
  for (const Tone& tone : source.tones) {
    if (tone.f_Hz < 0.5 * rate_Hz) return;
  }
  if (source.tones.empty()) return;
  throw InputError("the tone of '" + source.id + "' at " + FormatNumber(source.tones.front().f_Hz) +
                       " Hz is not allowed; it must lie below half the rate, " + FormatNumber(0.5 * rate_Hz) +
                       " Hz",
                   "rate_Hz");
}

}  // namespace

std::vector<Tone> CalcHarmonics(const HarmonicSeries& series, double impedance_Pa_s_m3) {
  const double rms_to_q_m3_s = 2 * std::numbers::sqrt2 / impedance_Pa_s_m3;
  std::vector<Tone> tones;
  for (int n = 1; n <= series.lines; ++n) {
    const double level_dB = series.level_dB_re_1uPa + (n - 1) * series.step_dB;
    tones.push_back({n * series.first_Hz, rms_to_q_m3_s * std::sqrt(CalcPressureSquared(level_dB)),
                     -std::numbers::pi * n * (n - 1) / series.lines});
  }
  return tones;
}

Tones::Tones(const AcousticScene& scene, Rate rate, double high_pass_Hz, std::size_t hop)
    : rate_(rate), hop_Pa_(hop), stretch_(std::min(kStretch, hop)), used_(hop) {
  Demand(hop % stretch_ == 0, "a hop holds whole stretches");
  std::vector<PipePlace> places;
  std::vector<double> frequencies_Hz;
  for (const ToneSource& source : scene.tones) {
    RequireBelowNyquist(source, rate.Hz());
    for (const Tone& tone : source.tones) {
      if (tone.f_Hz >= 0.5 * rate.Hz()) continue;
      const std::complex<double> q_m3_s = std::polar(tone.volume_velocity_m3_s, tone.phase_rad);
      lines_.push_back({places.size(), 0, tone.f_Hz, CalcInputStage(tone.f_Hz, high_pass_Hz) * q_m3_s, 0});
      frequencies_Hz.push_back(tone.f_Hz);
    }
    places.push_back(source.place());
    times_.push_back(source.times);
  }
  if (lines_.empty()) return;
  std::sort(frequencies_Hz.begin(), frequencies_Hz.end());
  frequencies_Hz.erase(std::unique(frequencies_Hz.begin(), frequencies_Hz.end()), frequencies_Hz.end());
  for (Line& line : lines_) {
    const auto at = std::lower_bound(frequencies_Hz.begin(), frequencies_Hz.end(), line.f_Hz);
    line.frequency = static_cast<std::size_t>(at - frequencies_Hz.begin());
  }
  field_.emplace(scene.network, places, frequencies_Hz);
}

void Tones::Advance(const ListenerState& listener) {
  if (silent()) return;
  const Moment end{listener.place(), listener.time};
  if (begun_) {
    std::fill(hop_Pa_.begin(), hop_Pa_.end(), 0);
    for (Line& line : lines_) RenderHop(line, listener_, end);
    used_ = 0;
    first_sample_ += static_cast<std::int64_t>(hop_Pa_.size());
  } else {
    for (Line& line : lines_) line.at_end = CalcAmplitude(line, end);
    begun_ = true;
  }
  listener_ = end;
}

std::complex<double> Tones::CalcAmplitude(const Line& line, const Moment& listener) const {
  const double share = CalcAmplitudeShare(times_[line.source], listener.time);
  if (share == 0) return 0;
  return share * line.gain * field_->Impedance_Pa_s_m3(line.frequency, line.source, listener.place);
}

/// Within one pipe the place goes linearly from one moment to the other; from pipe to pipe the amplitude
/// does.
void Tones::RenderHop(Line& line, const Moment& begin, const Moment& end) {
  const std::complex<double> first = line.at_end, last = CalcAmplitude(line, end);
  const std::size_t stretches = hop_Pa_.size() / stretch_;
  const bool same_pipe = begin.place.pipe == end.place.pipe;
  std::complex<double> from = first;
  for (std::size_t i = 1; i <= stretches; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(stretches);
    const TrueTime t =
        begin.time + Duration(std::llround(x * static_cast<double>((end.time - begin.time).count())));
    const PipePlace place{end.place.pipe, begin.place.s_m + x * (end.place.s_m - begin.place.s_m)};
    const std::complex<double> to = i == stretches ? last
                                    : same_pipe    ? CalcAmplitude(line, {place, t})
                                                   : first + x * (last - first);
    AddStretch(line.f_Hz, (i - 1) * stretch_, from, to);
    from = to;
  }
  line.at_end = last;
}

void Tones::AddStretch(double f_Hz, std::size_t begin, std::complex<double> from, std::complex<double> to) {
  if (std::abs(from) < kInaudible_Pa && std::abs(to) < kInaudible_Pa) return;
  const std::complex<double> step = CalcTurn(f_Hz, 1, rate_.Hz());
  std::complex<double> turn = CalcTurn(f_Hz, first_sample_ + static_cast<std::int64_t>(begin), rate_.Hz());
  const std::complex<double> slope = (to - from) / static_cast<double>(stretch_);
  std::complex<double> amplitude = from;
  for (std::size_t i = 0; i < stretch_; ++i) {
    hop_Pa_[begin + i] += (amplitude * turn).real();
    amplitude += slope;
    turn *= step;
  }
}

void Tones::Render(std::span<float> pressure_Pa) {
  if (silent()) return;
  Demand(used_ + pressure_Pa.size() <= hop_Pa_.size(),
         "the listener is told of before its samples are rendered");
  for (float& sample : pressure_Pa) sample += static_cast<float>(hop_Pa_[used_++]);
}

}  // namespace piperun::acoustics
