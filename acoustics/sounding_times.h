#pragma once

#include <limits>

#include "base/time.h"

namespace piperun::acoustics {

/// From when to when a source sounds, and how it fades.
struct SoundingTimes {
  double on_s = -std::numeric_limits<double>::infinity();  ///< true time
  double off_s = std::numeric_limits<double>::infinity();
  double ramp_s = 0.1;  ///< of either fade; both lie between on and off

  friend bool operator==(const SoundingTimes&, const SoundingTimes&) = default;
};

/// Share of the full pressure amplitude that a source has at a time: sin(pi x / 2), x going from 0 to 1
/// within the ramp after on_s and back to 0 within the ramp before off_s, so that its power goes along a
/// raised cosine. Zero outside. Fades that overlap multiply.
double CalcAmplitudeShare(const SoundingTimes& times, TrueTime t);

/// Its square.
double CalcPowerShare(const SoundingTimes& times, TrueTime t);

}  // namespace piperun::acoustics
