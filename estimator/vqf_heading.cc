#include "estimator/vqf_heading.h"

#include <algorithm>
#include <cmath>

#include "estimator/attitude_ekf.h"

namespace piperun::estimator {

void VqfHeadingParams::Visit(ParamVisitor& v) {
  v.Number({"heading_s", "Time constant of the heading's correction by the field."}, Range::Positive(),
           heading_s);
  v.Number({"current_s", "Time constant of the field's magnitude and dip."}, Range::Positive(), current_s);
  v.Number({"reference_s", "Time constant at which the reference follows an undisturbed field."},
           Range::Positive(), reference_s);
  v.Number({"norm_tolerance", "A magnitude off by more than this fraction is a disturbance."},
           Range::Positive(), norm_tolerance);
  v.Number({"dip_tolerance_rad", "So is a dip off by more than this angle."}, Range::Positive(),
           dip_tolerance_rad);
  v.Number({"new_field_s", "A field that stays for this long becomes the reference."}, Range::Positive(),
           new_field_s);
  v.Number({"new_field_rate_rad_s", "It must be seen from a sensor turning at least this fast."},
           Range::NonNegative(), new_field_rate_rad_s);
  v.Number({"undisturbed_s", "A disturbance is over when the reference has been met for this long."},
           Range::NonNegative(), undisturbed_s);
  v.Number({"rejection_s", "A disturbed field is left out for no longer than this."}, Range::NonNegative(),
           rejection_s);
  v.Number({"rejection_factor", "How much slower a disturbed field is followed after that."},
           Range::Between(1, 100), rejection_factor);
}

VqfHeading::VqfHeading(const VqfHeadingParams& params, const Vector3d& field_W_T)
    : params_(params),
      psi_reference_rad_(std::atan2(field_W_T.y(), field_W_T.x())),
      reference_{field_W_T.norm(), -std::asin(field_W_T.z() / field_W_T.norm())},
      current_(params.current_s) {}

bool VqfHeading::Agrees(const Field& field, const Field& with) const {
  return std::abs(field.norm_T - with.norm_T) < params_.norm_tolerance * with.norm_T &&
         std::abs(field.dip_rad - with.dip_rad) < params_.dip_tolerance_rad;
}

void VqfHeading::Judge(const Field& field, double dt_s) {
  if (!Agrees(field, reference_)) {
    undisturbed_s_ = 0;
    disturbed_ = true;
    return;
  }
  undisturbed_s_ += dt_s;
  if (undisturbed_s_ < params_.undisturbed_s) return;
  const double k = 1 - std::exp(-dt_s / params_.reference_s);
  disturbed_ = false;
  reference_.norm_T += k * (field.norm_T - reference_.norm_T);
  reference_.dip_rad += k * (field.dip_rad - reference_.dip_rad);
}

void VqfHeading::ConsiderAsNew(const Field& field, double w_rad_s, double dt_s) {
  if (!Agrees(field, candidate_)) {
    candidate_s_ = 0;
    candidate_ = field;
    return;
  }
  const double k = 1 - std::exp(-dt_s / params_.reference_s);
  if (w_rad_s >= params_.new_field_rate_rad_s) candidate_s_ += dt_s;
  candidate_.norm_T += k * (field.norm_T - candidate_.norm_T);
  candidate_.dip_rad += k * (field.dip_rad - candidate_.dip_rad);
  if (!disturbed_ || candidate_s_ < params_.new_field_s) return;
  reference_ = candidate_;
  disturbed_ = false;
  undisturbed_s_ = params_.undisturbed_s;
}

double VqfHeading::CalcGain(double dt_s) {
  double k = 1 - std::exp(-dt_s / params_.heading_s);
  if (disturbed_ && rejected_s_ <= params_.rejection_s) {
    rejected_s_ += dt_s;
    return 0;
  }
  if (disturbed_) {
    k /= params_.rejection_factor;
  } else {
    rejected_s_ = std::max(rejected_s_ - params_.rejection_factor * dt_s, 0.0);
  }
  if (first_gain_ == 0) return k;
  k = std::max(k, first_gain_);
  first_gain_ /= 1 + first_gain_;
  if (first_gain_ * params_.heading_s < dt_s) first_gain_ = 0;
  return k;
}

bool VqfHeading::Step(const Vector3d& m_E_T, double w_rad_s, double dt_s) {
  const double norm_T = m_E_T.norm();
  if (!(norm_T > 0)) return false;
  const Eigen::Vector2d now = current_.Step({norm_T, -std::asin(m_E_T.z() / norm_T)}, dt_s);
  Judge({now[0], now[1]}, dt_s);
  ConsiderAsNew({now[0], now[1]}, w_rad_s, dt_s);
  const double k = CalcGain(dt_s);
  Turn(k * WrapAngle(psi_reference_rad_ - std::atan2(m_E_T.y(), m_E_T.x()) - delta_rad_));
  return k > 0;
}

void VqfHeading::Turn(double offset_rad) { delta_rad_ = WrapAngle(delta_rad_ + offset_rad); }

}  // namespace piperun::estimator
