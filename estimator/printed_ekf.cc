#include "estimator/printed_ekf.h"

#include <cmath>

namespace piperun::estimator {
namespace {

using Row4 = Eigen::Matrix<double, 1, 4>;
using Matrix4x3 = Eigen::Matrix<double, 4, 3>;

constexpr double kInitialQuaternionVariance = 0.1;

/// q_dot = 1/2 Xi(q) w, eq. 10.
Matrix4x3 CalcXi(const Quaterniond& q) {
  Matrix4x3 xi;
  xi << -q.x(), -q.y(), -q.z(), q.w(), -q.z(), q.y(), q.z(), q.w(), -q.x(), -q.y(), q.x(), q.w();
  return xi;
}

Eigen::Matrix4d CalcOmega(const Vector3d& w) {
  Eigen::Matrix4d omega;
  omega << 0, -w.x(), -w.y(), -w.z(), w.x(), 0, w.z(), -w.y(), w.y(), -w.z(), 0, w.x(), w.z(), w.y(), -w.x(),
      0;
  return omega;
}

/// Up, in S: the first three components of h.
Vector3d CalcUp(const Quaterniond& q) {
  return {2 * (q.x() * q.z() - q.w() * q.y()), 2 * (q.y() * q.z() + q.w() * q.x()),
          q.w() * q.w() - q.x() * q.x() - q.y() * q.y() + q.z() * q.z()};
}

Eigen::Matrix<double, 3, 4> CalcUpJacobian(const Quaterniond& q) {
  Eigen::Matrix<double, 3, 4> H;
  H << -q.y(), q.z(), -q.w(), q.x(), q.x(), q.w(), q.z(), q.y(), q.w(), -q.x(), -q.y(), q.z();
  return 2 * H;
}

/// Sine and cosine parts of the yaw, the fourth component of h, and its gradient.
double CalcYaw(const Quaterniond& q, Row4& gradient) {
  const double s = 2 * (q.x() * q.y() + q.w() * q.z());
  const double c = q.w() * q.w() + q.x() * q.x() - q.y() * q.y() - q.z() * q.z();
  const Row4 ds = 2 * Row4(q.z(), q.y(), q.x(), q.w());
  const Row4 dc = 2 * Row4(q.w(), q.x(), -q.y(), -q.z());
  gradient = (c * ds - s * dc) / (s * s + c * c);
  return std::atan2(s, c);
}

/// Yaw from the field, levelled by the Euler angles of eqs 6 and 7.
double CalcMagneticYaw(const Vector3d& a, const Vector3d& m, const Vector3d& field_W) {
  const double roll = std::atan(a.y() / std::hypot(a.x(), a.z()));
  const double pitch = -std::atan(a.x() / std::hypot(a.y(), a.z()));
  const Vector3d level =
      Eigen::AngleAxisd(pitch, Vector3d::UnitY()) * (Eigen::AngleAxisd(roll, Vector3d::UnitX()) * m);
  return std::atan2(field_W.y(), field_W.x()) - std::atan2(level.y(), level.x());
}

}  // namespace

PrintedEkf::PrintedEkf(const AttitudeParams& params, double gravity_m_s2, const Vector3d& field_W_T)
    : params_(params), g_m_s2_(gravity_m_s2), field_W_T_(field_W_T) {
  P_.diagonal().head<4>().setConstant(kInitialQuaternionVariance);
  P_.diagonal().tail<3>().setConstant(params.gyro_bias_sd_rad_s * params.gyro_bias_sd_rad_s);
}

void PrintedEkf::Propagate(const ImuStep& step) {
  const double dt = step.dt_s;
  w_S_ = step.w_S_rad_s - bias_S_;
  const Matrix4x3 xi = CalcXi(q_WS_);
  Matrix7d F = Matrix7d::Identity();
  F.topLeftCorner<4, 4>() += 0.5 * dt * CalcOmega(w_S_);
  F.topRightCorner<4, 3>() = -0.5 * dt * xi;
  P_ = F * P_ * F.transpose();
  const double N = params_.gyro_noise_rad_s_sqrtHz, K = params_.gyro_bias_walk_rad_s2_sqrtHz;
  P_.topLeftCorner<4, 4>() += 0.25 * N * N * dt * xi * xi.transpose();
  P_.diagonal().tail<3>().array() += K * K * dt;

  const Eigen::Vector4d dq = 0.5 * dt * xi * w_S_;
  q_WS_ =
      Quaterniond(q_WS_.w() + dq[0], q_WS_.x() + dq[1], q_WS_.y() + dq[2], q_WS_.z() + dq[3]).normalized();
}

void PrintedEkf::UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) {
  f_S_ = step.f_S_m_s2;
  const double sd =
      (params_.accelerometer_noise_m_s2_sqrtHz / std::sqrt(step.dt_s) + motion_acceleration_sd_m_s2) /
      g_m_s2_;
  Update<3>(CalcUpJacobian(q_WS_), f_S_ / g_m_s2_ - CalcUp(q_WS_), sd * sd);
}

bool PrintedEkf::UpdateMagnetic(const Vector3d& m_S_T, const Vector3d&) {
  Row4 H;
  const double yaw = CalcYaw(q_WS_, H);
  const double sd = params_.magnetometer_sd_T / field_W_T_.head<2>().norm();
  const Eigen::Matrix<double, 1, 1> z(WrapAngle(CalcMagneticYaw(f_S_, m_S_T, field_W_T_) - yaw));
  Update<1>(H, z, sd * sd);
  return true;
}

template <int n>
void PrintedEkf::Update(const Eigen::Matrix<double, n, 4>& H, const Eigen::Matrix<double, n, 1>& z,
                        double variance) {
  using MatrixN = Eigen::Matrix<double, n, n>;
  const Eigen::Matrix<double, 7, n> PHt = P_.leftCols<4>() * H.transpose();
  const MatrixN S = H * PHt.template topRows<4>() + variance * MatrixN::Identity();
  const MatrixN S_inverse = S.inverse();
  const Eigen::Matrix<double, 7, n> K = PHt * S_inverse;
  const Eigen::Matrix<double, 7, 1> dx = K * z;
  nis_ = Nis{z.dot(S_inverse * z), n};
  P_ -= K * PHt.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  q_WS_ =
      Quaterniond(q_WS_.w() + dx[0], q_WS_.x() + dx[1], q_WS_.y() + dx[2], q_WS_.z() + dx[3]).normalized();
  bias_S_ += dx.tail<3>();
}

Matrix3d PrintedEkf::Covariance_W_rad2() const {
  // dtheta_W = 2 vec(dq x q*)
  Eigen::Matrix<double, 3, 4> L;
  const Quaterniond& q = q_WS_;
  L << -q.x(), q.w(), -q.z(), q.y(), -q.y(), q.z(), q.w(), -q.x(), -q.z(), -q.y(), q.x(), q.w();
  return 4 * L * P_.topLeftCorner<4, 4>() * L.transpose();
}

}  // namespace piperun::estimator
