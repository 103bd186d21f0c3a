#include "acoustics/impact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInaudible_Pa = 1e-9;  // 1e-5 of the step of 24 bits over 1 kPa

/// Share of a half-sine's impulse that has passed at time t after its beginning.
double CalcPassedShare(double t_s, double contact_time_s) {
  return 0.5 * (1 - std::cos(kPi * std::clamp(t_s / contact_time_s, 0.0, 1.0)));
}

/// Pole of the first-order high-pass of corner f_c, by the bilinear transform with the corner kept.
double CalcHighPassPole(double corner_Hz, double rate_Hz) {
  const double t = std::tan(kPi * std::min(corner_Hz / rate_Hz, 0.499));
  return (1 - t) / (1 + t);
}

}  // namespace

double CalcNearPressure_Pa_per_N(const StruckBall& ball, double density_kg_m3) {
  const double r = ball.radius_m;
  const double displaced_kg = density_kg_m3 * 4 / 3 * kPi * r * r * r;
  return density_kg_m3 * r / (2 * (ball.mass_kg + displaced_kg / 2)) / std::numbers::sqrt3;
}

double CalcRingShare(double f_Hz, double contact_time_s) {
  const double x = 2 * f_Hz * contact_time_s;
  return 1 / (1 + x * x);
}

ImpactSound::ImpactSound(const ImpactParams& params, const StruckBall& ball, double density_kg_m3, Rate rate,
                         double high_pass_Hz, const RandomStream& random)
    : params_(params),
      Pa_per_N_(CalcNearPressure_Pa_per_N(ball, density_kg_m3)),
      rate_(rate),
      random_(random),
      high_pass_pole_(CalcHighPassPole(high_pass_Hz, rate.Hz())) {
  params.Check();
  const double octaves = std::log2(params.ring_high_Hz / params.ring_low_Hz);
  for (std::size_t i = 0; i < kModes; ++i) {
    const double f_Hz =
        params.ring_low_Hz * std::exp2(octaves * (static_cast<double>(i) + 0.5) / double{kModes});
    if (f_Hz >= rate.Hz() / 2) break;
    const std::complex<double> pole =
        std::complex<double>(-std::numbers::ln10 / params.ring_decay_s, 2 * kPi * f_Hz) * rate.Period_s();
    modes_.push_back({f_Hz, pole, std::exp(pole), 0});
  }
  knocks_.reserve(64);
}

void ImpactSound::Add(const Knock& knock) {
  if (!params_.on || !std::isfinite(knock.impulse_N_s)) return;
  Demand(knock.contact_time_s > 0, "a knock takes time");
  Demand(next_sample_ == 0 || knock.time > SampleTime(next_sample_ - 1, rate_),
         "a knock is told before its samples are rendered");
  const auto later = std::upper_bound(knocks_.begin(), knocks_.end(), knock,
                                      [](const Knock& a, const Knock& b) { return a.time < b.time; });
  knocks_.insert(later, knock);
}

void ImpactSound::Render(std::span<float> pressure_Pa) {
  if (silent()) {
    next_sample_ += static_cast<std::int64_t>(pressure_Pa.size());
    return;
  }
  for (float& sample : pressure_Pa) {
    const TrueTime t = SampleTime(next_sample_++, rate_);
    if (!silent()) sample += static_cast<float>(RenderSample(t));
  }
}

double ImpactSound::RenderSample(TrueTime t) {
  double near_Pa = 0;
  for (const Knock& knock : knocks_) near_Pa += CalcNearPressure_Pa(knock, t);
  AdvanceRing();
  for (; struck_ < knocks_.size() && knocks_[struck_].time <= t; ++struck_) StrikeModes(knocks_[struck_], t);
  const double pressure_Pa = PassInputStage(near_Pa + CalcRing_Pa());
  DropPastKnocks(t);
  return pressure_Pa;
}

double ImpactSound::CalcNearPressure_Pa(const Knock& knock, TrueTime t) const {
  const double end_s = Seconds(t - knock.time), period_s = rate_.Period_s();
  const double share =
      CalcPassedShare(end_s, knock.contact_time_s) - CalcPassedShare(end_s - period_s, knock.contact_time_s);
  return Pa_per_N_ * knock.impulse_N_s * share / period_s;
}

/// Adds to the modes what a knock a little before the sample at t has made of them by then.
void ImpactSound::StrikeModes(const Knock& knock, TrueTime t) {
  const double late_samples = Seconds(t - knock.time) * rate_.Hz();
  const double level_Pa = params_.ring_Pa_per_N_s * knock.impulse_N_s * std::sqrt(2 / double{kModes});
  const auto key = static_cast<std::uint64_t>(knock.time.time_since_epoch().count());
  std::array<double, 4> uniforms{};
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    if (i % 4 == 0) uniforms = random_.Uniforms(key, kFirstSlot + i / 4);
    Mode& mode = modes_[i];
    const double amplitude_Pa = level_Pa * CalcRingShare(mode.f_Hz, knock.contact_time_s);
    mode.state += std::polar(amplitude_Pa, 2 * kPi * uniforms[i % 4]) * std::exp(mode.pole * late_samples);
  }
  ringing_ = true;
}

void ImpactSound::AdvanceRing() {
  if (!ringing_) return;
  double power = 0;
  for (Mode& mode : modes_) {
    mode.state *= mode.step;
    power += std::norm(mode.state);
  }
  if (power >= kInaudible_Pa * kInaudible_Pa) return;
  for (Mode& mode : modes_) mode.state = 0;
  ringing_ = false;
}

double ImpactSound::CalcRing_Pa() const {
  double sum_Pa = 0;
  for (const Mode& mode : modes_) sum_Pa += mode.state.real();
  return sum_Pa;
}

double ImpactSound::PassInputStage(double in_Pa) {
  out_Pa_ = high_pass_pole_ * out_Pa_ + 0.5 * (1 + high_pass_pole_) * (in_Pa - in_Pa_);
  in_Pa_ = in_Pa;
  if (in_Pa == 0 && std::abs(out_Pa_) < kInaudible_Pa) out_Pa_ = 0;
  return out_Pa_;
}

void ImpactSound::DropPastKnocks(TrueTime t) {
  while (struck_ > 0 &&
         Seconds(t - knocks_.front().time) > knocks_.front().contact_time_s + rate_.Period_s()) {
    knocks_.erase(knocks_.begin());
    --struck_;
  }
}

}  // namespace piperun::acoustics
