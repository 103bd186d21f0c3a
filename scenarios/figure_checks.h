#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scenarios/reproduction.h"

namespace piperun::scenarios {

/// Holds figures against what they should be and keeps them, under the name of one group.
class FigureChecks {
 public:
  FigureChecks(ReproduceReport& report, std::string group) : report_(report), group_(std::move(group)) {}

  /// |measured - expected| <= tolerance; not a number fails.
  void Near(const std::string& what, double measured, double expected, double tolerance,
            std::string_view source);
  /// |measured / expected - 1| <= tolerance.
  void Relative(const std::string& what, double measured, double expected, double tolerance,
                std::string_view source);
  void AtMost(const std::string& what, double measured, double limit, std::string_view source);
  void AtLeast(const std::string& what, double measured, double limit, std::string_view source);
  void Between(const std::string& what, double measured, double low, double high, std::string_view source);

  ReproduceReport& report() { return report_; }

 private:
  void Add(const std::string& what, const std::string& measured, const std::string& expected, bool passed,
           std::string_view source);

  ReproduceReport& report_;
  std::string group_;
};

/// A part of a study.
using CheckGroup = void (*)(const ReproduceOptions&, ReproduceReport&);

/// Runs the groups side by side and puts their reports together in their order. `note` goes with the
/// progress.
ReproduceReport RunGroups(std::span<const CheckGroup> groups, const std::string& note,
                          const ReproduceOptions& options);

}  // namespace piperun::scenarios
