#include "estimator/allan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"

namespace piperun::estimator {
namespace {

constexpr std::int64_t kFewestStrides = 256;
constexpr std::int64_t kLongestCluster = std::int64_t{1} << 40;
constexpr std::size_t kBlock = 8192;

std::int64_t CalcStride(std::int64_t samples, std::int64_t full_overlap) {
  if (samples <= full_overlap || samples < 2 * kFewestStrides) return 1;
  return static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint64_t>(samples / kFewestStrides)));
}

/// Sum of (late - 2 middle + early)^2 over n entries. Four sums, so that additions do not wait for each
/// other.
double SumSquaredDifferences(const double* late, const double* middle, const double* early, std::size_t n) {
  double sum[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double d = (late[i + j] - middle[i + j]) - (middle[i + j] - early[i + j]);
      sum[j] += d * d;
    }
  }
  for (; i < n; ++i) {
    const double d = (late[i] - middle[i]) - (middle[i] - early[i]);
    sum[0] += d * d;
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

constexpr int kBinsPerOctaveBits = 5;
constexpr double kLeastTold = 0.8;  ///< of a point's differences, by the groups of segments

/// Lengths below 64 by themselves, longer ones 32 to the octave.
std::size_t FindBin(std::int64_t samples) {
  const auto n = static_cast<std::uint64_t>(samples);
  const int excess = std::max(0, static_cast<int>(std::bit_width(n)) - kBinsPerOctaveBits - 1);
  return (static_cast<std::size_t>(excess) << kBinsPerOctaveBits) + static_cast<std::size_t>(n >> excess);
}

void AddSegment(std::vector<SegmentGroup>& groups, std::int64_t samples) {
  if (samples == 0) return;
  const std::size_t bin = FindBin(samples);
  if (groups.size() <= bin) groups.resize(bin + 1);
  SegmentGroup& group = groups[bin];
  ++group.segments;
  group.samples += samples;
}

}  // namespace

/// Clusters that share a stride, and the part of theta they still need, one entry per stride.
class AllanAccumulator::Level {
 public:
  explicit Level(std::int64_t stride) : stride_(stride) {}

  void Add(const AllanCluster& cluster) {
    sums_.push_back({cluster, static_cast<std::size_t>(cluster.samples / stride_)});
    reach_ = 2 * sums_.back().lag;
  }
  void Reset() {
    window_.clear();
    next_ = 0;
  }

  /// Entries theta_begin, theta_(begin+1) .. of the segment.
  void Append(std::int64_t begin, std::span<const double> theta) {
    const std::int64_t end = begin + static_cast<std::int64_t>(theta.size());
    if (next_ >= end) return;
    const std::size_t fresh = MakeRoom(static_cast<std::size_t>((end - next_ + stride_ - 1) / stride_));
    for (; next_ < end; next_ += stride_) window_.push_back(theta[static_cast<std::size_t>(next_ - begin)]);
    for (Sum& sum : sums_) AddDifferences(sum, fresh);
  }

  void AppendPoints(std::vector<AllanPoint>& points) const {
    for (const Sum& sum : sums_) {
      if (sum.count == 0) continue;
      const double m = static_cast<double>(sum.cluster.samples);
      points.push_back({sum.cluster, sum.count, sum.squares / (2 * static_cast<double>(sum.count) * m * m)});
    }
  }

 private:
  struct Sum {
    AllanCluster cluster;
    std::size_t lag;  ///< of one cluster, in entries
    double squares = 0;
    std::int64_t count = 0;
  };

  /// Drops what no cluster reaches any more; returns the place of the next entry in the window.
  std::size_t MakeRoom(std::size_t entries) {
    const std::size_t limit = reach_ + reach_ / 4 + kBlock;
    if (window_.size() + entries > limit) {
      window_.erase(window_.begin(), window_.end() - static_cast<std::ptrdiff_t>(reach_));
    }
    if (window_.size() + entries > window_.capacity()) {
      window_.reserve(std::min(limit, 2 * (window_.size() + entries)));
    }
    return window_.size();
  }

  void AddDifferences(Sum& sum, std::size_t fresh) const {
    const std::size_t begin = std::max(fresh, 2 * sum.lag);
    if (begin >= window_.size()) return;
    const double* late = window_.data() + begin;
    const std::size_t n = window_.size() - begin;
    sum.squares += SumSquaredDifferences(late, late - sum.lag, late - 2 * sum.lag, n);
    sum.count += static_cast<std::int64_t>(n);
  }

