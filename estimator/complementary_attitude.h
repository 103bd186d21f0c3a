#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/params.h"
#include "estimator/attitude_ekf.h"
#include "estimator/attitude_filter.h"

namespace piperun::estimator {

/// What is assumed of a filter that knows no covariance of its own. Assumed, never the truth's own values.
struct ComplementaryParams {
  double tilt_sd_rad = 0.02;
  double heading_sd_rad = 0.05;
  double heading_walk_rad_sqrts = 2e-3;
  double field_tolerance = 0.2;
  double gyro_noise_rad_s_sqrtHz = 1.75e-4;
  double gyro_bias_sd_rad_s = 2e-3;

  void Visit(ParamVisitor& v);
};

/// The heading of a filter without covariance, kept beside it: a random walk, told by the compass or by the
/// motion now and then.
class HeadingVariance {
 public:
  explicit HeadingVariance(const ComplementaryParams& params);

  void Propagate(double dt_s) { variance_rad2_ += walk_rad2_s_ * dt_s; }
  void HeadByCompass() { variance_rad2_ = compass_rad2_; }
  /// The share of an offset measured with this standard deviation by which to turn.
  double Update(double sd_rad);
  double rad2() const { return variance_rad2_; }

 private:
  double walk_rad2_s_, compass_rad2_;
  double variance_rad2_ = std::numbers::pi * std::numbers::pi;
};

/// Puts a filter of the form q' = F(q, w, f, m), with fixed gains, where an attitude filter is wanted. Block
/// is estimator/madgwick.h or mahony.h: a quaternion q_MS that Step() advances by a sample, M's x axis lying
/// under the field.
///
/// Rates come coning-compensated, by real stamps; f and m are turned into the frame at the beginning of the
/// step, where the block looks at them. A step of more than 0.3 rad, as after a gap, is taken by the
/// exponential map instead, without correction. A field whose magnitude is off is left out. The first one
/// believed aligns the heading at once. The block's covariance is what ComplementaryParams say.
template <class Block>
class ComplementaryAttitude final : public AttitudeFilter {
 public:
  /// `field_W_T` zero: no magnetic reference.
  ComplementaryAttitude(const Block& block, const ComplementaryParams& params, const Vector3d& field_W_T)
      : block_(block),
        params_(params),
        field_T_(field_W_T.norm()),
        q_WM_(Eigen::AngleAxisd(std::atan2(field_W_T.y(), field_W_T.x()), Vector3d::UnitZ())),
        heading_(params) {}

  void AlignTilt(const Vector3d& f_S_m_s2) override { Set(CalcTilt(f_S_m_s2)); }

  void Propagate(const ImuStep& step) override {
    turn_S_rad_ = step.dtheta_S_rad - bias_S_rad_s_ * step.dt_s;
    w_S_rad_s_ = turn_S_rad_ / step.dt_s;
    heading_.Propagate(step.dt_s);
  }

  void UpdateGravity(const ImuStep& step, double) override {
    constexpr double kLargestStep_rad = 0.3;
    if (turn_S_rad_.norm() > kLargestStep_rad) {
      block_.Set((block_.q_MS() * ExpSO3(turn_S_rad_)).normalized());
    } else {
      const Vector3d f_S = step.f_at_begin ? step.f_S_m_s2 : ExpSO3(0.5 * turn_S_rad_) * step.f_S_m_s2;
      if (field_S_T_) {
        block_.Step(w_S_rad_s_, f_S, *field_S_T_, step.dt_s);
      } else {
        block_.Step(w_S_rad_s_, f_S, step.dt_s);
      }
    }
    field_S_T_.reset();
    q_WS_ = q_WM_ * block_.q_MS();
  }

  bool UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) override {
    if (std::abs(m_S_T.norm() / field_T_ - 1) > params_.field_tolerance) return false;
    field_S_T_ = ExpSO3(ahead_S_rad) * m_S_T;
    if (!compass_) {
      const Vector3d m_M = block_.q_MS() * *field_S_T_;
      TurnAboutVertical(-std::atan2(m_M.y(), m_M.x()));
      compass_ = true;
    }
    heading_.HeadByCompass();
    return true;
  }

  void UpdateHeading(double offset_rad, double sd_rad) override {
    TurnAboutVertical(heading_.Update(sd_rad) * offset_rad);
  }

  void UpdateRestRate(const Vector3d& w_S_rad_s, double) override { bias_S_rad_s_ = w_S_rad_s; }

  const Quaterniond& q_WS() const override { return q_WS_; }
  const Vector3d& gyro_bias_S_rad_s() const override { return bias_S_rad_s_; }
  Matrix3d Covariance_W_rad2() const override {
    const double tilt_rad2 = params_.tilt_sd_rad * params_.tilt_sd_rad;
    return Vector3d(tilt_rad2, tilt_rad2, heading_.rad2()).asDiagonal();
  }
  const Vector3d& w_S_rad_s() const override { return w_S_rad_s_; }
  const std::optional<Nis>& nis() const override { return nis_; }

 private:
  void Set(const Quaterniond& q_WS) {
    q_WS_ = q_WS;
    block_.Set(q_WM_.conjugate() * q_WS);
  }
  void TurnAboutVertical(double angle_rad) {
    Set(Quaterniond(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ())) * q_WS_);
  }

  Block block_;
  ComplementaryParams params_;
  double field_T_;
  Quaterniond q_WM_;
  HeadingVariance heading_;
  Quaterniond q_WS_ = Quaterniond::Identity();
  Vector3d turn_S_rad_ = Vector3d::Zero();    // over the present step
  std::optional<Vector3d> field_S_T_;         // in the frame at its beginning
  Vector3d bias_S_rad_s_ = Vector3d::Zero();  // told at rest
  Vector3d w_S_rad_s_ = Vector3d::Zero();
  bool compass_ = false;
  std::optional<Nis> nis_;
};

}  // namespace piperun::estimator
