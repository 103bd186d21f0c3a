#pragma once

#include "base/pose.h"

namespace piperun::sim {

/// The sensor's own strapdown algorithm: sums its internal samples to one step of v += R dv + g T; R = R
/// Exp(dtheta), in the axes of the interval's begin.
///
/// Internal sample j, one per physics step, with rate w_j and mean specific force f_j over dt, theta = w dt,
/// nu = f dt:
///   R <- R Exp(theta_j)
///   dv_j = nu_j + theta_j x nu_j / 2 + theta_j x (theta_j x nu_j) / 6
///          + (theta_{j-1} x nu_j + nu_{j-1} x theta_j) / 12                                (sculling)
/// The truth turns at a constant rate within a step, so no coning is left between internal samples; the
/// sculling term tells a force fixed in space from one fixed in the body. P. Savage, "Strapdown inertial
/// navigation integration algorithm design", J. Guid. Control Dyn. 21 (1998), part 2.
class StrapdownSum {
 public:
  /// Takes the next internal sample.
  void Next(const Vector3d& theta_rad, const Vector3d& nu_m_s);
  /// Starts an interval.
  void Begin();
  /// Adds a part (0 to 1) of the last internal sample to the interval.
  void Add(double part);
  Vector3d dtheta_rad() const { return LogSO3(q_begin_end_); }
  const Vector3d& dv_m_s() const { return dv_; }

 private:
  Vector3d theta_ = Vector3d::Zero();
  Vector3d nu_ = Vector3d::Zero();
  Vector3d sculled_ = Vector3d::Zero();
  bool started_ = false;
  Quaterniond q_begin_end_ = Quaterniond::Identity();
  Vector3d dv_ = Vector3d::Zero();
};

}  // namespace piperun::sim
