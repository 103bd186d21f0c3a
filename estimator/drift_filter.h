#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/roof_fit.h"

namespace piperun::estimator {

/// What the level of two bands does along a pipe without leaks, as a detector assumes it. Drift has the
/// covariance of Matern 3/2, sd^2 (1 + u) exp(-u), u = sqrt(3) |x| / length: continuous with a slope, rougher
/// than any polynomial. A leak's roof has an edge on top that no such drift has.
struct LevelModel {
  double common_drift_dB = 2;  ///< standard deviation, both bands alike
  double own_drift_dB = 0.7;   ///< standard deviation, each band for itself
  double drift_length_m = 20;
  double band_scatter_dB = 0.5;       ///< of one frame: statistics of noise
  double reference_scatter_dB = 1.1;  ///< the same of the reference band
};

/// Generalised least squares for a roof on drifting levels: with the levels of both bands y in a window of
/// bins, their covariance C under LevelModel, and constant and trend of each band as nuisances H,
///
///     z = m^T P C^-1 y / sqrt(m^T P C^-1 m)        P: projection off H in the metric of C^-1
///
/// which is standard normal without a leak when the model holds, and the most powerful linear statistic for
/// the roof m in the first band (Kay, Fundamentals of Statistical Signal Processing II, 4.4). Bins are
/// equally wide, so z is a fixed weighted sum of levels. The reference band serves to foretell the common
/// drift; the filter itself finds how far to average it.
class DriftFilter {
 public:
  /// Which bins of a window of 2 half + 1 around x0 have been heard: `behind` before and `ahead` after it.
  struct Window {
    std::int64_t half = 0, behind = 0, ahead = 0;
    double bin_m = 0;
    double frames_per_bin = 1;  ///< divides the scatter's variance
  };
  DriftFilter(const LevelModel& model, const std::vector<Roof>& roofs, const Window& window);

  struct Response {
    double z = 0;
    double amplitude = 0;  ///< A, of A m(x - x0)
  };
  /// Levels: the 2 half + 1 bins of the band, then those of the reference; what was not heard counts nothing.
  Response Eval(std::size_t roof, const Eigen::VectorXd& levels_dB) const {
    const double z = weights_.col(static_cast<Eigen::Index>(roof)).dot(levels_dB);
    return {z, z * unit_amplitude_[roof]};
  }

 private:
  Eigen::MatrixXd weights_;  // one column per roof
  std::vector<double> unit_amplitude_;
};

}  // namespace piperun::estimator
