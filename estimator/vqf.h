#pragma once

#include "estimator/attitude_filter.h"
#include "estimator/complementary_attitude.h"
#include "estimator/vqf_bias.h"
#include "estimator/vqf_heading.h"

namespace piperun::estimator {

struct VqfParams {
  VqfBiasParams bias;
  VqfHeadingParams heading;

  void Visit(ParamVisitor& v);
};

/// Filter of the class of VQF (D. Laidig & T. Seel, Information Fusion 91, 187, 2023): three rotations, each
/// with its own job.
///
///     R_WS = R_z(delta) R_EI R_IS
///     R_IS <- R_IS Exp(dtheta_m - b dt)     the gyro alone: I is almost an inertial frame
///     a_I = LP(R_IS f), tau = 3 s           in I gravity is constant, what the body does averages out
///     R_EI <- C R_EI                        C the smallest rotation of R_EI a_I onto the vertical
///     delta, b                              estimator/vqf_heading.h, vqf_bias.h
///
/// Against the publication: low passes are solved exactly for the real time between samples, gains and noise
/// use that time too, and the increments are coning-compensated; the magnetic reference is told. Of itself it
/// knows no covariance: it is what ComplementaryParams say. Range: |w| dt < pi.
class Vqf final : public AttitudeFilter {
 public:
  /// `field_W_T` zero: no magnetic reference.
  Vqf(const VqfParams& params, const ComplementaryParams& assumed, const Vector3d& field_W_T);

  void AlignTilt(const Vector3d& f_S_m_s2) override;
  void Propagate(const ImuStep& step) override;
  void UpdateGravity(const ImuStep& step, double motion_acceleration_sd_m_s2) override;
  bool UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) override;
  void UpdateHeading(double offset_rad, double sd_rad) override;
  void UpdateRestRate(const Vector3d& w_S_rad_s, double duration_s) override;

  const Quaterniond& q_WS() const override { return q_WS_; }
  const Vector3d& gyro_bias_S_rad_s() const override { return bias_.bias_S_rad_s(); }
  Matrix3d Covariance_W_rad2() const override;
  const Vector3d& w_S_rad_s() const override { return w_S_rad_s_; }
  const std::optional<Nis>& nis() const override { return nis_; }

  bool at_rest() const { return rest_.at_rest(); }
  bool disturbed() const { return heading_.disturbed(); }

 private:
  void SetAttitude();

  ComplementaryParams assumed_;
  VqfRest rest_;
  VqfBias bias_;
  VqfHeading heading_;
  HeadingVariance heading_variance_;
  MeanLowPass<3> force_I_;
  Quaterniond q_IS_ = Quaterniond::Identity(), q_IS_force_ = Quaterniond::Identity();
  Quaterniond q_EI_ = Quaterniond::Identity();
  Quaterniond q_WS_ = Quaterniond::Identity();
  Vector3d w_S_rad_s_ = Vector3d::Zero();
  double since_field_s_ = 0;
  std::optional<Nis> nis_;
};

/// Smallest rotation of the unit vector a onto the vertical, of the half angle's sine and cosine.
Quaterniond CalcInclinationCorrection(const Vector3d& a_E);

}  // namespace piperun::estimator
