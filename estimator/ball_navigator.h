#pragma once

#include <array>
#include <memory>
#include <optional>
#include <variant>

#include "estimator/attitude_filter.h"
#include "estimator/filter_kind.h"
#include "estimator/locator_choice.h"
#include "estimator/rest_alignment.h"
#include "estimator/rolling_odometer.h"
#include "estimator/zero_velocity.h"

namespace piperun::estimator {

/// Where the position comes from, and who listens: what all attitude filters are combined with alike.
struct NavigatorParams {
  std::string position = "rolling";
  double align_s = 0.5;
  RollingParams rolling;
  ZeroVelocityParams zero_velocity;
  LocatorChoice locator;

  void Visit(ParamVisitor& v);
};

/// What is assumed of the gyro at rest and of the ball's own acceleration.
struct AssumedMotion {
  double gyro_noise_rad_s_sqrtHz = 1.75e-4;
  double gyro_bias_sd_rad_s = 2e-3;
  double motion_acceleration_sd_m_s2 = 0.05;
};

/// An estimator made of three parts: an attitude filter, a position from it, and a leak locator beside it.
///
/// Alignment: tilt from the first specific force, heading from the first magnetometer sample; the filter runs
/// from there with a covariance that says how little it knows. If the ball rested for `align_s`, the gyro
/// bias is taken from that time. Where the magnetometer is missing or not believed, and the heading has
/// become uncertain, it comes from the motion: for a rolling ball, its direction of rolling must be the map's
/// tangent (on straights) or, without a map, the start heading during the first metre; for a carried sensor,
/// its x axis points along the start heading. One IMU, one magnetometer and one hydrophone are listened to:
/// the first channel of each that speaks.
class BallNavigator final : public Estimator {
 public:
  /// `attitude` has not been aligned yet.
  BallNavigator(const NavigatorParams& params, const AssumedMotion& assumed,
                std::unique_ptr<AttitudeFilter> attitude, const EstimatorStart& start);

  void Ingest(const Measurement& measurement) override;
  const NavState& nav() const override { return nav_; }
  const std::vector<LeakEstimate>& leaks() const override { return locator_ ? locator_->leaks() : no_leaks_; }
  std::optional<SmoothedTrack> Finish() override;

 private:
  void Take(const ImuSample& sample);
  void Take(const MagSample& sample);
  void Take(const PressureSample&) {}
  void Take(const TemperatureSample&) {}
  void Take(const MarkerPass&) {}
  void Take(const AudioBlock& block);

  void Start(const ImuSample& sample);
  double MotionAccelerationSd_m_s2() const;
  void RemoveLeverArm(ImuStep& step) const;
  void AlignFromRest(const ImuStep& step);
  void HeadFromCourse();
  std::optional<double> KnownCourse_rad();
  void TurnTo(double heading_rad, double present_rad, double sd_rad);
  void UpdateNav(RobotTime stamp, const Quaterniond& q_WS_before, const ImuStep& step);
  void UpdateNavAttitude();

  NavigatorParams params_;
  AssumedMotion assumed_;
  EstimatorStart start_;
  Vector3d lever_S_m_;
  double course_sd_rad_;
  ImuStepper stepper_;
  std::unique_ptr<AttitudeFilter> attitude_;
  RestAlignment rest_;
  std::optional<RollingOdometer> odometer_;
  std::optional<ZeroVelocityNavigator> inertial_;
  PositionFilter* position_;
  std::optional<InvertTrack> course_map_;
  std::unique_ptr<LeakLocator> locator_;
  /// Listened to, by index in the variant; -1: none yet.
  std::array<int, std::variant_size_v<decltype(Measurement::value)>> channels_;
  bool magnetic_ = false;  // the heading has come from the magnetometer
  bool started_ = false;
  NavState nav_;
  std::vector<LeakEstimate> no_leaks_;
};

/// Channels that a navigator with these parameters cannot do without.
ChannelNeeds CalcNeeds(const NavigatorParams& params);

}  // namespace piperun::estimator
