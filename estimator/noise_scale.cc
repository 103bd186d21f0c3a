#include "estimator/noise_scale.h"

#include <algorithm>
#include <cmath>

namespace piperun::estimator {

NoiseScale::NoiseScale(std::int64_t bins, std::int64_t least)
    : least_(least), ring_(static_cast<std::size_t>(bins)) {
  sorted_.reserve(ring_.size());
}

void NoiseScale::Add(std::int64_t bin, double z) {
  if (!first_) first_ = bin;
  ring_[Slot(bin)] = std::abs(z);
  last_ = bin;
}

double NoiseScale::Before(std::int64_t bin) {
  if (!first_) return 1;
  const auto n = static_cast<std::int64_t>(ring_.size());
  sorted_.clear();
  for (std::int64_t i = std::max(*first_, last_ - n + 1); i < std::min(bin, last_ + 1); ++i)
    sorted_.push_back(ring_[Slot(i)]);
  if (static_cast<std::int64_t>(sorted_.size()) < least_) return 1;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return std::max(1.0, 1.4826 * *middle);
}

}  // namespace piperun::estimator
