#pragma once

#include "base/params.h"
#include "base/pose.h"

namespace piperun::estimator {

struct MahonyParams {
  double kp_rad_s = 0.74;
  double ki_rad_s2 = 0.0012;

  void Visit(ParamVisitor& v);
};

/// Explicit complementary filter of Mahony, Hamel & Pflimlin (IEEE Trans. Automatic Control 53, 1203, 2008,
/// eq. 48), in the form that S. Madgwick's C code made common:
///
///     e = a x R^T up [ + m x R^T b ],    B' = -ki e,    q' = 1/2 q (0, w - B + kp e)
///
/// a and m the directions of specific force and field, R the matrix of q, which turns S into the frame M
/// whose x axis lies under the field; b = (sqrt(h_x^2 + h_y^2), 0, h_z), h = R m. B is the gyro's bias.
/// Euler's step, then normalised, as published. The defaults are those that did best over all of the BROAD
/// data sets (Laidig et al., Data 6, 72, 2021). A vector of zero length is left out. Rates in rad/s; f and m
/// in any unit. Range: dt of one sample, |w| dt < 0.3 rad.
class Mahony {
 public:
  explicit Mahony(const MahonyParams& params) : params_(params) {}

  /// Gyro and accelerometer.
  void Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, double dt_s);
  /// With the magnetometer.
  void Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, const Vector3d& m_S, double dt_s);

  const Quaterniond& q_MS() const { return q_MS_; }
  void Set(const Quaterniond& q_MS) { q_MS_ = q_MS; }
  const Vector3d& bias_S_rad_s() const { return bias_S_rad_s_; }

 private:
  void Turn(const Vector3d& w_S_rad_s, const Vector3d& error, double dt_s);

  MahonyParams params_;
  Quaterniond q_MS_ = Quaterniond::Identity();
  Vector3d bias_S_rad_s_ = Vector3d::Zero();
};

}  // namespace piperun::estimator
