#include "estimator/vqf.h"

#include <cmath>

#include "estimator/attitude_rate.h"

namespace piperun::estimator {
void VqfParams::Visit(ParamVisitor& v) {
  v.Struct({"bias", "Bias estimation and rest."}, bias);
  v.Struct({"heading", "Heading and magnetic disturbances."}, heading);
}

Quaterniond CalcInclinationCorrection(const Vector3d& a_E) {
  const double w = std::sqrt(0.5 * (a_E.z() + 1));
  if (!(w > 1e-6)) return {0, 1, 0, 0};  // upside down: half a turn about any horizontal axis
  return Quaterniond(w, 0.5 * a_E.y() / w, -0.5 * a_E.x() / w, 0).normalized();
}

Vqf::Vqf(const VqfParams& params, const ComplementaryParams& assumed, const Vector3d& field_W_T)
    : assumed_(assumed),
      rest_(params.bias),
      bias_(params.bias),
      heading_(params.heading, field_W_T.isZero(0) ? Vector3d(Vector3d::UnitX()) : field_W_T),
      heading_variance_(assumed),
      force_I_(kVqfInclination_s) {}

void Vqf::AlignTilt(const Vector3d& f_S_m_s2) {
  q_EI_ = CalcTilt(f_S_m_s2);
  SetAttitude();
}

void Vqf::Propagate(const ImuStep& step) {
  const Vector3d turn_S_rad = step.dtheta_S_rad - bias_.bias_S_rad_s() * step.dt_s;
  const Quaterniond half = ExpSO3(0.5 * turn_S_rad);
  w_S_rad_s_ = turn_S_rad / step.dt_s;
  q_IS_force_ = step.f_at_begin ? q_IS_ : q_IS_ * half;
  q_IS_ = (q_IS_ * half * half).normalized();
  since_field_s_ += step.dt_s;
  heading_variance_.Propagate(step.dt_s);
  SetAttitude();
}

void Vqf::UpdateGravity(const ImuStep& step, double) {
  if (step.AccelerometerClipped()) return;
  rest_.Step(step);
  const Vector3d a_E = Direction(q_EI_ * force_I_.Step(q_IS_force_ * step.f_S_m_s2, step.dt_s));
  if (a_E.isZero(0)) return;
  q_EI_ = (CalcInclinationCorrection(a_E) * q_EI_).normalized();
  SetAttitude();
  const auto rest_w_S_rad_s = rest_.at_rest() ? std::optional(rest_.w_S_rad_s()) : std::nullopt;
  bias_.Step(a_E, (q_EI_ * q_IS_).toRotationMatrix(), rest_w_S_rad_s, step.dt_s);
}

bool Vqf::UpdateMagnetic(const Vector3d& m_S_T, const Vector3d& ahead_S_rad) {
  if (!(since_field_s_ > 0)) return false;
  const Vector3d m_E_T = q_EI_ * (q_IS_ * (ExpSO3(ahead_S_rad) * m_S_T));
  const bool believed = heading_.Step(m_E_T, rest_.w_S_rad_s().norm(), since_field_s_);
  since_field_s_ = 0;
  if (believed) heading_variance_.HeadByCompass();
  SetAttitude();
  return believed;
}

void Vqf::UpdateHeading(double offset_rad, double sd_rad) {
  heading_.Turn(heading_variance_.Update(sd_rad) * offset_rad);
  SetAttitude();
}

void Vqf::UpdateRestRate(const Vector3d& w_S_rad_s, double duration_s) {
  bias_.Measure(w_S_rad_s, assumed_.gyro_noise_rad_s_sqrtHz * assumed_.gyro_noise_rad_s_sqrtHz / duration_s);
}

Matrix3d Vqf::Covariance_W_rad2() const {
  const double tilt_rad2 = assumed_.tilt_sd_rad * assumed_.tilt_sd_rad;
  return Vector3d(tilt_rad2, tilt_rad2, heading_variance_.rad2()).asDiagonal();
}

void Vqf::SetAttitude() {
  q_WS_ = Quaterniond(Eigen::AngleAxisd(heading_.delta_rad(), Vector3d::UnitZ())) * q_EI_ * q_IS_;
}

}  // namespace piperun::estimator
