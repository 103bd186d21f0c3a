#include "acoustics/listener_spectrum.h"

#include <algorithm>
#include <utility>

#include "acoustics/decay.h"
#include "acoustics/flow_noise.h"
#include "acoustics/propagation.h"
#include "acoustics/rolling.h"
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

/// Empty where a ball does not sound when it rolls.
std::vector<float> TabulateRolling(const AcousticScene& scene, const std::vector<double>& high_pass,
                                   double bin_width_Hz) {
  if (CalcRollingSpeed(scene, {.pipe = 0, .rolling_speed_m_s = 1}) == 0) return {};
  std::vector<float> psd(high_pass.size(), 0);
  for (std::size_t k = 1; k < psd.size(); ++k) {
    psd[k] = static_cast<float>(
        high_pass[k] * CalcRollingPsd(scene.ambient.rolling, 1, static_cast<double>(k) * bin_width_Hz));
  }
  return psd;
}

/// The first of begin, begin + 1, ... that `holds` is false for, or `end`; it is true for all before.
template <class Predicate>
std::size_t FindFirstFailing(std::size_t begin, std::size_t end, Predicate holds) {
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (holds(middle)) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

}  // namespace

ListenerSpectrum::ListenerSpectrum(const AcousticScene& scene, const HydrophoneParams& params,
                                   double bin_width_Hz, std::size_t bins)
    : pipes_(scene.pipes),
      flow_noise_(scene.ambient.flow_noise),
      flow_noise_table_(scene.water, params.face_radius_m, bin_width_Hz,
                        TabulateHighPass(params, bin_width_Hz, bins)) {
  const std::vector<double> high_pass = TabulateHighPass(params, bin_width_Hz, bins);
  steady_ = TabulateSteady(scene, params, high_pass, bin_width_Hz);
  rolling_ = TabulateRolling(scene, high_pass, bin_width_Hz);
  TabulateLosses(bin_width_Hz);
  TabulateLeaks(scene, high_pass, bin_width_Hz);
}

void ListenerSpectrum::TabulateLosses(double bin_width_Hz) {
  std::vector<PipeWave> waves;
  for (const AcousticPipe& pipe : pipes_) {
    const auto known = std::find(waves.begin(), waves.end(), pipe.wave);
    wave_of_pipe_.push_back(static_cast<std::size_t>(known - waves.begin()));
    if (known == waves.end()) waves.push_back(pipe.wave);
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
    LeakRow& row = leaks_.emplace_back();
    row.paths = FindPaths(pipes_, leak.place());
    row.times = leak.times;
    row.psd.resize(bins());
    for (std::size_t k = 0; k < bins(); ++k) {
      const double f_Hz = static_cast<double>(k) * bin_width_Hz;
      row.psd[k] = static_cast<float>(high_pass[k] * CalcLeakPsdAtHole(scene, leak, f_Hz));
    }
    for (WayToEnd& way : row.ways) way.other_loss.resize(bins());
  }
}

void ListenerSpectrum::Calc(const ListenerState& listener, std::span<float> psd) {
  std::copy(steady_.begin(), steady_.end(), psd.begin());
  if (listener.pipe < 0) return;
  if (flow_noise_) {
    flow_noise_table_.AddTo(psd, CalcEddySpeed(listener.slip_speed_m_s, listener.water_speed_m_s),
                            listener.bore_radius_m);
  }
  if (listener.pipe != pipe_) EnterPipe(listener.pipe);
  AddRolling(listener.rolling_speed_m_s, psd);
  for (const LeakRow& leak : leaks_) AddLeak(leak, listener, psd);
}

void ListenerSpectrum::EnterPipe(int pipe) {
  Demand(static_cast<std::size_t>(pipe) < pipes_.size(), "the listener's pipe is in the acoustic scene");
  pipe_ = pipe;
  const AcousticPipe& own = pipes_[static_cast<std::size_t>(pipe)];
  for (LeakRow& leak : leaks_) {
    TabulateWay(leak.paths, own.from_node, leak.ways[static_cast<std::size_t>(WayIn::kFromEnd)]);
    TabulateWay(leak.paths, own.to_node, leak.ways[static_cast<std::size_t>(WayIn::kToEnd)]);
  }
}

void ListenerSpectrum::TabulateWay(const PathTree& paths, int node, WayToEnd& way) {
  std::fill(path_m_.begin(), path_m_.end(), 0);
  std::fill(way.other_loss.begin(), way.other_loss.end(), 0.F);
  WalkBack(paths, node, [this](int pipe, double length_m) {
    path_m_[wave_of_pipe_[static_cast<std::size_t>(pipe)]] += length_m;
  });
  way.own_m = std::exchange(path_m_[wave_of_pipe_[static_cast<std::size_t>(pipe_)]], 0);
  for (std::size_t w = 0; w < path_m_.size(); ++w) {
    if (path_m_[w] == 0) continue;
    const auto path_m = static_cast<float>(path_m_[w]);
    for (std::size_t k = 0; k < bins(); ++k) way.other_loss[k] += path_m * power_loss_1_m_[w][k];
  }
}

void ListenerSpectrum::AddRolling(double speed_m_s, std::span<float> psd) const {
  if (rolling_.empty() || speed_m_s == 0) return;
  const auto gain = static_cast<float>(speed_m_s * speed_m_s * speed_m_s);
  for (std::size_t k = 1; k < bins(); ++k) psd[k] += gain * rolling_[k];
}

void ListenerSpectrum::AddLeak(const LeakRow& leak, const ListenerState& listener,
                               std::span<float> psd) const {
  const auto share = static_cast<float>(CalcPowerShare(leak.times, listener.time));
  if (share == 0) return;
  const PipePlace place = listener.place();
  const Arrival arrival = FindArrival(pipes_, leak.paths, place);
  if (arrival.way == WayIn::kNone) return;
  const WayToEnd& way = leak.ways[static_cast<std::size_t>(arrival.way)];
  const float* other = way.other_loss.data();
  const auto local = static_cast<float>(2 * arrival.local_Np);
  const float* loss_1_m = power_loss_1_m_[wave_of_pipe_[static_cast<std::size_t>(place.pipe)]].data();
  const auto own_m = static_cast<float>(way.own_m + arrival.length_m);
  // losses grow with frequency: the first inaudible bin ends the row
  const std::size_t audible = FindFirstFailing(
      1, bins(), [&](std::size_t k) { return local + other[k] + own_m * loss_1_m[k] < kInaudibleLoss; });
  for (std::size_t k = 1; k < audible; ++k) {
    psd[k] += share * leak.psd[k] * CalcDecay(local + other[k] + own_m * loss_1_m[k]);
  }
}

}  // namespace piperun::acoustics
