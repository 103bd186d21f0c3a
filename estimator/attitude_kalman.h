#pragma once

#include <numbers>

#include "estimator/attitude_ekf.h"
#include "estimator/attitude_model.h"
#include "estimator/attitude_rate.h"
#include "estimator/chi_square.h"

namespace piperun::estimator {

/// Thresholds of z^T S^-1 z for one, two and three numbers.
struct ChiSquareGates {
  explicit ChiSquareGates(double probability)
      : one(CalcChiSquareQuantile(probability, 1)),
        two(CalcChiSquareQuantile(probability, 2)),
        three(CalcChiSquareQuantile(probability, 3)) {}
  double one, two, three;
};

/// P - half K^T - K half^T, symmetric to the last bit.
template <int n, int m>
void TakeSymmetric(Eigen::Matrix<double, n, n>& P, const Eigen::Matrix<double, n, m>& half,
                   const Eigen::Matrix<double, n, m>& K) {
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) {
      double sum = P(i, j);
      for (int l = 0; l < m; ++l) sum -= half(i, l) * K(j, l) + K(i, l) * half(j, l);
      P(i, j) = P(j, i) = sum;
    }
  }
}

/// P - K (P H^T)^T for the optimal gain K = P H^T S^-1, from one triangle.
template <int n, int m>
void TakeOptimal(Eigen::Matrix<double, n, n>& P, const Eigen::Matrix<double, n, m>& PHt,
                 const Eigen::Matrix<double, n, m>& K) {
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) {
      double sum = P(i, j);
      for (int l = 0; l < m; ++l) sum -= K(i, l) * PHt(j, l);
      P(i, j) = P(j, i) = sum;
    }
  }
}

/// What Kalman filters on SO(3) x R^n have in common: nominal attitude q_WS and gyro bias b, covariance P of
/// the error [dtheta, db, ...] with R_true = Exp(dtheta) R, dtheta in W, and b_true = b + db; the corrections
/// that heading and rest give, and the gates.
///
/// The error rotation is kept in the axes of W: what is not known about the vertical then stays about the
/// vertical however large a correction, and needs no turning with the body.
/// A heading may turn only about the vertical and change only the bias about it, so that no magnetic
/// disturbance tilts the attitude: its gain is the optimal one projected on the vertical, with Joseph's
/// update, which holds for any gain. A magnetic heading beyond the gate is discarded.
template <int n>
class AttitudeKalman : public AttitudeFilter {
 public:
  using State = Eigen::Matrix<double, n, 1>;
  using Covariance = Eigen::Matrix<double, n, n>;

  /// `field_W_T` zero: no magnetic reference.
  AttitudeKalman(const AttitudeModelParams& params, double gravity_m_s2, const Vector3d& field_W_T)
      : params_(params), g_m_s2_(gravity_m_s2), field_W_T_(field_W_T), gates_(params.gate_probability) {
    P_.diagonal().template segment<3>(kBias).setConstant(params.gyro_bias_sd_rad_s *
                                                         params.gyro_bias_sd_rad_s);
  }

