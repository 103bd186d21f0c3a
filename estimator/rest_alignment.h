#pragma once

#include <optional>

#include "base/pose.h"

namespace piperun::estimator {

/// Decides whether a sensor rested during the first `duration_s` of its record, and if so gives the mean gyro
/// reading, which is then its bias. It rested when no reading lay further than 6 sigma from the mean so far,
/// when the two halves' means agree within 4 sigma, and when the mean is a credible bias (below 5 sigma).
/// What is integrated in the meantime is not lost: the filter runs from the first sample.
class RestAlignment {
 public:
  RestAlignment(double duration_s, double gyro_noise_rad_s_sqrtHz, double gyro_bias_sd_rad_s);

  struct Result {
    bool rested = false;
    Vector3d w_S_rad_s = Vector3d::Zero();
    double duration_s = 0;
  };
  /// The result, once: at the sample that completes the duration.
  std::optional<Result> Step(const Vector3d& w_S_rad_s, double dt_s);

 private:
  struct Mean {
    Vector3d angle_rad = Vector3d::Zero();
    double duration_s = 0;
    Vector3d Rate() const { return angle_rad / duration_s; }
  };
  bool Rested() const;

  double duration_s_, noise_, bias_sd_;
  Mean halves_[2];
  bool steady_ = true;
  bool done_ = false;
};

}  // namespace piperun::estimator
