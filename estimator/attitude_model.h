#pragma once

#include <optional>

#include "base/params.h"
#include "estimator/imu_step.h"

namespace piperun::estimator {

/// What a Kalman filter of attitude and gyro bias assumes of its sensors and of the motion. Assumed, never
/// the truth's own values.
struct AttitudeModelParams {
  double gyro_noise_rad_s_sqrtHz = 1.75e-4;
  double gyro_bias_sd_rad_s = 1e-2;
  double gyro_bias_walk_rad_s2_sqrtHz = 1e-4;
  double clipped_rate_sd_rad_s = 5;
  double clipped_correlation_s = 0.05;
  double accelerometer_noise_m_s2_sqrtHz = 2e-3;
  double motion_acceleration_sd_m_s2 = 0.05;
  double motion_correlation_s = 0.1;
  double magnetometer_sd_T = 0.5e-6;
  double field_tolerance = 0.2;
  double gate_probability = 0.999;

  void Visit(ParamVisitor& v);
};

/// Variance of each component of a step's rotation vector, from the gyro's noise: N^2 dt; plus
/// |dw|^2 T^2 / 12 over the part T that no sample covers, the rate there being uniform between its
/// neighbours; plus, on an axis at the end of its range, 2 s^2 tau dt: the rate exceeds the reading by an
/// error of standard deviation s that lasts for tau, as an equivalent white density. rad^2.
Vector3d CalcTurnVariance_S(const AttitudeModelParams& params, const ImuStep& step);

/// Variance of one component of an interval's mean specific force that white noise and, as an equivalent
/// white density, the motion's own acceleration make: (N^2 + 2 tau a^2) / interval, (m/s^2)^2. Range:
/// interval >> tau is exact; for a shorter one it holds for averages over many intervals.
double CalcForceVariance(const AttitudeModelParams& params, double interval_s, double motion_sd_m_s2);

/// (|f| - g)^2 beyond three sigma of `variance`: that much of a specific force is motion, not gravity.
double CalcExcessVariance(double f_m_s2, double gravity_m_s2, double variance);

/// One heading: z = h_W . (dtheta in W), with its variance.
struct HeadingObservation {
  double z_rad = 0;
  Vector3d h_W = Vector3d::UnitZ();
  double variance_rad2 = 0;
};

/// What a magnetometer tells of the heading: psi_ref - psi(m_W), linear in the error rotation dtheta of
/// R_true = Exp(dtheta) R:  dtheta_z - m_z (m_x dtheta_x + m_y dtheta_y) / m_h^2,  m_W = R m_S. Nothing where
/// the magnitude is off by more than the tolerance or the horizontal part is below a tenth of the
/// reference's.
std::optional<HeadingObservation> CalcHeadingObservation(const AttitudeModelParams& params,
                                                         const Vector3d& m_W_T, const Vector3d& field_W_T);

}  // namespace piperun::estimator
