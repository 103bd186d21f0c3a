#include "scenarios/figure_checks.h"

#include <cmath>
#include <iterator>
#include <utility>

#include "base/number.h"
#include "scenarios/parallel.h"

namespace piperun::scenarios {
namespace {

/// As many decimals as show a difference of a tenth of the tolerance.
std::string TextWithin(double value, double tolerance) {
  if (tolerance <= 0) return FormatDigits(value, 4);
  return FormatFixed(value,
                     static_cast<int>(std::fmin(std::fmax(1 - std::floor(std::log10(tolerance)), 0), 15)));
}

}  // namespace

void FigureChecks::Add(const std::string& what, const std::string& measured, const std::string& expected,
                       bool passed, std::string_view source) {
  report_.figures.push_back({group_ + ": " + what, measured, expected, passed, std::string(source)});
}

void FigureChecks::Near(const std::string& what, double measured, double expected, double tolerance,
                        std::string_view source) {
  Add(what, TextWithin(measured, tolerance),
      TextWithin(expected, tolerance) + " +- " + FormatDigits(tolerance, 2),
      std::abs(measured - expected) <= tolerance, source);
}

void FigureChecks::Relative(const std::string& what, double measured, double expected, double tolerance,
                            std::string_view source) {
  const double absolute = tolerance * std::abs(expected);
  Add(what, TextWithin(measured, absolute) + " (" + FormatDigits(measured / expected - 1, 2) + ")",
      TextWithin(expected, absolute) + " (1 +- " + FormatDigits(tolerance, 2) + ")",
      std::abs(measured - expected) <= absolute, source);
}

void FigureChecks::AtMost(const std::string& what, double measured, double limit, std::string_view source) {
  Add(what, FormatDigits(measured, 3), "<= " + FormatDigits(limit, 3), measured <= limit, source);
}

void FigureChecks::AtLeast(const std::string& what, double measured, double limit, std::string_view source) {
  Add(what, FormatDigits(measured, 4), ">= " + FormatDigits(limit, 4), measured >= limit, source);
}

void FigureChecks::Between(const std::string& what, double measured, double low, double high,
                           std::string_view source) {
  Add(what, FormatDigits(measured, 4), FormatDigits(low, 4) + " to " + FormatDigits(high, 4),
      measured >= low && measured <= high, source);
}

ReproduceReport RunGroups(std::span<const CheckGroup> groups, const std::string& note,
                          const ReproduceOptions& options) {
  std::vector<ReproduceReport> parts(groups.size());
  RunParallel(
      static_cast<int>(groups.size()), options.jobs, options.stop,
      [&](int i) { groups[static_cast<std::size_t>(i)](options, parts[static_cast<std::size_t>(i)]); },
      [&](double fraction) {
        if (options.progress) options.progress(fraction, note);
      });
  ReproduceReport report;
  for (ReproduceReport& part : parts) {
    std::move(part.tables.begin(), part.tables.end(), std::back_inserter(report.tables));
    std::move(part.figures.begin(), part.figures.end(), std::back_inserter(report.figures));
  }
  return report;
}

}  // namespace piperun::scenarios
