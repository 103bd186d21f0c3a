#include "estimator/vqf_bias.h"

#include <Eigen/LU>

namespace piperun::estimator {
namespace {

constexpr double kWalkSd_rad_s = 0.1 * 0.017453292519943295;  // gathered over the forgetting time

double Squared(double x) { return x * x; }

Vector3d Within(const Vector3d& v, double limit) { return v.cwiseMax(-limit).cwiseMin(limit); }

}  // namespace

void VqfBiasParams::Visit(ParamVisitor& v) {
  v.Number({"start_sd_rad_s", "Assumed turn-on bias, one sigma."}, Range::Positive(), start_sd_rad_s);
  v.Number({"limit_rad_s", "No bias is believed to be larger."}, Range::Positive(), limit_rad_s);
  v.Number({"forgetting_s", "Time over which the bias may walk by 0.1 deg/s."}, Range::Positive(),
           forgetting_s);
  v.Number({"motion_sd_rad_s", "What the bias' deviation settles at in motion."}, Range::Positive(),
           motion_sd_rad_s);
  v.Number({"vertical_factor", "How much less than motion is believed that the vertical bias is zero."},
           Range::Positive(), vertical_factor);
  v.Number({"rest_sd_rad_s", "What the bias' deviation settles at in rest."}, Range::Positive(),
           rest_sd_rad_s);
  v.Number({"rest_s", "Stillness of this length is rest."}, Range::Positive(), rest_s);
  v.Number({"rest_filter_s", "Time constant of the readings that stillness is measured against."},
           Range::Positive(), rest_filter_s);
  v.Number({"rest_rate_rad_s", "Largest distance of a still gyro's reading."}, Range::Positive(),
           rest_rate_rad_s);
  v.Number({"rest_acceleration_m_s2", "Largest distance of a still accelerometer's reading."},
           Range::Positive(), rest_acceleration_m_s2);
}

void VqfRest::Step(const ImuStep& step) {
  const Vector3d& w = w_S_.Step(step.w_S_rad_s, step.dt_s);
  const Vector3d& f = f_S_.Step(step.f_S_m_s2, step.dt_s);
  const bool still = (step.w_S_rad_s - w).squaredNorm() < Squared(params_.rest_rate_rad_s) &&
                     w.cwiseAbs().maxCoeff() <= params_.limit_rad_s &&
                     (step.f_S_m_s2 - f).squaredNorm() < Squared(params_.rest_acceleration_m_s2);
  still_s_ = still ? still_s_ + step.dt_s : 0;
}

VqfBias::VqfBias(const VqfBiasParams& params)
    : params_(params),
      walk_rad2_s3_(Squared(kWalkSd_rad_s) / params.forgetting_s),
      low_pass_(kVqfInclination_s),
      P_(Squared(params.start_sd_rad_s) * Matrix3d::Identity()) {}

void VqfBias::Grow(double dt_s) {
  const double most = Squared(params_.start_sd_rad_s);
  for (int i = 0; i < 3; ++i) {
    if (P_(i, i) < most) P_(i, i) += walk_rad2_s3_ * dt_s;
  }
}

void VqfBias::Filter(const Matrix3d& R_ES, double dt_s) {
  Eigen::Matrix<double, 11, 1> u;
  u << R_ES.reshaped(), (R_ES * b_).head<2>();
  low_pass_.Step(u, dt_s);
}

double VqfBias::CalcWeight(double sd_rad_s, double dt_s) const {
  const double p = Squared(sd_rad_s);
  return p * p / (walk_rad2_s3_ * dt_s) + p;
}

void VqfBias::Step(const Vector3d& a_E, const Matrix3d& R_ES, const std::optional<Vector3d>& rest_w_S_rad_s,
                   double dt_s) {
  Filter(R_ES, dt_s);
  Grow(dt_s);
  if (rest_w_S_rad_s) {
    Measure(*rest_w_S_rad_s, CalcWeight(params_.rest_sd_rad_s, dt_s));
  } else {
    StepInMotion(a_E, dt_s);
  }
}

void VqfBias::StepInMotion(const Vector3d& a_E, double dt_s) {
  const auto& filtered = low_pass_.value();
  const Matrix3d C = filtered.head<9>().reshaped(3, 3);
  Vector3d e = -(C * b_);
  e.x() += filtered[9] - a_E.y() / dt_s;
  e.y() += filtered[10] + a_E.x() / dt_s;
  const double W = CalcWeight(params_.motion_sd_rad_s, dt_s);
  Update(e, C, {W, W, W / params_.vertical_factor});
}

void VqfBias::Measure(const Vector3d& bias_rad_s, double variance) {
  Update(bias_rad_s - b_, Matrix3d::Identity(), Vector3d::Constant(variance));
}

void VqfBias::Update(Vector3d e, const Matrix3d& C, const Vector3d& W) {
  e = Within(e, params_.limit_rad_s);
  const Matrix3d PCt = P_ * C.transpose();
  Matrix3d S = C * PCt;
  S.diagonal() += W;
  const Matrix3d K = PCt * S.inverse();
  b_ = Within(b_ + K * e, params_.limit_rad_s);
  const Matrix3d KPCt = K * PCt.transpose();
  P_ -= 0.5 * (KPCt + KPCt.transpose());
}

}  // namespace piperun::estimator
