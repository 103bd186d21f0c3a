#pragma once

#include "estimator/attitude_kalman.h"

namespace piperun::estimator {

/// "Imperfect" right-invariant extended Kalman filter on SO(3) with gyro bias (S. Bonnabel, P. Martin &
/// E. Salaun, CDC 2009; A. Barrau & S. Bonnabel, IEEE Trans. Autom. Control 62, 1797, 2017; with biases:
/// Hartley et al., Int. J. Robotics Research 39, 402, 2020, section 7).
///
/// State q_WS and bias b; right-invariant error eta = R_true R^T = Exp(xi), and db = b_true - b. Because the
/// gyro multiplies R from the right, it drops out of eta: without bias the error of R_true' = R_true w,
/// R' = R w stays what it is on any trajectory. With bias (the imperfection) only R enters:
///
///     d(xi)/dt = -R db - R n          db/dt = walk          P <- Phi P Phi^T + Q,   Phi = [I, B; 0, I],
///     B = -R J_l(phi) dt,   J_l(phi) = I + (1 - cos)/phi^2 [phi]x + (phi - sin)/phi^3 [phi]x^2
///
/// exactly integrated over a step of constant rate, phi = dtheta_m - b dt. The vertical is a known vector of
/// W seen in S, R_true^T up: a right-invariant observation, with an innovation whose matrix is a constant:
///
///     z = R f / g - up = [up]x xi + noise
///
/// Its two horizontal numbers are taken at once; the third, vertical one tells nothing of the attitude. With
/// noise the same in all axes nothing in the gain depends on the trajectory either. The field is a heading in
/// the way of AttitudeKalman. Gravity's noise is the accelerometer's, plus the motion's as an equivalent
/// white density, plus (|f| - g)^2 beyond three sigma; beyond the gate it grows until the innovation is at
/// the gate, so the filter cannot lock itself out. Clipped gyro axes: CalcTurnVariance_S; a clipped
/// accelerometer is not listened to. Range: |w| dt < pi.
class AttitudeIekf final : public AttitudeKalman<6> {
 public:
  using AttitudeKalman::AttitudeKalman;

  void Propagate(const ImuStep& step) override;
  void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) override;

 private:
  Quaterniond q_WS_force_ = Quaterniond::Identity();  // where the step's specific force is given
};

/// Left Jacobian of SO(3), the mean of Exp(s phi) over s from 0 to 1.
Matrix3d CalcLeftJacobian(const Vector3d& phi_rad);

}  // namespace piperun::estimator
