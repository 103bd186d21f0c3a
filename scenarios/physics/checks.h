#pragma once

#include <string>
#include <string_view>

#include "scenarios/reproduction.h"

namespace piperun::scenarios::physics {

/// Holds figures against what they should be and keeps them, under the name of one group.
class Checks {
 public:
  Checks(ReproduceReport& report, std::string group) : report_(report), group_(std::move(group)) {}

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

// The groups, each a study of its own. docs/physics.md, "What checks it", tells what they are about.
void CheckDrag(const ReproduceOptions& options, ReproduceReport& report);
void CheckFall(const ReproduceOptions& options, ReproduceReport& report);
void CheckContact(const ReproduceOptions& options, ReproduceReport& report);
void CheckOrder(const ReproduceOptions& options, ReproduceReport& report);
void CheckCarried(const ReproduceOptions& options, ReproduceReport& report);
void CheckClosure(const ReproduceOptions& options, ReproduceReport& report);
void CheckTurbulence(const ReproduceOptions& options, ReproduceReport& report);

}  // namespace piperun::scenarios::physics
