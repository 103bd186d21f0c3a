#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "estimator/cross_correlation.h"
#include "estimator/leak_between.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// A pipe whose sound speed is worked out (acoustics/pipe_wave.h), in water of `water_C`.
struct CorrelatePipe {
  std::string material = "pvc_u";
  double diameter_m = 0;  ///< bore
  double wall_thickness_m = 0;
  double water_C = 10;
};

struct CorrelateOptions {
  std::array<std::filesystem::path, 2> audio;  ///< of sensors a and b, begun at the same instant
  double distance_m = 0;                       ///< along the pipe from a to b
  double distance_sd_m = 0.1;
  std::optional<double> speed_m_s;  ///< of sound; nothing: of `pipe`
  std::optional<CorrelatePipe> pipe;
  double speed_sd = 0.03;  ///< relative; plastic rather 0.1
  estimator::CorrelationWeight weight = estimator::CorrelationWeight::kScot;
  double band_low_Hz = 10;
  double band_high_Hz = 0;  ///< 0: 0.45 of the sampling rate
};

struct Correlation {
  std::array<std::string, 2> audio;
  double rate_Hz = 0;
  double duration_s = 0;  ///< in common
  double distance_m = 0;
  double speed_m_s = 0;
  estimator::DelayEstimate delay;
  estimator::LeakBetween leak;  ///< where delay.correlated
};

/// Where the sound comes from that two sensors on a pipe share. Delays are sought up to the travel time
/// between the sensors and a tenth more. Throws InputError for files that are no mono sound, of different
/// rates, silent, not finite or too short, for a band that is none, and for sizes that are not positive.
Correlation Correlate(const CorrelateOptions& options);

/// {"schema": "piperun.correlate/1", "a", "b", "rate_Hz", "duration_s", "distance_m", "speed_m_s", "band_Hz",
/// "correlated", "false_alarm", "correlation", "side_peak", "delay_s", "delay_sigma_s", "from_a_m",
/// "sigma_m", "interval_m" (95 %), "maybe_beyond"}; from "delay_s" on null where nothing is correlated.
std::string WriteCorrelationJson(const Correlation& correlation);
/// The correlation against the place that its lag stands for, and the coherence against frequency.
std::string DrawCorrelationSvg(const Correlation& correlation);

}  // namespace piperun::scenarios
