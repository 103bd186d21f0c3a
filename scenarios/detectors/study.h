#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimator/leak_locator.h"
#include "scenarios/detectors/survey.h"

namespace piperun::scenarios::detectors {

/// Leaks that are equally loud.
struct Cell {
  double snr_dB = 0;
  double share = 1;  ///< of the study's leaks per cell
};

/// A pipe to survey and how loud its leaks are.
struct StudiedPipe {
  Survey survey;              ///< without leaks
  double slope_dB_m = 0;      ///< at 2 kHz, the geometric middle of 1 to 4 kHz
  double spacing_m = 0;       ///< mean distance of neighbouring leaks
  double match_radius_m = 0;  ///< within which a report is a detection
  std::vector<Cell> cells;
};

/// How differently loud leaks of one flow are, standard deviation: the open literature gives levels within 15
/// dB either way, taken as two standard deviations.
constexpr double kLoudness_dB = 7.5;

/// Buried mains of plastic (4 dB/m), asbestos cement (1 dB/m) and iron (0.24 dB/m).
std::vector<StudiedPipe> StudiedPipes();

/// What one locator made of one kind of leaks.
struct Tally {
  std::string pipe, locator;
  std::optional<double> snr_dB;  ///< nothing: pipes without leaks
  double slope_dB_m = 0;
  double km = 0;
  int leaks = 0, found = 0, false_alarms = 0;
  std::vector<double> errors_m;        ///< estimated minus true
  int covered = 0;                     ///< true places within the stated 95 % interval
  std::vector<double> flow_errors_dB;  ///< 20 lg (estimated / true)
  int flow_covered = 0;                ///< of them within the stated 95 % interval
};

struct StudySize {
  int leaks_per_cell = 400;
  double quiet_km = 20;  ///< per pipe
  std::uint64_t seed = 1;
  int jobs = 0;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double)> progress{};
};

/// All pipes, all SNRs, all locators; every run is one kilometre or so. Deterministic in size and seed.
std::vector<Tally> StudyDetectors(const StudySize& size);

/// A locator as the study hears it: defaults, but as many leaks per run as there are.
std::unique_ptr<estimator::LeakLocator> MakeStudiedLocator(const estimator::LocatorKind& kind,
                                                           const estimator::EstimatorStart& start);

/// The study's share of leaks found by a locator in a pipe at an SNR, on the line between the two nearest
/// cells; nothing outside the cells.
std::optional<double> InterpolateFound(const std::vector<Tally>& tallies, const std::string& pipe,
                                       const std::string& locator, double snr_dB);

/// Wilson's interval of a share k / n at 95 % (J. Am. Stat. Assoc. 22, 209, 1927); [0, 1] for n = 0.
struct ShareInterval {
  double low = 0, high = 1;
};
ShareInterval CalcWilsonInterval(int k, int n);

/// Garwood's interval of a Poisson count's mean at 95 % (Biometrika 28, 437, 1936): half the chi-square
/// quantiles of 2k and 2k + 2 degrees of freedom. Range: k >= 0.
struct CountInterval {
  double low = 0, high = 0;
};
CountInterval CalcPoissonInterval(int k);

/// Type 7 of Hyndman & Fan (linear between order statistics) of absolute values; nothing for none.
std::optional<double> CalcAbsoluteQuantile(std::vector<double> values, double p);

}  // namespace piperun::scenarios::detectors
