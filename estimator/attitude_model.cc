#include "estimator/attitude_model.h"

#include <algorithm>
#include <cmath>

#include "estimator/attitude_ekf.h"

namespace piperun::estimator {
namespace {

constexpr double kExcessSigmas = 3;
constexpr double kMinHorizontal = 0.1;

double Squared(double x) { return x * x; }

}  // namespace

void AttitudeModelParams::Visit(ParamVisitor& v) {
  v.Number({"gyro_noise_rad_s_sqrtHz", "Assumed white noise of the gyro (angle random walk)."},
           Range::Positive(), gyro_noise_rad_s_sqrtHz);
  v.Number({"gyro_bias_sd_rad_s", "Assumed turn-on bias and scale-factor error times spin, one sigma."},
           Range::NonNegative(), gyro_bias_sd_rad_s);
  v.Number({"gyro_bias_walk_rad_s2_sqrtHz", "Assumed random walk of both."}, Range::NonNegative(),
           gyro_bias_walk_rad_s2_sqrtHz);
  v.Number({"clipped_rate_sd_rad_s", "Assumed excess of the rate over a clipped gyro's range, one sigma."},
           Range::NonNegative(), clipped_rate_sd_rad_s);
  v.Number({"clipped_correlation_s", "How long such an excess lasts."}, Range::NonNegative(),
           clipped_correlation_s);
  v.Number({"accelerometer_noise_m_s2_sqrtHz", "Assumed white noise of the accelerometer."},
           Range::Positive(), accelerometer_noise_m_s2_sqrtHz);
  v.Number({"motion_acceleration_sd_m_s2", "Assumed acceleration of the ball itself, one sigma."},
           Range::NonNegative(), motion_acceleration_sd_m_s2);
  v.Number({"motion_correlation_s", "How long such an acceleration lasts."}, Range::Positive(),
           motion_correlation_s);
  v.Number({"magnetometer_sd_T", "Assumed error of one magnetometer sample, per axis."}, Range::Positive(),
           magnetometer_sd_T);
  v.Number({"field_tolerance", "A field whose magnitude is off by more than this fraction is ignored."},
           Range::Positive(), field_tolerance);
  v.Number({"gate_probability", "Share of good measurements inside the chi-square gate."},
           Range::Between(0.5, 1 - 1e-15), gate_probability);
}

Vector3d CalcTurnVariance_S(const AttitudeModelParams& params, const ImuStep& step) {
  const double guessed = Squared(step.missing_s) * step.dw_S_rad_s.squaredNorm() / 12;
  Vector3d variance = Vector3d::Constant(Squared(params.gyro_noise_rad_s_sqrtHz) * step.dt_s + guessed);
  const double clipped = 2 * Squared(params.clipped_rate_sd_rad_s) * params.clipped_correlation_s * step.dt_s;
  for (int i = 0; i < 3; ++i) {
    if (step.GyroClipped(i)) variance[i] += clipped;
  }
  return variance;
}

double CalcForceVariance(const AttitudeModelParams& params, double interval_s, double motion_sd_m_s2) {
  return (Squared(params.accelerometer_noise_m_s2_sqrtHz) +
          2 * params.motion_correlation_s * Squared(motion_sd_m_s2)) /
         interval_s;
}

double CalcExcessVariance(double f_m_s2, double gravity_m_s2, double variance) {
  return std::max(0.0, Squared(f_m_s2 - gravity_m_s2) - kExcessSigmas * kExcessSigmas * variance);
}

std::optional<HeadingObservation> CalcHeadingObservation(const AttitudeModelParams& params,
                                                         const Vector3d& m_W_T, const Vector3d& field_W_T) {
  const double horizontal2 = m_W_T.head<2>().squaredNorm();
  const double horizontal_ref = field_W_T.head<2>().norm();
  if (std::abs(m_W_T.norm() / field_W_T.norm() - 1) > params.field_tolerance) return std::nullopt;
  if (!(horizontal2 > Squared(kMinHorizontal * horizontal_ref))) return std::nullopt;
  HeadingObservation heading;
  heading.z_rad = WrapAngle(std::atan2(field_W_T.y(), field_W_T.x()) - std::atan2(m_W_T.y(), m_W_T.x()));
  heading.h_W = {-m_W_T.z() * m_W_T.x() / horizontal2, -m_W_T.z() * m_W_T.y() / horizontal2, 1};
  heading.variance_rad2 = Squared(params.magnetometer_sd_T) / horizontal2;
  return heading;
}

}  // namespace piperun::estimator
