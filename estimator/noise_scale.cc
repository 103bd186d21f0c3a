#include "estimator/noise_scale.h"

#include <algorithm>
#include <cmath>

namespace piperun::estimator {
namespace {

constexpr double kClip = 3;
constexpr double kClippedMedian = 0.6724;
constexpr int kIterations = 20;
constexpr std::ptrdiff_t kLeastKept = 4;

}  // namespace

NoiseScale::NoiseScale(std::int64_t bins, std::int64_t least)
    : least_(least), ring_(static_cast<std::size_t>(bins), kLeftOut) {
  sorted_.reserve(ring_.size());
}

void NoiseScale::Add(std::int64_t bin, double z) {
  const auto n = static_cast<std::int64_t>(ring_.size());
  if (end_ == first_) first_ = end_ = bin;
  for (std::int64_t i = std::max(end_, bin - n); i < bin; ++i) ring_[Slot(i)] = kLeftOut;
  ring_[Slot(bin)] = std::abs(z);
  end_ = bin + 1;
  first_ = std::max(first_, end_ - n);
}

void NoiseScale::Forget(std::int64_t first, std::int64_t last) {
  for (std::int64_t i = std::max(first, first_); i < std::min(last, end_); ++i) ring_[Slot(i)] = kLeftOut;
}

std::optional<double> NoiseScale::Calc(std::int64_t first, std::int64_t last, double expected) {
  sorted_.clear();
  for (std::int64_t i = std::max(first, first_); i < std::min(last, end_); ++i) {
    const double z = ring_[Slot(i)];
    if (z != kLeftOut) sorted_.push_back(z);
  }
  if (static_cast<std::int64_t>(sorted_.size()) < least_) return std::nullopt;
  const auto rank = [this](std::ptrdiff_t k) {
    std::nth_element(sorted_.begin(), sorted_.begin() + k, sorted_.end());
    return sorted_[static_cast<std::size_t>(k)];
  };
  double scale = expected;
  for (int i = 0; i < kIterations; ++i) {
    const auto kept =
        std::count_if(sorted_.begin(), sorted_.end(), [&](double z) { return z <= kClip * scale; });
    if (kept < kLeastKept) return std::nullopt;
    const double before = scale;
    scale = rank(static_cast<std::ptrdiff_t>(kept / 2)) / kClippedMedian;
    if (scale == before) break;
  }
  return scale;
}

}  // namespace piperun::estimator
