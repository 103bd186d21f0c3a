#include "estimator/allan_covariance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace piperun::estimator {
namespace {

constexpr std::int64_t kTailClusters = 50;
constexpr std::int64_t kLagByLag = 24;
constexpr std::int64_t kGrowth = 4;
// Gauss-Legendre, eight points (Abramowitz & Stegun, table 25.4).
constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                      0.9602898564975363};
constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                        0.1012285362903763};

/// Mean length of a group's segments, and what two clusters leave of them.
struct Overlap {
  double segments = 0;
  double first = 0;   ///< M1 of a segment
  double second = 0;  ///< M2
};

std::vector<Overlap> FindOverlaps(std::span<const SegmentGroup> groups, std::int64_t m1, std::int64_t m2) {
  std::vector<Overlap> overlaps;
  for (const SegmentGroup& group : groups) {
    const double length = static_cast<double>(group.samples) / static_cast<double>(group.segments);
    const Overlap o{static_cast<double>(group.segments), length + 1 - 2 * static_cast<double>(m1),
                    length + 1 - 2 * static_cast<double>(m2)};
    if (o.first > 0 && o.second > 0) overlaps.push_back(o);
  }
  return overlaps;
}

/// Pairs (i, i + k) with 0 <= i < M1, 0 <= i + k < M2.
double CountPairs(std::span<const Overlap> overlaps, double k) {
  double pairs = 0;
  for (const Overlap& o : overlaps) {
    pairs += o.segments * std::max(0.0, std::min(o.first, o.second - k) - std::max(0.0, -k));
  }
  return pairs;
}

/// The summand over lags, and how it is summed over the whole numbers of an interval.
class LagSum {
 public:
  LagSum(const NoiseModel& model, std::span<const Overlap> overlaps, std::int64_t m1, std::int64_t m2)
      : covariance_(model, m1, m2),
        overlaps_(overlaps),
        m1_(m1),
        m2_(m2),
        means_(4 * CalcDifferenceMean(model, m1) * CalcDifferenceMean(model, m2)) {}

  double Eval(double k) const {
    const double R = covariance_.Eval(k);
    return CountPairs(overlaps_, k) * (2 * R + means_) * R;
  }

  /// Over first .. last, both included; few by themselves, many as an integral from first - 1/2 to last +
  /// 1/2.
  double AddPanel(std::int64_t first, std::int64_t last) const {
    double sum = 0;
    if (last - first < kLagByLag) {
      for (std::int64_t k = first; k <= last; ++k) sum += Eval(static_cast<double>(k));
      return sum;
    }
    const double middle = 0.5 * static_cast<double>(first + last);
    const double half = 0.5 * static_cast<double>(last - first + 1);
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      sum += kWeight[i] * (Eval(middle - half * kNode[i]) + Eval(middle + half * kNode[i]));
    }
    return half * sum;
  }

  /// Over first .. last, between kinks: panels that grow away from either end.
  double AddInterval(std::int64_t first, std::int64_t last) const {
    double sum = 0;
    for (std::int64_t size = std::max(kLagByLag, std::min(m1_, m2_) / 2); first <= last; size *= kGrowth) {
      const std::int64_t left = std::min(first + size - 1, last);
      sum += AddPanel(first, left);
      first = left + 1;
      const std::int64_t right = std::max(last - size + 1, first);
      if (right <= last) sum += AddPanel(right, last);
      last = right - 1;
    }
    return sum;
  }

 private:
  DifferenceCovariance covariance_;
  std::span<const Overlap> overlaps_;
  std::int64_t m1_, m2_;
  double means_;
};

/// The lags where R has a kink: an end of one window meets an end of the other.
std::vector<std::int64_t> FindKinks(std::int64_t m1, std::int64_t m2, std::int64_t low, std::int64_t high) {
  std::vector<std::int64_t> kinks;
  for (std::int64_t a = 0; a < 3; ++a) {
    for (std::int64_t b = 0; b < 3; ++b) {
      const std::int64_t k = a * m1 - b * m2;
      if (k >= low && k <= high) kinks.push_back(k);
    }
  }
  std::sort(kinks.begin(), kinks.end());
  kinks.erase(std::unique(kinks.begin(), kinks.end()), kinks.end());
  return kinks;
}

double SumOverLags(const LagSum& lags, std::int64_t m1, std::int64_t m2, const Overlap& longest) {
  const std::int64_t tail = kTailClusters * std::max(m1, m2);
  const std::int64_t low = std::max(-2 * m2 - tail, 1 - static_cast<std::int64_t>(longest.first));
  const std::int64_t high = std::min(2 * m1 + tail, static_cast<std::int64_t>(longest.second) - 1);
  double sum = 0;
  std::int64_t next = low;
  for (const std::int64_t kink : FindKinks(m1, m2, low, high)) {
    sum += lags.AddInterval(next, kink - 1) + lags.AddPanel(kink, kink);
    next = kink + 1;
  }
  return sum + lags.AddInterval(next, high);
}

}  // namespace

double CalcAllanCovariance(const NoiseModel& model, std::span<const SegmentGroup> segments,
                           const AllanCluster& first, const AllanCluster& second) {
  const std::int64_t m1 = first.samples, m2 = second.samples;
  const std::vector<Overlap> overlaps = FindOverlaps(segments, m1, m2);
  if (overlaps.empty()) return 0;
  double M1 = 0, M2 = 0;
  for (const Overlap& o : FindOverlaps(segments, m1, m1)) M1 += o.segments * o.first;
  for (const Overlap& o : FindOverlaps(segments, m2, m2)) M2 += o.segments * o.second;
  const double product = static_cast<double>(m1) * static_cast<double>(m2);
  const double sum = SumOverLags(LagSum(model, overlaps, m1, m2), m1, m2, overlaps.front());
  return sum / (4 * product * product * M1 * M2);
}

double CalcDegreesOfFreedom(const NoiseModel& model, std::span<const SegmentGroup> segments,
                            const AllanCluster& cluster) {
  const double mean = CalcAllanVariance(model, cluster.samples);
  const double variance = CalcAllanCovariance(model, segments, cluster, cluster);
  return variance > 0 ? 2 * mean * mean / variance : std::numeric_limits<double>::infinity();
}

}  // namespace piperun::estimator
