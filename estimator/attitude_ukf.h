#pragma once

#include <array>

#include "estimator/attitude_kalman.h"

namespace piperun::estimator {

/// Unscented Kalman filter on SO(3) x R^3 (M. Brossard, A. Barrau & S. Bonnabel, "A code for unscented Kalman
/// filtering on manifolds", ICRA 2020; scaled sigma points: R. van der Merwe, thesis, OHSU 2004).
///
/// State q_WS and gyro bias b, error x = [dtheta, db] with R_true = Exp(dtheta) R. Thirteen sigma points in
/// the tangent space, x_0 = 0 and x_i = +- alpha sqrt(6) (column i of L), P = L L^T, of weights 1/(12
/// alpha^2), and 1 - 1/alpha^2 for the mean, 4 - alpha^2 - 1/alpha^2 for the covariance (beta = 2) of x_0.
/// Each goes through the whole equations, phi = dtheta_m - b dt:
///
///     step:     x_i' = [Log(Exp(dtheta_i) R Exp(phi - db_i dt) Exp(-phi) R^T), db_i]
///     gravity:  y_i = Exp(-dtheta_i) up,     z = R f / g
///
/// and their weighted mean and spread, plus the noise, replace the Jacobians of the error-state filter. The
/// small alpha keeps the points of an unknown heading, sd pi, inside half a turn. The field is a heading in
/// the way of AttitudeKalman: within the tilt errors left then, its one number is linear in dtheta. Noise,
/// excess, gate and clipping as in AttitudeIekf. Range: |w| dt < pi.
class AttitudeUkf final : public AttitudeKalman<6> {
 public:
  using AttitudeKalman::AttitudeKalman;

  void Propagate(const ImuStep& step) override;
  void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) override;

 private:
  using SigmaPoints = std::array<State, 13>;

  /// Of the present covariance.
  SigmaPoints DrawSigmaPoints() const;

  Quaterniond q_WS_force_ = Quaterniond::Identity();  // where the step's specific force is given
};

/// Lower triangular L with L L^T = P, a column of zeros where P has nothing left: P may be singular.
Eigen::Matrix<double, 6, 6> CalcRoot(const Eigen::Matrix<double, 6, 6>& P);

}  // namespace piperun::estimator
