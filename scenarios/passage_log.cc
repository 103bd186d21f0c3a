#include "scenarios/passage_log.h"

#include <algorithm>
#include <cmath>

namespace piperun::scenarios {
namespace {

constexpr double kLookRate_Hz = 10;

/// The first that hears any of the band.
acoustics::Hydrophone* FindListener(const Assembly& assembly) {
  for (const auto& channel : assembly.channels) {
    auto* hydrophone = dynamic_cast<HydrophoneChannel*>(channel.get());
    if (hydrophone && hydrophone->hydrophone().rate().Hz() > 2 * kPassageLow_Hz)
      return &hydrophone->hydrophone();
  }
  return nullptr;
}

/// To the nanosecond: from the closest step on at the speed the ball had there.
std::optional<TrueTime> FindTime(const sim::TruthState& closest, double leak_s_m, double step_s) {
  const double speed = closest.v_WB_W.norm();
  const double ahead_m = (closest.reversed ? -1 : 1) * (leak_s_m - closest.s_m);
  if (std::abs(ahead_m) > speed * step_s) return std::nullopt;
  return closest.time + (speed > 0 ? FromSeconds(ahead_m / speed) : Duration(0));
}

}  // namespace

PassageLog::PassageLog(const Assembly& assembly)
    : assembly_(assembly),
      hydrophone_(FindListener(assembly)),
      band_Pa2_(assembly.scene.leaks.size() + 1),
      snr_dB_(assembly.pipeline ? assembly.pipeline->leaks.size() : 0),
      logs_(snr_dB_.size()) {}

void PassageLog::Watch(const sim::TruthState& state) {
  for (std::size_t i = 0; i < logs_.size(); ++i) Approach(logs_[i], assembly_.pipeline->leaks[i], state);
  if (!hydrophone_ || logs_.empty() || state.time < SampleTime(next_look_, Rate(kLookRate_Hz))) return;
  ++next_look_;
  Listen(state);
}

void PassageLog::Approach(LeakLog& log, const Leak& leak, const sim::TruthState& state) const {
  if (state.pipe != leak.pipe) return;
  if (log.closest && std::abs(state.s_m - leak.s_m) >= std::abs(log.closest->s_m - leak.s_m)) return;
  log.closest = state;
  log.goes_on = log.audible_since.has_value();
  log.heard = log.goes_on ? std::optional(HeardSpan{*log.audible_since, state.time}) : std::nullopt;
}

void PassageLog::Listen(const sim::TruthState& state) {
  CalcSnr_dB(state);
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    LeakLog& log = logs_[i];
    if (!(snr_dB_[i] >= 0)) {
      log.audible_since.reset();
      log.goes_on = false;
      continue;
    }
    if (!log.audible_since) log.audible_since = state.time;
    const bool just_passed =
        log.closest && state.time - log.closest->time <= SampleOffset(1, Rate(kLookRate_Hz));
    if (!log.heard && just_passed) {
      log.heard = HeardSpan{log.closest->time, state.time};
      log.goes_on = true;
    }
    if (log.goes_on) log.heard->end = state.time;
  }
}

void PassageLog::CalcSnr_dB(const sim::TruthState& state) {
  const double high_Hz = std::min(kPassageHigh_Hz, hydrophone_->rate().Hz() / 2);
  hydrophone_->CalcBandPower(CalcListener(state, *assembly_.network()), kPassageLow_Hz, high_Hz, band_Pa2_);
  double noise_Pa2 = band_Pa2_.back();
  for (std::size_t i = 0; i < assembly_.scene.leaks.size(); ++i)
    if (assembly_.scene.leaks[i].role != acoustics::Role::kLeak) noise_Pa2 += band_Pa2_[i];
  for (std::size_t i = 0; i < snr_dB_.size(); ++i) snr_dB_[i] = 10 * std::log10(band_Pa2_[i] / noise_Pa2);
}

std::optional<Passage> PassageLog::Find(std::size_t leak) {
  const LeakLog& log = logs_[leak];
  if (!log.closest) return std::nullopt;
  Passage passage{.passed = FindTime(*log.closest, assembly_.pipeline->leaks[leak].s_m,
                                     assembly_.motion->rate().Period_s()),
                  .heard = log.heard,
                  .snr_dB = std::nullopt};
  if (hydrophone_) {
    CalcSnr_dB(*log.closest);
    passage.snr_dB = snr_dB_[leak];
  }
  return passage;
}

}  // namespace piperun::scenarios
