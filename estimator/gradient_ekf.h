#pragma once

#include "base/params.h"
#include "base/pose.h"

namespace piperun::estimator {

struct GradientEkfParams {
  double gyro_noise_rad_s_sqrtHz = 0.01;
  double observation_sd = 0.1;
  double alpha = 1.5;
  bool printed = false;

  void Visit(ParamVisitor& v);
};

/// Quaternion Kalman filter whose observation is a step of gradient descent (Akkaya's thesis, 2017, eqs 5.12
/// to 5.49). State: q_MS as four numbers x = [q0 q1 q2 q3], M's x axis under the field; covariance P, 4 x 4.
///
///     step:         x <- F x,  F = I + dt/2 Omega(w)     P <- F P F^T + Q,  Q = N^2 dt/4 (I - q q^T)
///     observation:  z = (q - mu grad/|grad|) normalised, grad = J^T f at the q before the step,
///                   f = [R^T up - a; R^T b - m],  b = [sqrt(h_x^2 + h_y^2), 0, h_z],  h = R m
///     Kalman:       H = I,  K = P (P + r I)^-1,  x <- x + K (z - x),  P <- P - K P,  then normalised
///
/// `printed`: mu = alpha |q_dot| dt, alpha > 1, and the sign of F(3,2) as eq. 5.25 has it, which makes the
/// step no rotation. What is wrong with it besides: mu vanishes at rest, where nothing is then corrected; z
/// belongs to the beginning of the step and x to its end, so that z holds back the rotation; Euler's step
/// stretches q. Corrected, the step is the exponential map with F its matrix; z is carried over the step with
/// it; and mu = |grad| / |J grad/|grad||^2 goes to the minimum of the linearised objective along the
/// gradient, so that how much of the observation is believed is the gain's business alone. The thesis leaves
/// Q's form open: this one is the gyro's white noise N, which no error along q can follow. z is made from the
/// estimate: P weighs, but is no covariance of the error. There is no bias: gyro_noise has to stand for it.
/// Vectors in any unit; one of zero length is left out. Range: |w| dt < 0.3 rad.
class GradientEkf {
 public:
  explicit GradientEkf(const GradientEkfParams& params);

  /// Gyro and accelerometer; all vectors in the frame S at the beginning of the step.
  void Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, double dt_s);
  /// With the magnetometer.
  void Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, const Vector3d& m_S, double dt_s);

  const Quaterniond& q_MS() const { return q_MS_; }
  void Set(const Quaterniond& q_MS) { q_MS_ = q_MS; }

 private:
  using Vector4d = Eigen::Vector4d;
  using Matrix4d = Eigen::Matrix4d;

  /// z from the gradient; `curvature` is |J grad|^2.
  Vector4d Observe(const Vector4d& gradient, double curvature, const Vector3d& w_S_rad_s, double dt_s) const;
  void Filter(const Vector3d& w_S_rad_s, const Vector4d& z, double dt_s);

  GradientEkfParams params_;
  Quaterniond q_MS_ = Quaterniond::Identity();
  Matrix4d P_;
};

}  // namespace piperun::estimator