  void AlignTilt(const Vector3d& f_S_m_s2) override {
    Align(CalcTilt(f_S_m_s2), Vector3d(kTiltSd_rad, kTiltSd_rad, std::numbers::pi));
  }
  /// Starts from an attitude known with these standard deviations about the axes of W.
  void Align(const Quaterniond& q_WS, const Vector3d& sd_W_rad) {
    q_WS_ = q_WS;
    P_.template topLeftCorner<3, 3>() = sd_W_rad.cwiseAbs2().asDiagonal();
  }
  bool UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) final {
    const Vector3d m_W_T = q_WS_ * (ExpSO3(ahead_S_rad) * m_S_T);
    const auto heading = CalcHeadingObservation(params_, m_W_T, field_W_T_);
    if (!heading) return false;
    const double S =
        heading->h_W.dot(P_.template topLeftCorner<3, 3>() * heading->h_W) + heading->variance_rad2;
    nis_ = Nis{heading->z_rad * heading->z_rad / S, 1};
    if (nis_->value > gates_.one) return false;
    UpdateVertical(*heading);
    return true;
  }
  void UpdateHeading(double offset_rad, double sd_rad) final {
    UpdateVertical({offset_rad, Vector3d::UnitZ(), sd_rad * sd_rad});
  }
  void UpdateRestRate(const Vector3d& w_S_rad_s, double duration_s) final {
    const double variance = params_.gyro_noise_rad_s_sqrtHz * params_.gyro_noise_rad_s_sqrtHz / duration_s;
    for (int i = 0; i < 3; ++i) UpdateComponent(kBias + i, w_S_rad_s[i] - bias_S_rad_s_[i], variance);
  }

  const Quaterniond& q_WS() const final { return q_WS_; }
  const Vector3d& gyro_bias_S_rad_s() const final { return bias_S_rad_s_; }
  Matrix3d Covariance_W_rad2() const final { return P_.template topLeftCorner<3, 3>(); }
  const Vector3d& w_S_rad_s() const final { return w_S_rad_s_; }
  const std::optional<Nis>& nis() const final { return nis_; }
  /// Of [dtheta in W, db in S, ...].
  const Covariance& covariance() const { return P_; }

 protected:
  static constexpr int kBias = 3;
  static constexpr double kTiltSd_rad = 0.1;  // a launch at 1 m/s^2 taken for gravity

  /// The step's rotation vector with the bias taken out; sets the rate.
  Vector3d CorrectedTurn_S(const ImuStep& step) {
    const Vector3d turn_S_rad = step.dtheta_S_rad - bias_S_rad_s_ * step.dt_s;
    w_S_rad_s_ = turn_S_rad / step.dt_s;
    return turn_S_rad;
  }
  /// P for dtheta <- dtheta + B db and the step's noise.
  void PropagateAttitudeAndBias(const ImuStep& step, const Matrix3d& B) {
    const Eigen::Matrix<double, 3, n> Bb = B.lazyProduct(P_.template middleRows<3>(kBias));
    const Matrix3d growth =
        Bb.template leftCols<3>() + 0.5 * Bb.template middleCols<3>(kBias).lazyProduct(B.transpose());
    P_.template topLeftCorner<3, 3>() += growth + growth.transpose();
    P_.template topRightCorner<3, n - 3>() += Bb.template rightCols<n - 3>();
    P_.template bottomLeftCorner<n - 3, 3>() = P_.template topRightCorner<3, n - 3>().transpose();
    AddNoise(step);
  }
  /// To P, what the step's gyro noise and the bias' walk add.
  void AddNoise(const ImuStep& step) {
    P_.diagonal().template segment<3>(kBias).array() +=
        params_.gyro_bias_walk_rad_s2_sqrtHz * params_.gyro_bias_walk_rad_s2_sqrtHz * step.dt_s;
    AddTurnNoise(step);
  }
  void Correct(const State& dx) {
    const Quaterniond turn = ExpSO3(dx.template head<3>());
    q_WS_ = (turn * q_WS_).normalized();
    bias_S_rad_s_ += dx.template segment<3>(kBias);
    if constexpr (n > 6) CorrectMore(dx, turn);
  }
  virtual void CorrectMore(const State&, const Quaterniond&) {}

  AttitudeModelParams params_;
  double g_m_s2_;
  Vector3d field_W_T_;
  ChiSquareGates gates_;
  Quaterniond q_WS_ = Quaterniond::Identity();
  Vector3d bias_S_rad_s_ = Vector3d::Zero();
  Vector3d w_S_rad_s_ = Vector3d::Zero();
  Covariance P_ = Covariance::Zero();
  std::optional<Nis> nis_;

 private:
  void AddTurnNoise(const ImuStep& step) {
    const Vector3d variance = CalcTurnVariance_S(params_, step);
    if (variance.x() == variance.y() && variance.y() == variance.z()) {  // the same in all axes
      P_.diagonal().template head<3>() += variance;
      return;
    }
    const Matrix3d R = q_WS_.toRotationMatrix();
    P_.template topLeftCorner<3, 3>() += R * variance.asDiagonal() * R.transpose();
  }
  void UpdateVertical(const HeadingObservation& heading) {
    const Vector3d up_S = CalcUp_S(q_WS_);
    const State Ph = P_.template leftCols<3>() * heading.h_W;
    const double S = heading.h_W.dot(Ph.template head<3>()) + heading.variance_rad2;
    State K = State::Zero();
    K[2] = Ph[2] / S;
    K.template segment<3>(kBias) = up_S * (up_S.dot(Ph.template segment<3>(kBias)) / S);
    JosephUpdate(K, Ph, S);
    Correct(K * heading.z_rad);
  }
  /// The error's component i has been measured.
  void UpdateComponent(int i, double z, double variance) {
    const State Ph = P_.col(i);
    const double S = Ph[i] + variance;
    JosephUpdate(Ph / S, Ph, S);
    Correct(Ph * (z / S));
  }
  /// (I - K h^T) P (I - K h^T)^T + K r K^T = P - K Ph^T - Ph K^T + K S K^T.
  void JosephUpdate(const State& K, const State& Ph, double S) {
    TakeSymmetric<n, 1>(P_, Ph - 0.5 * S * K, K);
  }
};

}  // namespace piperun::estimator
