#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace piperun::estimator {

/// Hampel's filter: lets a value through, `kHalf` values late, unless it lies further from the median of its
/// 2 kHalf + 1 neighbours than `limit` times 1.4826 times their median absolute deviation, or than `floor`
/// where that is smaller. A joint's impact, one to three frames long, is dropped; a leak, seconds long,
/// passes. The first and last kHalf values have no neighbours to be judged by and are left out.
template <class T>
class ImpactGate {
 public:
  static constexpr std::size_t kHalf = 3;
  static constexpr std::size_t kLength = 2 * kHalf + 1;

  ImpactGate(double limit, double floor) : limit_(limit), floor_(floor) {}

  std::optional<T> Step(const T& item, double value) {
    items_[next_ % kLength] = item;
    values_[next_ % kLength] = value;
    if (++next_ < kLength) return std::nullopt;
    const std::size_t middle = (next_ - 1 - kHalf) % kLength;
    const double median = Median(values_);
    std::array<double, kLength> deviations;
    for (std::size_t i = 0; i < kLength; ++i) deviations[i] = std::abs(values_[i] - median);
    const double allowed = std::max(floor_, limit_ * 1.4826 * Median(deviations));
    if (std::abs(values_[middle] - median) > allowed) return std::nullopt;
    return items_[middle];
  }

 private:
  static double Median(std::array<double, kLength> v) {
    std::nth_element(v.begin(), v.begin() + kHalf, v.end());
    return v[kHalf];
  }

  double limit_, floor_;
  std::array<T, kLength> items_{};
  std::array<double, kLength> values_{};
  std::size_t next_ = 0;
};

}  // namespace piperun::estimator
