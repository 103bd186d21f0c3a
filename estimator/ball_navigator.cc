#include "estimator/ball_navigator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/number.h"
#include "estimator/attitude_ekf.h"

namespace piperun::estimator {
namespace {

constexpr std::array<std::string_view, 2> kPositions{"rolling", "zero_velocity"};
constexpr double kCourseSd_rad = 0.03;   // direction of rolling against the pipe's axis: rocking, slip
constexpr double kCourseMargin_m = 0.5;  // the spin axis lags in and behind a bend
constexpr double kRollIn_m = 1;          // without a map the start heading holds for this long

/// Attitude of the frame that a step's specific force is given in: at its beginning or in its middle.
Quaterniond ForceFrame(const ImuStep& step, const Quaterniond& begin, const Quaterniond& end) {
  if (step.f_at_begin) return begin;
  const double sign = begin.dot(end) < 0 ? -1 : 1;
  return Quaterniond(begin.coeffs() + sign * end.coeffs()).normalized();
}

}  // namespace

void NavigatorParams::Visit(ParamVisitor& v) {
  v.Choice({"position", "Where the position comes from: the ball's rolling, or acceleration between rests."},
           kPositions, position);
  v.Number(
      {"align_s", "If the ball rests for this long after the first sample, its gyro bias is taken from it."},
      Range::Positive(), align_s);
  v.Struct({"rolling", "Rolling odometer."}, rolling);
  v.Struct({"zero_velocity", "Double integration between rests."}, zero_velocity);
  v.Group({"locator", "Leak locator that listens on the filter's track."},
          [this](ParamVisitor& group) { locator.Visit(group); });
}

ChannelNeeds CalcNeeds(const NavigatorParams& params) {
  return {.imu = true, .audio = !params.locator.none()};
}

BallNavigator::BallNavigator(const NavigatorParams& params, const AssumedMotion& assumed,
                             std::unique_ptr<AttitudeFilter> attitude, const EstimatorStart& start)
    : params_(params),
      assumed_(assumed),
      start_(start),
      lever_S_m_(start.X_BS.q.conjugate() * start.X_BS.p),
      course_sd_rad_(std::hypot(start.heading_sd_rad, kCourseSd_rad)),
      attitude_(std::move(attitude)),
      rest_(params.align_s, assumed.gyro_noise_rad_s_sqrtHz, assumed.gyro_bias_sd_rad_s),
      locator_(params.locator.Make(start_)) {
  channels_.fill(-1);
  if (params.position == "rolling") {
    position_ = &odometer_.emplace(params.rolling, start_);
  } else {
    position_ = &inertial_.emplace(params.zero_velocity, start_);
  }
  nav_.p_W = start_.p_W;
  nav_.chainage_m = start_.chainage_m;
  nav_.chainage_sd_m = start_.chainage_sd_m;
  if (start_.map) course_map_.emplace(*start_.map, start_.ball_radius_m);
}

void BallNavigator::Ingest(const Measurement& measurement) {
  int& channel = channels_[measurement.value.index()];
  if (channel < 0) channel = measurement.channel;
  if (channel != measurement.channel) return;
  std::visit([this](const auto& value) { Take(value); }, measurement.value);
}

void BallNavigator::Take(const ImuSample& sample) {
  auto step = stepper_.Step(sample);
  if (!started_) Start(sample);
  if (!step) return;
  const Quaterniond q_WS_before = attitude_->q_WS();
  attitude_->Propagate(*step);
  RemoveLeverArm(*step);
  attitude_->UpdateGravity(*step, MotionAccelerationSd_m_s2());
  if (inertial_ && inertial_->at_rest()) attitude_->UpdateRestRate(step->w_S_rad_s, step->dt_s);
  UpdateNav(sample.stamp, q_WS_before, *step);
  AlignFromRest(*step);
  HeadFromCourse();
  if (locator_) locator_->IngestNav(nav_);
}

void BallNavigator::Start(const ImuSample& sample) {
  attitude_->AlignTilt(sample.f_WS_S_m_s2);
  nav_.stamp = sample.stamp;
  started_ = true;
}

double BallNavigator::MotionAccelerationSd_m_s2() const {
  if (!inertial_) return assumed_.motion_acceleration_sd_m_s2;
  return inertial_->at_rest() ? 0 : params_.zero_velocity.motion_acceleration_sd_m_s2;
}

void BallNavigator::RemoveLeverArm(ImuStep& step) const {
  const Vector3d& w = attitude_->w_S_rad_s();
  step.f_S_m_s2 -= w.cross(w.cross(lever_S_m_)) + (step.dw_S_rad_s / step.dt_s).cross(lever_S_m_);
}

void BallNavigator::AlignFromRest(const ImuStep& step) {
  const auto result = rest_.Step(step.w_S_rad_s, step.dt_s);
  if (!result) return;
  if (result->rested) attitude_->UpdateRestRate(result->w_S_rad_s, result->duration_s);
  if (!magnetic_ && inertial_ && start_.heading_rad) {
    const Vector3d x_W = attitude_->q_WS() * (start_.X_BS.q.conjugate() * Vector3d::UnitX());
    TurnTo(*start_.heading_rad, std::atan2(x_W.y(), x_W.x()), start_.heading_sd_rad);
  }
  nav_.valid = true;
}

std::optional<double> BallNavigator::KnownCourse_rad() {
  const double s_m = odometer_->state().chainage_m;
  if (course_map_) {
    if (!course_map_->StraightAround(s_m, kCourseMargin_m)) return std::nullopt;
    const Vector3d t_W = course_map_->Eval(s_m).tangent_W;
    return std::atan2(t_W.y(), t_W.x());
  }
  return s_m - start_.chainage_m < kRollIn_m ? start_.heading_rad : std::nullopt;
}

void BallNavigator::HeadFromCourse() {
  if (!odometer_) return;
  if (nav_.attitude_covariance_rad2(2, 2) <= course_sd_rad_ * course_sd_rad_) return;
  const auto course_W = odometer_->Course_W();
  if (!course_W) return;
  if (const auto known_rad = KnownCourse_rad()) {
    TurnTo(*known_rad, std::atan2(course_W->y(), course_W->x()), course_sd_rad_);
  }
}

void BallNavigator::TurnTo(double heading_rad, double present_rad, double sd_rad) {
  const Quaterniond before = attitude_->q_WS();
  attitude_->UpdateHeading(WrapAngle(heading_rad - present_rad), sd_rad);
  if (odometer_) odometer_->Turn(attitude_->q_WS() * before.conjugate());
}

void BallNavigator::UpdateNav(RobotTime stamp, const Quaterniond& q_WS_before, const ImuStep& step) {
  const Matrix3d covariance = attitude_->Covariance_W_rad2();
  const Quaterniond& q_WS = attitude_->q_WS();
  AttitudeStep attitude_step;
  attitude_step.dt_s = step.dt_s;
  attitude_step.rotation_W_rad = LogSO3(q_WS * q_WS_before.conjugate());
  attitude_step.f_W_m_s2 = ForceFrame(step, q_WS_before, q_WS) * step.f_S_m_s2;
  attitude_step.f_S_m_s2 = step.f_S_m_s2;
  attitude_step.tilt_variance_rad2 = std::max(covariance(0, 0), covariance(1, 1));
  attitude_step.heading_variance_rad2 = covariance(2, 2);
  position_->Step(attitude_step);

  const PositionState& position = position_->state();
  nav_.stamp = stamp;
  nav_.p_W = position.p_W;
  nav_.v_W_m_s = position.v_W_m_s;
  nav_.chainage_m = position.chainage_m;
  nav_.chainage_sd_m = position.chainage_sd_m;
  UpdateNavAttitude();
}

void BallNavigator::UpdateNavAttitude() {
  nav_.q_WB = attitude_->q_WS() * start_.X_BS.q.conjugate();
  nav_.attitude_covariance_rad2 = attitude_->Covariance_W_rad2();
  nav_.gyro_bias_rad_s = attitude_->gyro_bias_S_rad_s();
  if (const auto& nis = attitude_->nis()) {
    nav_.nis = nis->value;
    nav_.nis_dof = nis->dof;
  }
}

void BallNavigator::Take(const MagSample& sample) {
  if (start_.field_W_T.isZero() || !started_) return;
  if (!sample.m_S_T.allFinite()) {
    throw InputError("the magnetometer sample at " + FormatNumber(Seconds(sample.stamp)) +
                     " s holds a value that is not finite; remove the row");
  }
  // a point sample: turn the attitude, which is as of the last IMU stamp, on to the sample's own
  const Vector3d ahead_S_rad = attitude_->w_S_rad_s() * Seconds(sample.stamp - nav_.stamp);
  if (attitude_->UpdateMagnetic(sample.m_S_T, ahead_S_rad)) magnetic_ = nav_.valid = true;
  UpdateNavAttitude();
}

void BallNavigator::Take(const AudioBlock& block) {
  if (locator_) locator_->IngestAudio(block);
}

std::optional<SmoothedTrack> BallNavigator::Finish() {
  if (locator_) locator_->Finish();
  return std::nullopt;
}

}  // namespace piperun::estimator
