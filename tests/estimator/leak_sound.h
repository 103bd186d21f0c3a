#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/measurement.h"
#include "base/random.h"
#include "estimator/biquad.h"
#include "estimator/leak_locator.h"

namespace piperun::estimator::testing {

/// A ball drifting past leaks at constant speed, and what its hydrophone hears.
///
/// Background: white noise through a one-pole low pass at 100 Hz plus a white floor, its level drifting
/// slowly in all bands alike. Leaks: white noise in five bands, each falling off along the pipe with the
/// attenuation of its own centre (dB per metre and kHz). Joints: bursts of 80 ms, louder than the background
/// in band.
struct SoundScene {
  struct Leak {
    double chainage_m = 0;
    double snr_dB = 0;  ///< over the background, 1 to 4 kHz, at the hole
  };
  double length_m = 24;
  double speed_m_s = 0.6;
  double rate_Hz = 16000;
  double attenuation_dB_m_kHz = 3.2;  ///< DN150 PVC-U
  double drift_dB = 0;                ///< amplitude of the background's drift
  double drift_length_m = 20;
  double joint_spacing_m = 0;  ///< 0: none
  double joint_dB = 10;
  double second_from_m = 1e9;  ///< from here on the wall is another one
  double second_attenuation_dB_m_kHz = 0;
  double tee_m = -1e9;  ///< a tee between three equal pipes: who is heard through it is 3.52 dB weaker
  double tone_Pa = 0;   ///< amplitude of a pump's tone
  double tone_Hz = 298;
  std::vector<Leak> leaks;

  /// Loss in dB per kHz between two places, without the tee.
  double Loss_dB_kHz(double a_m, double b_m) const {
    const double low = std::min(a_m, b_m), high = std::max(a_m, b_m);
    const double second_m = std::max(0.0, high - std::max(low, second_from_m));
    return attenuation_dB_m_kHz * (high - low - second_m) + second_attenuation_dB_m_kHz * second_m;
  }
  double TeeLoss_dB(double a_m, double b_m) const { return (a_m < tee_m) != (b_m < tee_m) ? 3.52 : 0; }
};

constexpr double kScale_Pa = 1e-6;

class SoundRecord {
 public:
  SoundRecord(const SoundScene& scene, std::uint64_t seed);
  /// Feeds a locator in blocks: the track at 100 Hz, then the block.
  void Feed(LeakLocator& locator, std::size_t block_samples) const;

 private:
  SoundScene scene_;
  std::vector<std::int32_t> counts_;
};

namespace internal {

struct NoiseBand {
  double low_Hz, high_Hz;
};
inline constexpr std::array<NoiseBand, 5> kLeakBands{
    {{300, 700}, {700, 1200}, {1200, 2000}, {2000, 3000}, {3000, 4200}}};

/// White noise of unit variance, four at a time.
class White {
 public:
  White(std::uint64_t seed, std::string_view name) : random_(seed, name, 0) {}
  double Next() {
    if (i_ % 4 == 0) four_ = random_.Normals(i_ / 4, 0);
    return four_[i_++ % 4];
  }

