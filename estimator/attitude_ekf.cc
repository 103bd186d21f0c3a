#include "estimator/attitude_ekf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace piperun::estimator {
namespace {

constexpr double kInitialTiltSd_rad = 0.05;
constexpr double kExcessSigmas = 3;     // |f| - g beyond this is motion, not noise
constexpr double kMinHorizontal = 0.1;  // of the reference's horizontal part: less has no heading
constexpr int kBias = 3, kScale = 6;

double Squared(double x) { return x * x; }

}  // namespace

void AttitudeParams::Visit(ParamVisitor& v) {
  v.Number({"gyro_noise_rad_s_sqrtHz", "Assumed white noise of the gyro (angle random walk)."},
           Range::Positive(), gyro_noise_rad_s_sqrtHz);
  v.Number({"gyro_bias_sd_rad_s", "Assumed turn-on bias, one sigma."}, Range::NonNegative(),
           gyro_bias_sd_rad_s);
  v.Number({"gyro_bias_walk_rad_s2_sqrtHz", "Assumed random walk of the bias."}, Range::NonNegative(),
           gyro_bias_walk_rad_s2_sqrtHz);
  v.Number({"gyro_scale_sd", "Assumed scale-factor error, one sigma; 0 leaves it out of the state."},
           Range::Between(0, 0.1), gyro_scale_sd);
  v.Number({"accelerometer_noise_m_s2_sqrtHz", "Assumed white noise of the accelerometer."},
           Range::Positive(), accelerometer_noise_m_s2_sqrtHz);
  v.Number({"motion_acceleration_sd_m_s2", "Assumed acceleration of the ball itself, one sigma."},
           Range::NonNegative(), motion_acceleration_sd_m_s2);
  v.Number({"motion_correlation_s", "How long such an acceleration lasts."}, Range::NonNegative(),
           motion_correlation_s);
  v.Number({"magnetometer_sd_T", "Assumed error of one magnetometer sample, per axis."}, Range::Positive(),
           magnetometer_sd_T);
  v.Number({"field_tolerance", "A field whose magnitude is off by more than this fraction is ignored."},
           Range::Positive(), field_tolerance);
  v.Number({"nis_gate", "Normalised innovation squared from which a measurement counts as an outlier."},
           Range::Positive(), nis_gate);
}

Quaterniond CalcTilt(const Vector3d& f_S_m_s2) {
  return Quaterniond::FromTwoVectors(f_S_m_s2, Vector3d::UnitZ());
}

double WrapAngle(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

AttitudeEkf::AttitudeEkf(const AttitudeParams& params, double gravity_m_s2, const Vector3d& field_W_T)
    : params_(params), g_m_s2_(gravity_m_s2), field_W_T_(field_W_T) {
  P_.diagonal().segment<3>(kBias).setConstant(Squared(params.gyro_bias_sd_rad_s));
  P_.diagonal().segment<3>(kScale).setConstant(Squared(params.gyro_scale_sd));
}

void AttitudeEkf::AlignTilt(const Vector3d& f_S_m_s2) {
  q_WS_ = q_WS_mid_ = q_WS_begin_ = CalcTilt(f_S_m_s2);
  P_.topLeftCorner<3, 3>() =
      Vector3d(Squared(kInitialTiltSd_rad), Squared(kInitialTiltSd_rad), Squared(std::numbers::pi))
          .asDiagonal();
}

void AttitudeEkf::Propagate(const ImuStep& step) {
  const Vector3d dtheta_S = step.dtheta_S_rad - (bias_S_ + scale_.cwiseProduct(step.w_S_rad_s)) * step.dt_s;
  w_S_ = dtheta_S / step.dt_s;
  const Quaterniond half = ExpSO3(0.5 * dtheta_S);
  q_WS_begin_ = q_WS_;
  q_WS_mid_ = q_WS_ * half;
  q_WS_ = (q_WS_mid_ * half).normalized();
  PropagateCovariance(step);
}

void AttitudeEkf::PropagateCovariance(const ImuStep& step) {
  // dtheta += A db + A diag(w) ds, A = -R dt; G: the same with the two lower rows of blocks, (db + w ds)
  const Matrix3d A = -step.dt_s * q_WS_mid_.toRotationMatrix();
  const Eigen::Matrix<double, 3, 9> G =
      P_.middleRows<3>(kBias) + w_S_.asDiagonal() * P_.middleRows<3>(kScale);
  const Eigen::Matrix<double, 3, 9> AG = A.lazyProduct(G);
  const Matrix3d AGB = AG.middleCols<3>(kBias) + AG.middleCols<3>(kScale) * w_S_.asDiagonal();
  const Matrix3d growth = 2 * AG.leftCols<3>() + AGB.lazyProduct(A.transpose());
  P_.topLeftCorner<3, 3>() += 0.5 * (growth + growth.transpose());
  P_.topRightCorner<3, 6>() += AG.rightCols<6>();
  P_.bottomLeftCorner<6, 3>() = P_.topRightCorner<3, 6>().transpose();

  // over a gap the rate was guessed between its neighbours: uniform in between
  const double guessed = Squared(step.missing_s) * step.dw_S_rad_s.squaredNorm() / 12;
  P_.diagonal().head<3>().array() += Squared(params_.gyro_noise_rad_s_sqrtHz) * step.dt_s + guessed;
  P_.diagonal().segment<3>(kBias).array() += Squared(params_.gyro_bias_walk_rad_s2_sqrtHz) * step.dt_s;
}

double AttitudeEkf::GravityVariance(double interval_s, double motion_sd_m_s2) const {
  const double density = Squared(params_.accelerometer_noise_m_s2_sqrtHz) +
                         2 * params_.motion_correlation_s * Squared(motion_sd_m_s2);
  return density / interval_s / Squared(g_m_s2_);
}

void AttitudeEkf::UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) {
  const Quaterniond& q = step.f_at_begin ? q_WS_begin_ : q_WS_mid_;
  const Vector3d y = (q * step.f_S_m_s2) / g_m_s2_;
  const double z_x = y.y(), z_y = -y.x();
  const double excess = y.norm() - 1;
  double variance = GravityVariance(step.dt_s - step.missing_s, motion_acceleration_sd_m_s2);
  variance += std::max(0.0, Squared(excess) - kExcessSigmas * kExcessSigmas * variance);

  const double S00 = P_(0, 0) + variance, S11 = P_(1, 1) + variance, S01 = P_(0, 1);
  const double nis = (S11 * z_x * z_x - 2 * S01 * z_x * z_y + S00 * z_y * z_y) / (S00 * S11 - S01 * S01);
  nis_ = Nis{nis, 2};
  if (nis > params_.nis_gate) variance += (nis / params_.nis_gate - 1) * std::max(S00, S11);

  // the second number is what is left after the first has turned the attitude
  const double gain_yx = P_(0, 1) / (P_(0, 0) + variance);
  Vector9d dx = UpdateComponent(0, z_x, variance);
  dx += UpdateComponent(1, z_y - gain_yx * z_x, variance);
  Correct(dx);
}

