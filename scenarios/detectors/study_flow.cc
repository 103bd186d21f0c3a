#include "scenarios/detectors/study_flow.h"

#include <algorithm>
#include <cmath>

#include "base/number.h"

namespace piperun::scenarios::detectors {
namespace {

constexpr double kPressures_bar[] = {1, 3, 6};
constexpr double kFlows_L_min[] = {0.01, 0.03, 0.1, 0.3, 1, 3};
constexpr int kCells = 160;
constexpr double kReach = 4;  // standard deviations
constexpr const char* kLocator = "matched_filter";

double Share(const Tally& tally) { return static_cast<double>(tally.found) / tally.leaks; }

/// The tallies of one curve: one locator in one pipe.
std::vector<const Tally*> FindCells(const std::vector<Tally>& tallies, const std::string& pipe,
                                    const std::string& locator) {
  std::vector<const Tally*> cells;
  for (const Tally& t : tallies)
    if (t.pipe == pipe && t.locator == locator && t.snr_dB && t.leaks > 0) cells.push_back(&t);
  std::sort(cells.begin(), cells.end(),
            [](const Tally* a, const Tally* b) { return *a->snr_dB < *b->snr_dB; });
  return cells;
}

FlowPoint MakePoint(const std::vector<Tally>& tallies, const StudiedPipe& pipe, double pressure_bar,
                    double flow_L_min) {
  const std::string& name = pipe.survey.pipe;
  FlowPoint point;
  point.flow_L_min = flow_L_min;
  point.snr_dB = CalcJetSnr_dB(pipe.survey, {flow_L_min * 1e-3 / 60, 1e5 * pressure_bar, 0});
  point.found = InterpolateFound(tallies, name, kLocator, point.snr_dB);
  point.any_loudness = BoundFoundAtAnyLoudness(tallies, name, kLocator, point.snr_dB);
  return point;
}

}  // namespace

ShareInterval BoundFound(const std::vector<Tally>& tallies, const std::string& pipe,
                         const std::string& locator, double snr_dB) {
  const auto cells = FindCells(tallies, pipe, locator);
  if (cells.empty()) return {};
  if (snr_dB < *cells.front()->snr_dB) return {0, Share(*cells.front())};
  if (snr_dB > *cells.back()->snr_dB) return {Share(*cells.back()), 1};
  const double share = *InterpolateFound(tallies, pipe, locator, snr_dB);
  return {share, share};
}

ShareInterval BoundFoundAtAnyLoudness(const std::vector<Tally>& tallies, const std::string& pipe,
                                      const std::string& locator, double snr_dB) {
  ShareInterval sum{0, 0};
  double weights = 0;
  for (int i = 0; i < kCells; ++i) {
    const double u = kReach * (2 * (i + 0.5) / kCells - 1), weight = std::exp(-0.5 * u * u);
    const ShareInterval found = BoundFound(tallies, pipe, locator, snr_dB + kLoudness_dB * u);
    sum.low += weight * found.low;
    sum.high += weight * found.high;
    weights += weight;
  }
  return {sum.low / weights, sum.high / weights};
}

std::vector<FlowCurve> CalcFlowCurves(const std::vector<Tally>& tallies) {
  std::vector<FlowCurve> curves;
  for (const StudiedPipe& pipe : StudiedPipes()) {
    for (const double pressure_bar : kPressures_bar) {
      FlowCurve curve{pipe.survey.pipe, pipe.survey.bore_m, pressure_bar, {}};
      for (const double flow_L_min : kFlows_L_min)
        curve.points.push_back(MakePoint(tallies, pipe, pressure_bar, flow_L_min));
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

ReproducedTable TabulateFlows(const std::vector<FlowCurve>& curves) {
  ReproducedTable table{
      "Pd of the matched filter against flow: by way of the SNR of leaks as loud as most (-: outside the "
      "studied range), and of leaks of any loudness, 7.5 dB either way, at least and at most",
      {"pipe", "bore mm", "bar", "L/min", "SNR dB", "Pd", "any loudness", "at most"},
      {}};
  for (const FlowCurve& curve : curves) {
    for (const FlowPoint& point : curve.points) {
      table.rows.push_back({curve.pipe, FormatFixed(1000 * curve.bore_m, 1), FormatNumber(curve.pressure_bar),
                            FormatNumber(point.flow_L_min), FormatFixed(point.snr_dB, 1),
                            point.found ? FormatFixed(*point.found, 2) : "-",
                            FormatFixed(point.any_loudness.low, 2), FormatFixed(point.any_loudness.high, 2)});
    }
  }
  return table;
}

std::string WriteFlowCsv(const std::vector<FlowCurve>& curves) {
  std::string csv = "pipe,bore_m,pressure_bar,flow_L_min,snr_dB,pd,pd_any_loudness_min,pd_any_loudness_max\n";
  for (const FlowCurve& curve : curves) {
    for (const FlowPoint& point : curve.points) {
      csv += curve.pipe + "," + FormatNumber(curve.bore_m) + "," + FormatNumber(curve.pressure_bar) + "," +
             FormatNumber(point.flow_L_min) + "," + FormatNumber(point.snr_dB) + "," +
             (point.found ? FormatNumber(*point.found) : "") + "," + FormatNumber(point.any_loudness.low) +
             "," + FormatNumber(point.any_loudness.high) + "\n";
    }
  }
  return csv;
}

}  // namespace piperun::scenarios::detectors
