#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/assemble.h"
#include "sim/truth.h"

namespace piperun::scenarios {

/// Where a leak is listened for.
inline constexpr double kPassageLow_Hz = 1000, kPassageHigh_Hz = 4000;

/// A span of true time.
struct HeardSpan {
  TrueTime begin{}, end{};
};

/// How the ball passed a leak.
struct Passage {
  std::optional<TrueTime> passed;  ///< nothing: it turned back or stopped short
  std::optional<HeardSpan> heard;  ///< around the closest approach; nothing: never above all the rest
  std::optional<double> snr_dB;    ///< at the closest approach; nothing: no hydrophone hears the band
};

/// Watches the ball's approach to every leak, and from when to when the leak is heard: its power in the
/// water between 1 and 4 kHz (or as much of that as the first hydrophone records) is at least that of
/// everything that is not a leak (other sounds, background, self noise, rounding; no knocks and no tones).
/// That is looked at ten times a second.
class PassageLog {
 public:
  explicit PassageLog(const Assembly& assembly);

  /// Call after every step.
  void Watch(const sim::TruthState& state);
  /// Of a leak, by index; nothing: the ball was never in its pipe.
  std::optional<Passage> Find(std::size_t leak);

 private:
  struct LeakLog {
    std::optional<sim::TruthState> closest;
    std::optional<HeardSpan> heard;  ///< around the closest approach
    bool goes_on = false;            ///< it does
    std::optional<TrueTime> audible_since;
  };

  void Approach(LeakLog& log, const Leak& leak, const sim::TruthState& state) const;
  void Listen(const sim::TruthState& state);
  /// Of each leak, into snr_dB_.
  void CalcSnr_dB(const sim::TruthState& state);

  const Assembly& assembly_;
  acoustics::Hydrophone* hydrophone_;  ///< that hears the band; null: none
  std::vector<double> band_Pa2_;       // scratch: of every sound, and of the rest
  std::vector<double> snr_dB_;         // scratch
  std::vector<LeakLog> logs_;
  std::int64_t next_look_ = 0;
};

}  // namespace piperun::scenarios
