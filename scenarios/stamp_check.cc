#include "scenarios/stamp_check.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace piperun::scenarios {
namespace {

constexpr double kGap = 1.5;  ///< periods

}  // namespace

StampVerdict StampCheck::Take(std::int64_t stamp_ns, RecordTiming& timing, const std::string& where) {
  const double interval_s = any_ ? static_cast<double>(stamp_ns - last_ns_) * 1e-9 : 0;
  if (any_ && interval_s < 0) {
    throw InputError("the time stamp " + std::to_string(stamp_ns) +
                         " ns lies before that of the row above, " + std::to_string(last_ns_) +
                         " ns; cut the file there, or sort it",
                     "", where);
  }
  const bool first = !any_;
  any_ = true;
  if (!first && interval_s == 0) return StampVerdict::kDuplicate;
  last_ns_ = stamp_ns;
  if (first) return StampVerdict::kStartsSegment;
  const bool gap = interval_s > kGap * nominal_s_;
  if (gap) {
    if (timing.gaps.count++ == 0) timing.gaps.first = where;
    timing.missing_s += interval_s - nominal_s_;
  }
  if (gap || std::exchange(broken_, false)) return broken_ = false, StampVerdict::kStartsSegment;
  const double off_s = interval_s - nominal_s_;
  ++intervals_;
  sum_s_ += off_s;
  squares_s2_ += off_s * off_s;
  smallest_s_ = std::min(smallest_s_, off_s);
  largest_s_ = std::max(largest_s_, off_s);
  return StampVerdict::kNext;
}

void StampCheck::Summarise(RecordTiming& timing) const {
  timing.period_s = nominal_s_;
  if (intervals_ == 0) return;
  const double n = static_cast<double>(intervals_), mean_s = sum_s_ / n;
  timing.period_s = nominal_s_ + mean_s;
  timing.jitter_sd_s = std::sqrt(std::max(0.0, squares_s2_ / n - mean_s * mean_s));
  timing.jitter_max_s = std::max(largest_s_ - mean_s, mean_s - smallest_s_);
}

double CalcMedianPeriod_s(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<std::int64_t> intervals;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    if (stamps_ns[i] > stamps_ns[i - 1]) intervals.push_back(stamps_ns[i] - stamps_ns[i - 1]);
  }
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return static_cast<double>(*middle) * 1e-9;
}

}  // namespace piperun::scenarios
