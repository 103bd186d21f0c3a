// Leak detectors against each other: kilometres of rendered sound, known leaks, known disturbances.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/number.h"
#include "scenarios/detectors/study.h"
#include "scenarios/detectors/study_flow.h"
#include "scenarios/detectors/study_text.h"
#include "scenarios/output_file.h"
#include "scenarios/reproduction.h"

namespace piperun::scenarios {
namespace {

using detectors::Tally;

constexpr double kFalseAlarms_per_km = 0.1;
constexpr int kLeaks = 400;          // from which shares are promised
constexpr double kMinCovered = 0.9;  // of the intervals that are said to hold 95 %

/// A promise of the matched filter.
struct Target {
  const char* pipe;
  double snr_dB;
  double min_found;
  double max_median_m, max_p95_m;  ///< 0: none
};
constexpr Target kTargets[] = {
    {"pvc_u", 0, 0.8, 0, 0},
    {"pvc_u", 3, 0.9, 0.1, 0.35},
    {"pvc_u", 6, 0.95, 0, 0},
    {"asbestos_cement", 3, 0.9, 0.35, 1.3},
    {"asbestos_cement", 6, 0.95, 0, 0},
    {"ductile_iron", 10, 0.8, 0, 0},
};

std::string Where(const Tally& tally) {
  return tally.pipe + " " + FormatDigits(tally.slope_dB_m, 2) + " dB/m, " + FormatNumber(*tally.snr_dB) +
         " dB";
}

/// With fewer leaks than the figures are promised from, a share is held against its target with the width
/// that so few leave: Wilson's upper end.
void HoldFound(const Tally& tally, const Target& target, ReproduceReport& report) {
  const double share = static_cast<double>(tally.found) / std::max(1, tally.leaks);
  const double held =
      tally.leaks < kLeaks ? detectors::CalcWilsonInterval(tally.found, tally.leaks).high : share;
  report.figures.push_back({Where(tally) + ": Pd of " + std::to_string(tally.leaks) + " leaks",
                            FormatFixed(share, 3), ">= " + FormatNumber(target.min_found),
                            held >= target.min_found});
}

void HoldError(const Tally& tally, double p, double limit_m, ReproduceReport& report) {
  const auto error_m = detectors::CalcAbsoluteQuantile(tally.errors_m, p);
  report.figures.push_back({Where(tally) + ": error, " + FormatNumber(100 * p) + " % quantile [m]",
                            error_m ? FormatFixed(*error_m, 3) : "-", "<= " + FormatNumber(limit_m),
                            error_m && *error_m <= limit_m});
}

void HoldTargets(const std::vector<Tally>& tallies, ReproduceReport& report) {
  for (const Target& target : kTargets) {
    for (const Tally& tally : tallies) {
      if (tally.locator != "matched_filter" || tally.pipe != target.pipe || tally.snr_dB != target.snr_dB)
        continue;
      HoldFound(tally, target, report);
      if (target.max_median_m > 0) HoldError(tally, 0.5, target.max_median_m, report);
      if (target.max_p95_m > 0) HoldError(tally, 0.95, target.max_p95_m, report);
    }
  }
}

/// Intervals of 95 % that hold the truth, over all the matched filter's leaks: places and flows.
void HoldCoverage(const std::vector<Tally>& tallies, ReproduceReport& report) {
  int places = 0, places_covered = 0, flows = 0, flows_covered = 0;
  for (const Tally& tally : tallies) {
    if (tally.locator != "matched_filter") continue;
    places += tally.found;
    places_covered += tally.covered;
    flows += static_cast<int>(tally.flow_errors_dB.size());
    flows_covered += tally.flow_covered;
  }
  const auto hold = [&](const std::string& what, int covered, int of) {
    const double share = static_cast<double>(covered) / std::max(1, of);
    report.figures.push_back({"95 % intervals that hold the " + what + ", of " + std::to_string(of),
                              FormatFixed(share, 3), ">= " + FormatNumber(kMinCovered),
                              detectors::CalcWilsonInterval(covered, of).high >= kMinCovered});
  };
  hold("place", places_covered, places);
  hold("flow", flows_covered, flows);
}

/// Counts are Poisson: with so few kilometres, up to the 97.7 % quantile of 0.1 per km, lambda + 2
/// sqrt(lambda) rounded up.
void HoldFalseAlarms(const std::vector<Tally>& tallies, ReproduceReport& report) {
  double km = 0;
  int false_alarms = 0;
  for (const Tally& tally : tallies) {
    if (tally.locator != "matched_filter") continue;
    km += tally.km;
    false_alarms += tally.false_alarms;
  }
  const double expected = kFalseAlarms_per_km * km;
  const int allowed = static_cast<int>(std::ceil(expected + 2 * std::sqrt(expected) * (km < 100 ? 1 : 0)));
  report.figures.push_back({"false alarms in " + FormatDigits(km, 3) + " km", std::to_string(false_alarms),
                            "<= " + std::to_string(allowed), false_alarms <= allowed});
}

ReproduceReport Study(const ReproduceOptions& options) {
  detectors::StudySize size;
  size.leaks_per_cell = std::max(1, static_cast<int>(std::lround(size.leaks_per_cell * options.size)));
  size.quiet_km *= options.size;
  size.seed = options.seed;
  size.jobs = options.jobs;
  size.stop = options.stop;
  size.progress = [&](double fraction) {
    if (options.progress) options.progress(fraction, "listening");
  };
  const auto tallies = detectors::StudyDetectors(size);
  ReproduceReport report;
  report.tables.push_back(detectors::TabulateFound(tallies));
  report.tables.push_back(detectors::TabulateFalseAlarms(tallies));
  const auto curves = detectors::CalcFlowCurves(tallies);
  report.tables.push_back(detectors::TabulateFlows(curves));
  HoldTargets(tallies, report);
  HoldCoverage(tallies, report);
  HoldFalseAlarms(tallies, report);
  if (!options.out.empty()) {
    std::filesystem::create_directories(options.out);
    WriteTextFile(options.out / "detectors.csv", detectors::WriteStudyCsv(tallies));
    WriteTextFile(options.out / "detectors.svg", detectors::DrawStudySvg(tallies));
    WriteTextFile(options.out / "detectors_flow.csv", detectors::WriteFlowCsv(curves));
    WriteTextFile(options.out / "detectors_flow.svg", detectors::DrawFlowSvg(curves));
  }
  return report;
}

}  // namespace

namespace reproductions::detectors {
Reproduction Kind() {
  return {"detectors",
          "Leak detectors compared over loudness, wall and method: found, false alarms per km, errors", Study,
          true};
}
}  // namespace reproductions::detectors

}  // namespace piperun::scenarios
