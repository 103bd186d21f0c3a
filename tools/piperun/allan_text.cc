#include "tools/piperun/allan_text.h"

#include <fmt/core.h>

#include <cmath>

#include "scenarios/physical_unit.h"
#include "tools/piperun/number_text.h"
#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

using estimator::Index;
using estimator::NoiseTerm;

/// In the unit data sheets use for it: the first that makes it a readable number, else SI.
std::string DataSheetText(double si, const std::string& unit) {
  const auto units = scenarios::DataSheetUnits(scenarios::ParseUnit(unit, ""));
  if (units.empty()) return "";
  return fmt::format("{:.4g} {}", si / scenarios::ParseUnit(units.front(), "").factor, units.front());
}

void AddRow(Table& table, const scenarios::AllanChannel& channel, const std::string& name,
            const estimator::FittedTerm& term, const std::string& unit) {
  if (term.identifiable) {
    table.Add({channel.group, channel.axis, name, DataSheetText(term.value, unit),
               fmt::format("{:.5g} {}", term.value, unit),
               fmt::format("{:.4g} to {:.4g}", term.interval.low, term.interval.high)});
  } else {
    table.Add({channel.group, channel.axis, name, "not identifiable from this record", "",
               std::isfinite(term.interval.high) ? fmt::format("below {:.3g}", term.interval.high) : ""});
  }
}

void AddChannel(Table& table, const scenarios::AllanChannel& channel) {
  for (std::size_t i = 0; i < estimator::kNoiseTerms; ++i) {
    const auto term = static_cast<NoiseTerm>(i);
    const estimator::FittedTerm& fitted = channel.fit.terms[i];
    if (term == NoiseTerm::kGaussMarkov && fitted.interval.high == 0) continue;
    AddRow(table, channel, scenarios::NoiseTermName(term, channel.group), fitted,
           scenarios::NoiseTermUnit(term, channel.unit));
    if (term == NoiseTerm::kGaussMarkov)
      AddRow(table, channel, "Gauss-Markov time", channel.fit.gauss_markov_time_s, "s");
  }
}

}  // namespace

std::string DescribeAllan(const scenarios::AllanAnalysis& analysis) {
  const double period_s = analysis.timing.period_s;
  std::string text =
      fmt::format("{}: {} samples at {:.7g} Hz, {} of record\n\n", analysis.file, analysis.timing.rows,
                  1 / period_s, Clock(static_cast<double>(analysis.timing.rows) * period_s));
  Table table({"sensor", "axis", "term", "data sheet", "SI",
               fmt::format("{:g} % interval, SI", 100 * analysis.confidence)});
  for (const scenarios::AllanChannel& channel : analysis.channels) AddChannel(table, channel);
  text += table.Text();
  for (const std::string& note : analysis.notes) text += "Note: " + note + "\n";
  return text;
}

}  // namespace piperun::tools
