#include "acoustics/listener_spectrum.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>

#include "acoustics/flow_noise.h"
#include "acoustics/near_field.h"
#include "acoustics/rolling.h"
#include "base/check.h"

namespace piperun::acoustics {
namespace {

std::vector<double> TabulateHighPass(const HydrophoneParams& params, double bin_width_Hz, std::size_t bins) {
  std::vector<double> gain(bins, 0);
  for (std::size_t k = 1; k < bins; ++k) {
    gain[k] = CalcHighPassGain(params, static_cast<double>(k) * bin_width_Hz);
  }
  return gain;
}

template <class Psd>
std::vector<float> Tabulate(const std::vector<double>& gain, double bin_width_Hz, Psd psd) {
  std::vector<float> row(gain.size(), 0);
  for (std::size_t k = 1; k < row.size(); ++k)
    row[k] = static_cast<float>(gain[k] * psd(static_cast<double>(k) * bin_width_Hz));
  return row;
}

std::vector<int> ListPipes(const AcousticScene& scene) {
  if (!scene.listening_pipes.empty()) return scene.listening_pipes;
  std::vector<int> all(scene.network.pipes.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

ListenerSpectrum::ListenerSpectrum(const AcousticScene& scene, const HydrophoneParams& params,
                                   double bin_width_Hz, std::size_t bins)
    : flow_noise_(scene.ambient.flow_noise),
      flow_noise_table_(scene.water, params.face_radius_m, bin_width_Hz,
                        TabulateHighPass(params, bin_width_Hz, bins)) {
  const std::vector<double> high_pass = TabulateHighPass(params, bin_width_Hz, bins);
  distant_ = Tabulate(high_pass, bin_width_Hz,
                      [&](double f_Hz) { return CalcDistantNoisePsd(scene.ambient, f_Hz); });
  self_ = Tabulate(std::vector<double>(bins, 1), bin_width_Hz,
                   [&](double f_Hz) { return CalcSelfNoisePsd(params, f_Hz); });
  std::transform(distant_.begin(), distant_.end(), self_.begin(), std::back_inserter(steady_), std::plus<>());
  if (CalcRollingSpeed(scene, {.pipe = 0, .rolling_speed_m_s = 1}) > 0) {
    rolling_ = Tabulate(high_pass, bin_width_Hz,
                        [&](double f_Hz) { return CalcRollingPsd(scene.ambient.rolling, 1, f_Hz); });
  }
  scratch_.resize(bins);
  TabulateLeaks(scene, high_pass, bin_width_Hz);
}

void ListenerSpectrum::TabulateLeaks(const AcousticScene& scene, const std::vector<double>& high_pass,
                                     double bin_width_Hz) {
  if (scene.leaks.empty()) return;
  std::vector<PipePlace> places;
  std::vector<std::vector<float>> spectra;
  for (const SoundingLeak& leak : scene.leaks) {
    const PipeWave& wave = scene.network.pipes[static_cast<std::size_t>(leak.pipe)].wave;
    places.push_back(leak.place());
    spectra.push_back(
        Tabulate(high_pass, bin_width_Hz, [&](double f_Hz) { return leak.sound->VolumeVelocityPsd(f_Hz); }));
    LeakRow& row =
        leaks_.emplace_back(LeakRow{leak.id, leak.place(), leak.times, wave.bore_radius_m, {}, {}});
    row.modes = FindOrMakeModes(scene, wave, bin_width_Hz);
    row.at_hole =
        Tabulate(high_pass, bin_width_Hz, [&](double f_Hz) { return CalcLeakPsdAtHole(scene, leak, f_Hz); });
    row.near = Tabulate(high_pass, bin_width_Hz, [&](double f_Hz) {
      return CalcNearField(wave, 0, f_Hz) * CalcLeakPsdAtHole(scene, leak, f_Hz);
    });
  }
  field_.emplace(scene.network, places, spectra, bin_width_Hz, ListPipes(scene));
}

std::size_t ListenerSpectrum::FindOrMakeModes(const AcousticScene& scene, const PipeWave& wave,
                                              double bin_width_Hz) {
  const auto found = std::find_if(mode_tables_.begin(), mode_tables_.end(),
                                  [&](const ModeRow& row) { return row.wave == wave; });
  if (found != mode_tables_.end()) return static_cast<std::size_t>(found - mode_tables_.begin());
  const double r_over_a = CalcListeningRadius(scene.ball, wave.bore_radius_m);
  mode_tables_.push_back({wave, HigherModeTable(wave, r_over_a, bin_width_Hz, scratch_.size())});
  return mode_tables_.size() - 1;
}

void ListenerSpectrum::Calc(const ListenerState& listener, std::span<float> psd) {
  std::copy(steady_.begin(), steady_.end(), psd.begin());
  AddEddies(listener, psd);
  AddRolling(listener, psd);
  for (std::size_t leak = 0; leak < leaks_.size(); ++leak) AddLeak(leak, listener, psd);
}

std::string ListenerSpectrum::StemName(std::size_t stem) const {
  constexpr const char* kOthers[] = {"background_distant", "background_flow", "background_self"};
  Demand(stem < stems(), "the spectrum has that stem");
  return stem < leaks_.size() ? "source_" + leaks_[stem].id : kOthers[stem - leaks_.size()];
}

void ListenerSpectrum::CalcStem(std::size_t stem, const ListenerState& listener, std::span<float> psd) {
  Demand(stem < stems(), "the spectrum has that stem");
  std::fill(psd.begin(), psd.end(), 0.F);
  if (stem < leaks_.size()) return AddLeak(stem, listener, psd);
  if (stem == leaks_.size() + 1) {
    AddEddies(listener, psd);
    return AddRolling(listener, psd);
  }
  const std::vector<float>& row = stem == leaks_.size() ? distant_ : self_;
  std::copy(row.begin(), row.end(), psd.begin());
}

void ListenerSpectrum::AddRolling(const ListenerState& listener, std::span<float> psd) const {
  const double speed_m_s = listener.rolling_speed_m_s;
  if (rolling_.empty() || speed_m_s == 0) return;
  const auto gain = static_cast<float>(speed_m_s * speed_m_s * speed_m_s);
  for (std::size_t k = 1; k < psd.size(); ++k) psd[k] += gain * rolling_[k];
}

void ListenerSpectrum::AddEddies(const ListenerState& listener, std::span<float> psd) {
  if (!flow_noise_ || listener.pipe < 0) return;
  flow_noise_table_.AddTo(psd, CalcEddySpeed(listener.slip_speed_m_s, listener.water_speed_m_s),
                          listener.bore_radius_m);
}

void ListenerSpectrum::AddLeak(std::size_t leak, const ListenerState& listener, std::span<float> psd) {
  const LeakRow& row = leaks_[leak];
  const auto share = static_cast<float>(CalcPowerShare(row.times, listener.time));
  if (listener.pipe < 0 || share == 0) return;
  if (share == 1) {
    field_->Add(leak, listener.place(), psd);
  } else {
    std::fill(scratch_.begin(), scratch_.end(), 0.F);
    field_->Add(leak, listener.place(), scratch_);
    for (std::size_t k = 1; k < psd.size(); ++k) psd[k] += share * scratch_[k];
  }
  if (listener.pipe != row.place.pipe) return;
  const double z_m = listener.s_m - row.place.s_m;
  mode_tables_[row.modes].table.AddTo(psd, row.at_hole, z_m, share);
  const auto fading = share * static_cast<float>(CalcNearFieldFading(row.bore_radius_m, z_m));
  if (fading < 1e-6F) return;
  for (std::size_t k = 1; k < psd.size(); ++k) psd[k] += fading * row.near[k];
}

}  // namespace piperun::acoustics
