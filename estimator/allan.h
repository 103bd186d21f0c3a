#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace piperun::estimator {

/// How finely the cluster lengths are spaced and up to which one every overlap is used.
struct AllanGrid {
  int clusters_per_decade = 18;  ///< 93 lengths for 882,472 samples
  /// Longest cluster whose second differences are taken at every sample: 2^19 = 524,288. Longer ones are
  /// taken every 2^k samples with 256 to 511 strides to a cluster.
  std::int64_t full_overlap = std::int64_t{1} << 19;
};

struct AllanCluster {
  std::int64_t samples = 1;  ///< m; the averaging time is tau = m dt
  std::int64_t stride = 1;   ///< samples between second differences
};

/// Cluster lengths round(10^(i / clusters_per_decade)), each once, up to `longest` samples; those beyond
/// full_overlap rounded to whole strides.
std::vector<AllanCluster> MakeAllanClusters(const AllanGrid& grid, std::int64_t longest);

/// Stretches of a record between gaps, of about one length: equal below 64 samples, within 3 % above.
struct SegmentGroup {
  std::int64_t segments = 0;
  std::int64_t samples = 0;  ///< of all of them together
};

/// Second differences at every sample in segments of their group's mean length.
double CountDifferences(std::span<const SegmentGroup> segments, std::int64_t cluster_samples);

/// One point of an Allan variance.
struct AllanPoint {
  AllanCluster cluster;
  std::int64_t count = 0;  ///< second differences averaged
  double variance = 0;     ///< u^2
};

/// Overlapping Allan variance of one channel, streamed: of rates y_k that are means over the sampling
/// interval dt, with theta_j = y_0 + .. + y_(j-1),
///
///   avar(m) = 1 / (2 m^2 M) sum_{j = 0}^{M - 1} (theta_(j+2m) - 2 theta_(j+m) + theta_j)^2,   M = n - 2 m +
///   1
///
/// (IEEE Std 952-1997, annex C; NIST SP 1065, equation 11). Where a record has gaps, no difference reaches
/// over one: sums and counts M of the segments are added. Memory: 10.5 MB for a record of any length (2.5
/// full_overlap doubles), less for a shorter one. Beyond full_overlap differences overlap by 255/256 or more,
/// which costs less than 1e-4 of the degrees of freedom (tests/estimator/allan_test.cc).
class AllanAccumulator {
 public:
  explicit AllanAccumulator(const AllanGrid& grid = {});
  ~AllanAccumulator();
  AllanAccumulator(AllanAccumulator&&) noexcept;

  /// The next samples of the channel, in its unit u.
  void Append(std::span<const double> rate);
  /// The next sample does not follow the last one.
  void StartSegment();

  /// The clusters of which there are second differences; but not those that only the longest of a group's
  /// segments hold, as the groups do not tell what those are worth.
  std::vector<AllanPoint> Points() const;
  /// By falling length; a record without gaps is one group.
  std::vector<SegmentGroup> Segments() const;
  std::int64_t samples() const { return samples_; }

 private:
  class Level;
  void AppendBlock(std::span<const double> rate);

  std::vector<Level> levels_;
  std::vector<double> theta_;
  double theta_last_ = 0;
  double reference_ = 0;  ///< the record's first sample, taken off all: keeps theta small
  std::int64_t samples_ = 0;
  std::int64_t segment_samples_ = 0;
  std::vector<SegmentGroup> finished_;  ///< by length
};

/// The Allan variance of a record without gaps that is in memory.
std::vector<AllanPoint> CalcAllanVariance(std::span<const double> rate, const AllanGrid& grid = {});

}  // namespace piperun::estimator
