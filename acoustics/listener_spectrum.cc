#include "acoustics/listener_spectrum.h"

#include <algorithm>

#include "acoustics/decay.h"
#include "acoustics/flow_noise.h"
#include "acoustics/propagation.h"
#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr float kInaudibleLoss = 46;  // exp(-46) = -200 dB

std::vector<double> TabulateHighPass(const HydrophoneParams& params, double bin_width_Hz, std::size_t bins) {
  std::vector<double> gain(bins, 0);
  for (std::size_t k = 1; k < bins; ++k) {
    gain[k] = CalcHighPassGain(params, static_cast<double>(k) * bin_width_Hz);
  }
  return gain;
}

std::vector<float> TabulateSteady(const AcousticScene& scene, const HydrophoneParams& params,
                                  const std::vector<double>& high_pass, double bin_width_Hz) {
  std::vector<float> psd(high_pass.size(), 0);
  for (std::size_t k = 1; k < psd.size(); ++k) {
    const double f_Hz = static_cast<double>(k) * bin_width_Hz;
    psd[k] = static_cast<float>(high_pass[k] * CalcDistantNoisePsd(scene.ambient, f_Hz) +
                                CalcSelfNoisePsd(params, f_Hz));
  }
  return psd;
}

}  // namespace

ListenerSpectrum::ListenerSpectrum(const AcousticScene& scene, const HydrophoneParams& params,
                                   double bin_width_Hz, std::size_t bins)
    : legs_(scene.legs),
      power_loss_(bins),
      flow_noise_(scene.ambient.flow_noise),
      flow_noise_table_(scene.water, params.face_radius_m, bin_width_Hz,
                        TabulateHighPass(params, bin_width_Hz, bins)) {
  Demand(!legs_.empty(), "an acoustic scene has at least one leg");
  const std::vector<double> high_pass = TabulateHighPass(params, bin_width_Hz, bins);
  steady_ = TabulateSteady(scene, params, high_pass, bin_width_Hz);
  TabulateLosses(scene, bin_width_Hz);
  TabulateLeaks(scene, high_pass, bin_width_Hz);
}

void ListenerSpectrum::TabulateLosses(const AcousticScene& scene, double bin_width_Hz) {
  std::vector<PipeWave> waves;
  for (const AcousticLeg& leg : scene.legs) {
    const auto known = std::find(waves.begin(), waves.end(), leg.wave);
    wave_of_leg_.push_back(static_cast<std::size_t>(known - waves.begin()));
    if (known == waves.end()) waves.push_back(leg.wave);
  }
  path_m_.resize(waves.size());
  for (const PipeWave& wave : waves) {
    std::vector<float>& row = power_loss_1_m_.emplace_back(bins());
    for (std::size_t k = 0; k < row.size(); ++k) {
      row[k] = static_cast<float>(2 * wave.Attenuation_Np_m(static_cast<double>(k) * bin_width_Hz));
    }
  }
}

void ListenerSpectrum::TabulateLeaks(const AcousticScene& scene, const std::vector<double>& high_pass,
                                     double bin_width_Hz) {
  for (const SoundingLeak& leak : scene.leaks) {
    leaks_.push_back({leak.chainage_m, std::vector<float>(bins())});
    for (std::size_t k = 0; k < bins(); ++k) {
      const double f_Hz = static_cast<double>(k) * bin_width_Hz;
      leaks_.back().psd[k] = static_cast<float>(high_pass[k] * CalcLeakPsdAtHole(scene, leak, f_Hz));
    }
  }
}

void ListenerSpectrum::Calc(const ListenerState& listener, std::span<float> psd) {
  std::copy(steady_.begin(), steady_.end(), psd.begin());
  if (flow_noise_) {
    flow_noise_table_.AddTo(psd, CalcEddySpeed(listener.slip_speed_m_s, listener.water_speed_m_s),
                            listener.bore_radius_m);
  }
  for (const LeakRow& leak : leaks_) AddLeak(leak, listener.chainage_m, psd);
}

void ListenerSpectrum::AddLeak(const LeakRow& leak, double chainage_m, std::span<float> psd) {
  CalcPowerLoss(leak.chainage_m, chainage_m);
  // losses grow with frequency: the first inaudible bin ends the row
  const auto silent = std::lower_bound(power_loss_.begin(), power_loss_.end(), kInaudibleLoss);
  const auto audible = static_cast<std::size_t>(silent - power_loss_.begin());
  for (std::size_t k = 0; k < audible; ++k) psd[k] += leak.psd[k] * CalcDecay(power_loss_[k]);
}

/// power_loss_ = integral of 2 alpha ds between two chainages, per bin.
void ListenerSpectrum::CalcPowerLoss(double from_m, double to_m) {
  std::fill(path_m_.begin(), path_m_.end(), 0);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    path_m_[wave_of_leg_[i]] += CalcPathInLeg(legs_, i, from_m, to_m);
  }
  std::fill(power_loss_.begin(), power_loss_.end(), 0.F);
  for (std::size_t w = 0; w < path_m_.size(); ++w) {
    const auto path_m = static_cast<float>(path_m_[w]);
    for (std::size_t k = 0; k < power_loss_.size(); ++k) power_loss_[k] += path_m * power_loss_1_m_[w][k];
  }
}

}  // namespace piperun::acoustics
