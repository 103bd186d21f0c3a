#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace piperun::estimator {

/// How much a statistic that should be standard normal in quiet pipe really scatters there: the median of its
/// absolute values over a long stretch, times 1.4826, and never below 1. Memory is fixed: the last
/// `bins` values.
class NoiseScale {
 public:
  NoiseScale(std::int64_t bins, std::int64_t least);
  /// Bins come in rising order.
  void Add(std::int64_t bin, double z);
  /// From what was heard before `bin`; 1 while that is fewer than `least` values.
  double Before(std::int64_t bin);

 private:
  std::size_t Slot(std::int64_t bin) const {
    const auto n = static_cast<std::int64_t>(ring_.size());
    return static_cast<std::size_t>(((bin % n) + n) % n);
  }

  std::int64_t least_;
  std::vector<double> ring_;    // |z|
  std::vector<double> sorted_;  // scratch
  std::optional<std::int64_t> first_;
  std::int64_t last_ = 0;
};

}  // namespace piperun::estimator
