#pragma once

#include "base/params.h"
#include "base/pose.h"

namespace piperun::estimator {

struct MadgwickParams {
  double beta_rad_s = 0.08;
  bool published = false;

  void Visit(ParamVisitor& v);
};

/// Gradient-descent orientation filter of Madgwick, Harrison & Vaidyanathan (IEEE Int. Conf. Rehabilitation
/// Robotics, 2011; S. Madgwick's report of 2010, eqs 12, 21, 22 and 33 to 45).
///
///     q' = 1/2 q (0, w) - beta grad F / |grad F|,     F(q) = |R^T up - f/|f||^2 / 2 [ + |R^T b - m/|m||^2 /
///     2 ]
///
/// q turns S into the frame M whose x axis lies under the field, R its matrix; b = (sqrt(h_x^2 + h_y^2), 0,
/// h_z) with h = R m/|m|, so that the field's dip needs not be known. beta is the rate at which accelerometer
/// and magnetometer may turn the attitude. Euler's step, then normalised, as published; it loses (w dt)^3/12
/// per step. Two slips of the C code that everybody copies are corrected: it halves b, so that field and
/// gravity fight each other; and at the optimum, where the gradient is zero, it divides by zero. `published`
/// brings the first one back, for comparison. A vector of zero length is left out. Rates in rad/s; f and m in
/// any unit. Range: dt of one sample, |w| dt < 0.3 rad.
class Madgwick {
 public:
  explicit Madgwick(const MadgwickParams& params) : params_(params) {}

  /// Gyro and accelerometer.
  void Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, double dt_s);
  /// With the magnetometer.
  void Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, const Vector3d& m_S, double dt_s);

  const Quaterniond& q_MS() const { return q_MS_; }
  void Set(const Quaterniond& q_MS) { q_MS_ = q_MS; }

 private:
  void Descend(const Vector3d& w_S_rad_s, const Eigen::Vector4d& gradient, double dt_s);

  MadgwickParams params_;
  Quaterniond q_MS_ = Quaterniond::Identity();
};

}  // namespace piperun::estimator
