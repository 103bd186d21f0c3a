#pragma once

#include <optional>

#include "base/params.h"
#include "estimator/imu_step.h"
#include "estimator/mean_low_pass.h"

namespace piperun::estimator {

/// Time constant of the low pass of the specific force in I, and of what is compared with it.
constexpr double kVqfInclination_s = 3;

struct VqfBiasParams {
  double start_sd_rad_s = 8.7e-3;
  double limit_rad_s = 3.5e-2;
  double forgetting_s = 100;
  double motion_sd_rad_s = 1.7e-3;
  double vertical_factor = 1e-4;
  double rest_sd_rad_s = 5.2e-4;
  double rest_s = 1.5;
  double rest_filter_s = 0.5;
  double rest_rate_rad_s = 3.5e-2;
  double rest_acceleration_m_s2 = 0.5;

  void Visit(ParamVisitor& v);
};

/// Tells rest: gyro and accelerometer have lain within a distance of their own low-passed readings, and the
/// gyro's below any credible bias, for some time.
class VqfRest {
 public:
  explicit VqfRest(const VqfBiasParams& params)
      : params_(params), w_S_(params.rest_filter_s), f_S_(params.rest_filter_s) {}

  void Step(const ImuStep& step);
  bool at_rest() const { return still_s_ >= params_.rest_s; }
  /// Low-passed gyro reading.
  const Vector3d& w_S_rad_s() const { return w_S_.value(); }

 private:
  VqfBiasParams params_;
  MeanLowPass<3> w_S_, f_S_;
  double still_s_ = 0;
};

/// Kalman filter of the gyro bias of VQF (D. Laidig & T. Seel, "VQF: highly accurate IMU orientation
/// estimation with bias estimation and magnetic disturbance rejection", Information Fusion 91, 187, 2023,
/// section 3.5).
///
/// State b, a random walk of variance v dt, v = sd_v^2 / t_forget with sd_v = 0.1 deg/s, never above its
/// start. In motion the rate at which the inclination had to be corrected, (a_y, -a_x)/dt for the low-passed
/// specific force a in E, is minus what a wrong bias makes the low-passed force drift, C the low-passed R_ES:
///
///     e = [-a_y/dt + LP(R b)_x - (C b)_x,  a_x/dt + LP(R b)_y - (C b)_y,  -(C b)_z]
///     K = P C^T (W + C P C^T)^-1,   b <- b + K e,   P <- P - K C P
///
/// at rest C = I and e is the low-passed gyro reading less b. W = p^2/(v dt) + p lets P settle at p = sd^2 of
/// motion or rest; the vertical number only pulls an unobservable bias to zero, with a W larger by
/// 1/vertical_factor. e and b are held within the limit, as published: an innovation beyond it is an outlier.
class VqfBias {
 public:
  explicit VqfBias(const VqfBiasParams& params);

  /// `a_E` the normalised low-passed specific force before its correction, `R_ES` the attitude after it,
  /// `rest_w_S_rad_s` the low-passed gyro reading if the sensor rests.
  void Step(const Vector3d& a_E, const Matrix3d& R_ES, const std::optional<Vector3d>& rest_w_S_rad_s,
            double dt_s);
  /// The bias has been measured, each axis with this variance.
  void Measure(const Vector3d& bias_rad_s, double variance);

  const Vector3d& bias_S_rad_s() const { return b_; }
  const Matrix3d& covariance() const { return P_; }

 private:
  void StepInMotion(const Vector3d& a_E, double dt_s);
  void Grow(double dt_s);
  /// C and LP(R b), low-passed.
  void Filter(const Matrix3d& R_ES, double dt_s);
  double CalcWeight(double sd_rad_s, double dt_s) const;
  void Update(Vector3d e, const Matrix3d& C, const Vector3d& W);

  VqfBiasParams params_;
  double walk_rad2_s3_;
  MeanLowPass<11> low_pass_;
  Vector3d b_ = Vector3d::Zero();
  Matrix3d P_;
};

}  // namespace piperun::estimator
