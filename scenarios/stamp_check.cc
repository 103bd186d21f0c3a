#include "scenarios/stamp_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/check.h"

namespace piperun::scenarios {
namespace {

constexpr double kMemory = 100;           ///< stamps that the grid's place is the mean of
constexpr std::size_t kLongestLag = 256;  ///< where the period is sought

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
  ++stamps_;
  if (first) {
    grid_ns_ = stamp_ns;
    grid_s_ = -grid_.first_off_s;
    return StampVerdict::kStartsSegment;
  }
  const double since_grid_s = static_cast<double>(stamp_ns - grid_ns_) * 1e-9 - grid_s_;
  const double steps = std::max(0.0, std::round(since_grid_s / grid_.period_s));  // 0: late, and then early
  const double off_s = since_grid_s - steps * grid_.period_s;
  const double move_s = off_s / kMemory;
  MoveGrid(steps * grid_.period_s + move_s);
  steps_ += static_cast<std::int64_t>(steps);
  covered_s_ += steps * grid_.period_s + move_s;
  grid_.period_s += off_s / (4 * kMemory * kMemory);
  squares_s2_ += off_s * off_s;
  largest_s_ = std::max(largest_s_, std::abs(off_s));
  if (steps > 1) {
    if (timing.gaps.count++ == 0) timing.gaps.first = where;
    timing.missing_s += (steps - 1) * grid_.period_s;
  }
  const bool broken = std::exchange(broken_, false);
  return steps > 1 || broken ? StampVerdict::kStartsSegment : StampVerdict::kNext;
}

void StampCheck::MoveGrid(double by_s) {
  grid_s_ += by_s;
  const auto whole_ns = std::llround(grid_s_ * 1e9);
  grid_ns_ += whole_ns;
  grid_s_ -= static_cast<double>(whole_ns) * 1e-9;
}

void StampCheck::Summarise(RecordTiming& timing) const {
  timing.period_s = grid_.period_s;
  if (steps_ == 0) return;
  timing.period_s = covered_s_ / static_cast<double>(steps_);
  timing.jitter_sd_s = std::sqrt(squares_s2_ / static_cast<double>(stamps_));
  timing.jitter_max_s = largest_s_;
}

namespace {

/// Rising stamps, in seconds since the first.
std::vector<double> CollectRising_s(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<double> rising_s;
  std::int64_t last_ns = 0;
  for (const std::int64_t stamp_ns : stamps_ns) {
    if (!rising_s.empty() && stamp_ns <= last_ns) continue;
    rising_s.push_back(1e-9 * static_cast<double>(stamp_ns - stamps_ns.front()));
    last_ns = stamp_ns;
  }
  return rising_s;
}

/// The slope of the straight line through the stamps over their numbers, if all lie within half of it.
std::optional<double> FitEvenPeriod_s(const std::vector<double>& stamps_s) {
  const auto n = static_cast<double>(stamps_s.size());
  double mean_s = 0, moment_s = 0;
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    mean_s += stamps_s[i] / n;
    moment_s += stamps_s[i] * (static_cast<double>(i) - 0.5 * (n - 1));
  }
  const double period_s = 12 * moment_s / (n * (n * n - 1));
  for (std::size_t i = 0; i < stamps_s.size(); ++i) {
    const double even_s = mean_s + period_s * (static_cast<double>(i) - 0.5 * (n - 1));
    if (std::abs(stamps_s[i] - even_s) > 0.5 * period_s) return std::nullopt;
  }
  return period_s;
}

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double FindPeriod_s(const std::vector<double>& stamps_s) {
  if (const auto even_s = FitEvenPeriod_s(stamps_s)) return *even_s;
  double period_s = 0;
  for (std::size_t lag = 1; lag <= kLongestLag && 2 * lag < stamps_s.size(); lag *= 4) {
    std::vector<double> periods_s;
    for (std::size_t i = lag; i < stamps_s.size(); ++i) {
      const double span_s = stamps_s[i] - stamps_s[i - lag];
      const double steps = lag == 1 ? 1 : std::max(1.0, std::round(span_s / period_s));
      periods_s.push_back(span_s / steps);
    }
    period_s = Median(periods_s);
  }
  return period_s;
}

/// Of the first stamp, by the circular mean of the first ones.
double FindOffset_s(const std::vector<double>& stamps_s, double period_s) {
  double sine = 0, cosine = 0;
  for (std::size_t i = 0; i < std::min(stamps_s.size(), static_cast<std::size_t>(kMemory)); ++i) {
    const double angle = 2 * std::numbers::pi * (stamps_s[i] - stamps_s[0]) / period_s;
    sine += std::sin(angle);
    cosine += std::cos(angle);
  }
  return -period_s * std::atan2(sine, cosine) / (2 * std::numbers::pi);
}

}  // namespace

StampGrid FindStampGrid(const std::vector<std::int64_t>& stamps_ns) {
  const std::vector<double> stamps_s = CollectRising_s(stamps_ns);
  if (stamps_s.size() < 2) return {};
  const double period_s = FindPeriod_s(stamps_s);
  return {period_s, FindOffset_s(stamps_s, period_s)};
}

}  // namespace piperun::scenarios
