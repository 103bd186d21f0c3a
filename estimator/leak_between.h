#pragma once

#include <vector>

#include "estimator/estimator.h"

namespace piperun::estimator {

/// A stretch of the way between two sensors along which sound has one speed.
struct SoundStretch {
  double length_m = 0;
  double speed_m_s = 0;
};

/// What is known of the way from sensor a to sensor b.
struct SoundWay {
  std::vector<SoundStretch> stretches;  ///< from a to b
  double length_sd_m = 0;               ///< of the whole length
  double speed_sd = 0;                  ///< of the speeds, relative, common to all stretches
};

double CalcLength_m(const SoundWay& way);
double CalcTravelTime_s(const SoundWay& way);

/// Where a source lies between two sensors.
struct LeakBetween {
  double from_a_m = 0;
  double sigma_m = 0;
  ChainageInterval interval{};  ///< 95 %, metres from a
  /// The sound may come from beyond a sensor, whose distance the delay does not tell: the interval reaches
  /// the sensor's place.
  bool maybe_beyond_a = false, maybe_beyond_b = false;
};

/// The place d_1 from sensor a of the source whose sound reaches b by t later than a. In a pipe of one speed
///   d_1 = (d - c t) / 2,   sigma^2 = (sigma_d^2 + (t sigma_c)^2 + (c sigma_t)^2) / 4
/// (Gao, Brennan, Joseph, Muggleton & Hunaidi, J. Sound Vib. 277, 133 (2004), eq. 1); along several stretches
/// the sound takes (T - t) / 2 of the whole travel time T to a, and c is that of the stretch where this
/// leads. A source beyond a or b gives |t| = T whatever its distance. A place that comes out beyond an end is
/// counted on with the speed there. Range: lengths and speeds > 0.
LeakBetween LocateBetween(const SoundWay& way, double delay_s, double delay_sd_s);

}  // namespace piperun::estimator
