#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/detectors/study.h"
#include "scenarios/reproduction.h"

namespace piperun::scenarios::detectors {

/// What a locator finds of leaks of one flow.
struct FlowPoint {
  double flow_L_min = 0;
  double snr_dB = 0;            ///< at the hole, of a leak as loud as most of its flow
  std::optional<double> found;  ///< of such leaks; nothing: outside the studied range
  ShareInterval any_loudness;   ///< of all leaks of that flow
};

/// A wall and a pressure.
struct FlowCurve {
  std::string pipe;
  double bore_m = 0;
  double pressure_bar = 0;
  std::vector<FlowPoint> points;
};

/// Share found at an SNR, at least and at most: InterpolateFound within the studied cells; below them from
/// nothing to the lowest cell's share, above them from the highest cell's to all, for louder leaks are found
/// no less often. [0, 1] for a locator or pipe that was not studied.
ShareInterval BoundFound(const std::vector<Tally>& tallies, const std::string& pipe,
                         const std::string& locator, double snr_dB);

/// The mean of those bounds over leaks whose SNR is normal about snr_dB with standard deviation
/// kLoudness_dB: what is found of all leaks of one flow. By the midpoint rule over +-4 standard deviations.
ShareInterval BoundFoundAtAnyLoudness(const std::vector<Tally>& tallies, const std::string& pipe,
                                      const std::string& locator, double snr_dB);

/// The matched filter's, in all studied walls at 1, 3 and 6 bar.
std::vector<FlowCurve> CalcFlowCurves(const std::vector<Tally>& tallies);

ReproducedTable TabulateFlows(const std::vector<FlowCurve>& curves);
std::string WriteFlowCsv(const std::vector<FlowCurve>& curves);
/// Pd against flow, a panel for each wall, a band between the bounds for each pressure.
std::string DrawFlowSvg(const std::vector<FlowCurve>& curves);

}  // namespace piperun::scenarios::detectors