bool AttitudeEkf::UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) {
  const Vector3d m = q_WS_ * (ExpSO3(ahead_S_rad) * m_S_T);
  const double horizontal2 = m.head<2>().squaredNorm();
  const double horizontal_ref = field_W_T_.head<2>().norm();
  const bool disturbed = std::abs(m.norm() / field_W_T_.norm() - 1) > params_.field_tolerance;
  if (disturbed || !(horizontal2 > Squared(kMinHorizontal * horizontal_ref))) return false;
  const double z = WrapAngle(std::atan2(field_W_T_.y(), field_W_T_.x()) - std::atan2(m.y(), m.x()));
  const Vector3d h(-m.z() * m.x() / horizontal2, -m.z() * m.y() / horizontal2, 1);
  const double variance = Squared(params_.magnetometer_sd_T) / horizontal2;
  const double S = h.dot(P_.topLeftCorner<3, 3>() * h) + variance;
  nis_ = Nis{z * z / S, 1};
  if (nis_->value > params_.nis_gate) return false;
  UpdateVertical(h, z, variance);
  return true;
}

void AttitudeEkf::UpdateHeading(double offset_rad, double sd_rad) {
  UpdateVertical(Vector3d::UnitZ(), offset_rad, Squared(sd_rad));
}

void AttitudeEkf::UpdateRestRate(const Vector3d& w_S_rad_s, double duration_s) {
  const double variance = Squared(params_.gyro_noise_rad_s_sqrtHz) / duration_s;
  for (int i = 0; i < 3; ++i) Correct(UpdateComponent(kBias + i, w_S_rad_s[i] - bias_S_[i], variance));
}

AttitudeEkf::Vector9d AttitudeEkf::UpdateComponent(int i, double z, double variance) {
  const Vector9d Ph = P_.col(i);
  const double S = Ph[i] + variance;
  const Vector9d K = Ph / S;
  JosephUpdate(K, Ph, S);
  return K * z;
}

void AttitudeEkf::UpdateVertical(const Vector3d& h, double z, double variance) {
  const Vector9d Ph = P_.leftCols<3>() * h;
  const double S = h.dot(Ph.head<3>()) + variance;
  const Vector3d up_S = q_WS_.conjugate() * Vector3d::UnitZ();
  Vector9d K = Vector9d::Zero();
  K[2] = Ph[2] / S;
  K.segment<3>(kBias) = up_S * (up_S.dot(Ph.segment<3>(kBias)) / S);
  JosephUpdate(K, Ph, S);
  Correct(K * z);
}

void AttitudeEkf::JosephUpdate(const Vector9d& K, const Vector9d& Ph, double S) {
  // (I - K h^T) P (I - K h^T)^T + K r K^T = P - K Ph^T - Ph K^T + K S K^T, symmetric to the last bit
  const Vector9d gain = K;
  const Vector9d half = Ph - 0.5 * S * K;
  for (int j = 0; j < 9; ++j) {
    double* column = P_.col(j).data();
    for (int i = 0; i < 9; ++i) column[i] -= half[j] * gain[i] + gain[j] * half[i];
  }
}

void AttitudeEkf::Correct(const Vector9d& dx) {
  const Quaterniond turn = ExpSO3(dx.head<3>());
  q_WS_ = (turn * q_WS_).normalized();
  q_WS_mid_ = turn * q_WS_mid_;
  bias_S_ += dx.segment<3>(kBias);
  scale_ += dx.segment<3>(kScale);
}

}  // namespace piperun::estimator
