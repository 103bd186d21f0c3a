#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/static_record.h"

namespace piperun::scenarios {

/// What to do with a row, by its stamp.
enum class StampVerdict { kNext, kStartsSegment, kDuplicate };

/// Watches the stamps of a record: which intervals are gaps, and how regular the others are.
class StampCheck {
 public:
  explicit StampCheck(double nominal_period_s) : nominal_s_(nominal_period_s) {}
  /// Throws InputError at `where` when the stamp lies before the last one.
  StampVerdict Take(std::int64_t stamp_ns, RecordTiming& timing, const std::string& where);
  /// The next row does not follow: one was left out. Its interval is a gap whatever its length.
  void Break() { broken_ = true; }
  void Summarise(RecordTiming& timing) const;

 private:
  double nominal_s_;
  bool any_ = false;
  bool broken_ = false;
  std::int64_t last_ns_ = 0;
  std::int64_t intervals_ = 0;
  double sum_s_ = 0;  ///< of departures from the nominal period
  double squares_s2_ = 0;
  double smallest_s_ = 0, largest_s_ = 0;
};

/// Median of the intervals that rise; nothing when there are none.
double CalcMedianPeriod_s(const std::vector<std::int64_t>& stamps_ns);

}  // namespace piperun::scenarios
