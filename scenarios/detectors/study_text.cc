#include "scenarios/detectors/study_text.h"

#include <algorithm>

#include "base/number.h"

namespace piperun::scenarios::detectors {
namespace {

std::string Fixed(const std::optional<double>& value, int decimals) {
  return value ? FormatFixed(*value, decimals) : "-";
}

std::optional<double> Share(int part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

std::string PlainOr(const std::optional<double>& value) { return value ? FormatNumber(*value) : ""; }

}  // namespace

ReproducedTable TabulateFound(const std::vector<Tally>& tallies) {
  ReproducedTable table{
      "Leaks found, at each locator's own threshold",
      {"pipe", "dB/m at 2 kHz", "SNR dB", "locator", "leaks", "Pd", "Pd low", "Pd high", "median m", "95 % m",
       "in 95 %", "flow dB median", "flow dB 95 %", "flow in 95 %", "false alarms", "km"},
      {}};
  for (const Tally& t : tallies) {
    if (!t.snr_dB) continue;
    const ShareInterval interval = CalcWilsonInterval(t.found, t.leaks);
    table.rows.push_back(
        {t.pipe, FormatDigits(t.slope_dB_m, 2), FormatNumber(*t.snr_dB), t.locator, std::to_string(t.leaks),
         Fixed(Share(t.found, static_cast<std::size_t>(t.leaks)), 3), FormatFixed(interval.low, 3),
         FormatFixed(interval.high, 3), Fixed(CalcAbsoluteQuantile(t.errors_m, 0.5), 3),
         Fixed(CalcAbsoluteQuantile(t.errors_m, 0.95), 3), Fixed(Share(t.covered, t.errors_m.size()), 2),
         Fixed(CalcAbsoluteQuantile(t.flow_errors_dB, 0.5), 1),
         Fixed(CalcAbsoluteQuantile(t.flow_errors_dB, 0.95), 1),
         Fixed(Share(t.flow_covered, t.flow_errors_dB.size()), 2), std::to_string(t.false_alarms),
         FormatFixed(t.km, 1)});
  }
  return table;
}

ReproducedTable TabulateFalseAlarms(const std::vector<Tally>& tallies) {
  std::vector<Tally> sums;
  for (const Tally& t : tallies) {
    auto sum = std::find_if(sums.begin(), sums.end(),
                            [&](const Tally& s) { return s.pipe == t.pipe && s.locator == t.locator; });
    if (sum == sums.end()) {
      sums.push_back(t);
      continue;
    }
    sum->km += t.km;
    sum->false_alarms += t.false_alarms;
  }
  ReproducedTable table{
      "False alarms", {"pipe", "locator", "km", "false alarms", "per km", "95 % from", "to"}, {}};
  for (const Tally& s : sums) {
    const bool heard = s.km > 0;
    const CountInterval count = CalcPoissonInterval(s.false_alarms);
    table.rows.push_back({s.pipe, s.locator, FormatFixed(s.km, 1), std::to_string(s.false_alarms),
                          heard ? FormatFixed(s.false_alarms / s.km, 3) : "-",
                          heard ? FormatFixed(count.low / s.km, 3) : "-",
                          heard ? FormatFixed(count.high / s.km, 3) : "-"});
  }
  return table;
}

std::string WriteStudyCsv(const std::vector<Tally>& tallies) {
  std::string csv =
      "pipe,slope_dB_m,snr_dB,locator,leaks,found,pd,pd_low,pd_high,error_median_m,error_p95_m,covered_95,"
      "flow_error_median_dB,flow_error_p95_dB,flow_covered_95,false_alarms,km\n";
  for (const Tally& t : tallies) {
    const ShareInterval interval = CalcWilsonInterval(t.found, t.leaks);
    const std::optional<double> cells[] = {Share(t.found, static_cast<std::size_t>(t.leaks)),
                                           interval.low,
                                           interval.high,
                                           CalcAbsoluteQuantile(t.errors_m, 0.5),
                                           CalcAbsoluteQuantile(t.errors_m, 0.95),
                                           Share(t.covered, t.errors_m.size()),
                                           CalcAbsoluteQuantile(t.flow_errors_dB, 0.5),
                                           CalcAbsoluteQuantile(t.flow_errors_dB, 0.95),
                                           Share(t.flow_covered, t.flow_errors_dB.size()),
                                           t.false_alarms,
                                           t.km};
    csv += t.pipe + "," + FormatNumber(t.slope_dB_m) + "," + PlainOr(t.snr_dB) + "," + t.locator + "," +
           std::to_string(t.leaks) + "," + std::to_string(t.found);
    for (const auto& cell : cells) csv += "," + PlainOr(cell);
    csv += "\n";
  }
  return csv;
}

}  // namespace piperun::scenarios::detectors