 private:
  RandomStream random_;
  std::array<double, 4> four_{};
  std::uint64_t i_ = 0;
};

/// One-pole low pass at 100 Hz plus a floor: about -20 dB per decade.
struct Background {
  double pole, floor, state = 0;
  explicit Background(double rate_Hz) : pole(std::exp(-2 * std::numbers::pi * 100 / rate_Hz)), floor(0.01) {}
  double Step(double white, double white_floor) {
    state = pole * state + (1 - pole) * white;
    return state + floor * white_floor;
  }
  /// Power spectral density over that of unit white noise.
  double Psd(double f_Hz, double rate_Hz) const {
    const double w = 2 * std::numbers::pi * f_Hz / rate_Hz;
    return (1 - pole) * (1 - pole) / (1 + pole * pole - 2 * pole * std::cos(w)) + floor * floor;
  }
};

}  // namespace internal

inline SoundRecord::SoundRecord(const SoundScene& scene, std::uint64_t seed) : scene_(scene) {
  using namespace internal;
  const auto n = static_cast<std::size_t>(scene.length_m / scene.speed_m_s * scene.rate_Hz);
  Background background(scene.rate_Hz);
  // mean of the background's density over 1 to 4 kHz: the leak's flat density is snr above it
  double mean_psd = 0;
  for (int f = 1005; f < 4000; f += 10) mean_psd += background.Psd(f, scene.rate_Hz) / 300;
  White white(seed, "background"), floor(seed, "floor"), joints(seed, "joints"), leak_white(seed, "leak");
  std::array<BiquadCascade, kLeakBands.size()> bands;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    bands[b] = ButterworthBand(kLeakBands[b].low_Hz, kLeakBands[b].high_Hz, scene.rate_Hz);
  }
  std::array<double, kLeakBands.size()> gain{};
  double level = 1, burst = 0;
  counts_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = scene.speed_m_s * static_cast<double>(i) / scene.rate_Hz;
    if (i % 16 == 0) {
      level =
          std::pow(10, scene.drift_dB / 20 * std::sin(2 * std::numbers::pi * x / scene.drift_length_m + 1));
      burst = 0;
      if (scene.joint_spacing_m > 0) {
        const double behind_s = std::fmod(x, scene.joint_spacing_m) / scene.speed_m_s;
        burst = behind_s < 0.08 ? std::sqrt(mean_psd * std::pow(10, scene.joint_dB / 10)) : 0;
      }
      for (std::size_t b = 0; b < bands.size(); ++b) {
        double power = 0;
        const double centre_kHz = 1e-3 * std::sqrt(kLeakBands[b].low_Hz * kLeakBands[b].high_Hz);
        for (const SoundScene::Leak& leak : scene.leaks) {
          const double loss_dB =
              centre_kHz * scene.Loss_dB_kHz(x, leak.chainage_m) + scene.TeeLoss_dB(x, leak.chainage_m);
          power += mean_psd * std::pow(10, 0.1 * (leak.snr_dB - loss_dB));
        }
        gain[b] = std::sqrt(power);
      }
    }
    double p = level * background.Step(white.Next(), floor.Next());
    if (burst > 0) p += burst * joints.Next();
    if (scene.tone_Pa > 0)
      p += scene.tone_Pa *
           std::cos(2 * std::numbers::pi * scene.tone_Hz * static_cast<double>(i) / scene.rate_Hz);
    if (!scene.leaks.empty()) {
      for (std::size_t b = 0; b < bands.size(); ++b) p += gain[b] * bands[b].Step(leak_white.Next());
    }
    counts_[i] = static_cast<std::int32_t>(std::lround(p / kScale_Pa));
  }
}

inline void SoundRecord::Feed(LeakLocator& locator, std::size_t block_samples) const {
  const Rate rate(scene_.rate_Hz), nav_rate(100);
  std::int64_t next_nav = 0;
  for (std::size_t begin = 0; begin < counts_.size(); begin += block_samples) {
    const std::size_t size = std::min(block_samples, counts_.size() - begin);
    const RobotTime stamp(SampleOffset(static_cast<std::int64_t>(begin + size) - 1, rate));
    for (; RobotTime(SampleOffset(next_nav, nav_rate)) <= stamp; ++next_nav) {
      NavState nav;
      nav.stamp = RobotTime(SampleOffset(next_nav, nav_rate));
      nav.valid = true;
      nav.chainage_m = scene_.speed_m_s * Seconds(nav.stamp);
      nav.chainage_sd_m = 0.003;
      nav.p_W = {nav.chainage_m, 0, 0};
      locator.IngestNav(nav);
    }
    locator.IngestAudio({stamp, scene_.rate_Hz, kScale_Pa, std::span(counts_).subspan(begin, size)});
  }
  locator.Finish();
}

}  // namespace piperun::estimator::testing