  std::int64_t stride_;
  std::size_t reach_ = 0;
  std::int64_t next_ = 0;
  std::vector<Sum> sums_;
  std::vector<double> window_;
};

std::vector<AllanCluster> MakeAllanClusters(const AllanGrid& grid, std::int64_t longest) {
  Demand(grid.clusters_per_decade > 0 && grid.full_overlap > 0, "an Allan grid has clusters");
  std::vector<AllanCluster> clusters;
  for (int i = 0;; ++i) {
    const double length = std::pow(10.0, static_cast<double>(i) / grid.clusters_per_decade);
    if (length > static_cast<double>(longest) + 1) break;
    AllanCluster cluster{std::llround(length), 1};
    cluster.stride = CalcStride(cluster.samples, grid.full_overlap);
    cluster.samples = (cluster.samples + cluster.stride / 2) / cluster.stride * cluster.stride;
    const bool is_new = clusters.empty() || clusters.back().samples < cluster.samples;
    if (is_new && cluster.samples <= longest) clusters.push_back(cluster);
  }
  return clusters;
}

AllanAccumulator::AllanAccumulator(const AllanGrid& grid) {
  std::int64_t stride = 0;
  for (const AllanCluster& cluster : MakeAllanClusters(grid, kLongestCluster)) {
    if (cluster.stride != stride) levels_.emplace_back(stride = cluster.stride);
    levels_.back().Add(cluster);
  }
  theta_.reserve(kBlock);
}
AllanAccumulator::~AllanAccumulator() = default;
AllanAccumulator::AllanAccumulator(AllanAccumulator&&) noexcept = default;

void AllanAccumulator::Append(std::span<const double> rate) {
  while (!rate.empty()) {
    const auto block = rate.first(std::min(rate.size(), kBlock - 1));
    AppendBlock(block);
    rate = rate.subspan(block.size());
  }
}

void AllanAccumulator::AppendBlock(std::span<const double> rate) {
  if (samples_ == 0) reference_ = rate.front();
  theta_.clear();
  const std::int64_t begin = segment_samples_ == 0 ? 0 : segment_samples_ + 1;
  if (begin == 0) theta_.push_back(theta_last_ = 0);
  for (const double y : rate) theta_.push_back(theta_last_ += y - reference_);
  for (Level& level : levels_) level.Append(begin, theta_);
  samples_ += static_cast<std::int64_t>(rate.size());
  segment_samples_ += static_cast<std::int64_t>(rate.size());
}

void AllanAccumulator::StartSegment() {
  AddSegment(finished_, segment_samples_);
  segment_samples_ = 0;
  for (Level& level : levels_) level.Reset();
}

std::vector<AllanPoint> AllanAccumulator::Points() const {
  std::vector<AllanPoint> points;
  for (const Level& level : levels_) level.AppendPoints(points);
  const std::vector<SegmentGroup> segments = Segments();
  std::erase_if(points, [&](const AllanPoint& point) {
    return CountDifferences(segments, point.cluster.samples) < kLeastTold * static_cast<double>(point.count);
  });
  return points;
}

std::vector<SegmentGroup> AllanAccumulator::Segments() const {
  std::vector<SegmentGroup> groups = finished_;
  AddSegment(groups, segment_samples_);
  std::erase_if(groups, [](const SegmentGroup& group) { return group.segments == 0; });
  std::reverse(groups.begin(), groups.end());
  return groups;
}

double CountDifferences(std::span<const SegmentGroup> segments, std::int64_t cluster_samples) {
  double differences = 0;
  for (const SegmentGroup& group : segments) {
    const double all = static_cast<double>(group.samples);
    const double each = static_cast<double>(group.segments) * static_cast<double>(1 - 2 * cluster_samples);
    differences += std::max(0.0, all + each);
  }
  return differences;
}

std::vector<AllanPoint> CalcAllanVariance(std::span<const double> rate, const AllanGrid& grid) {
  AllanAccumulator accumulator(grid);
  accumulator.Append(rate);
  return accumulator.Points();
}

}  // namespace piperun::estimator
