#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace piperun::estimator {

/// How much a statistic scatters in quiet pipe: its standard deviation over a long stretch, from the median
/// of its absolute values below three standard deviations (0.6724 for a standard normal), iterated from an
/// expected one. What leaks stand out by does not count, even where they are many: from below, the iteration
/// stops at the smallest scatter that explains itself. Memory is fixed: the last `bins` values.
class NoiseScale {
 public:
  /// `least`: values below which nothing is said.
  NoiseScale(std::int64_t bins, std::int64_t least);
  /// Bins come in rising order; those left out in between do not count.
  void Add(std::int64_t bin, double z);
  /// Leaves out the bins from first up to, not including, last: a leak was heard there.
  void Forget(std::int64_t first, std::int64_t last);
  /// From the bins from first up to, not including, last; nothing when they are too few.
  std::optional<double> Calc(std::int64_t first, std::int64_t last, double expected = 1);

 private:
  static constexpr double kLeftOut = -1;
  std::size_t Slot(std::int64_t bin) const {
    const auto n = static_cast<std::int64_t>(ring_.size());
    return static_cast<std::size_t>(((bin % n) + n) % n);
  }

  std::int64_t least_;
  std::vector<double> ring_;    // |z|, or kLeftOut
  std::vector<double> sorted_;  // scratch
  std::int64_t first_ = 0, end_ = 0;
};

}  // namespace piperun::estimator
