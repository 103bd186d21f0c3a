#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/measurement.h"
#include "base/network.h"
#include "base/route.h"
#include "estimator/fitting.h"

namespace piperun::estimator {

/// The pipeline as the crew's drawings show it. It may be wrong; it is not the truth's network.
struct RouteMap {
  Network network;
  Route route;
  std::vector<Fitting> fittings{};  ///< pumps, valves, services; tees are seen in the network
};

/// All an estimator is told before the first measurement. Never leaks, never truth.
struct EstimatorStart {
  std::optional<RouteMap> map;
  double chainage_m = 0;
  double chainage_sd_m = 0.01;
  Vector3d p_W = Vector3d::Zero();  ///< launch position of the ball's centre
  std::optional<double>
      heading_rad;  ///< direction of travel, from x (east) towards y (north); nothing: unknown
  double heading_sd_rad = 0.02;
  double ball_radius_m = 0.03;
  double ball_radius_sd_m = 0;
  double gravity_m_s2 = 9.80665;
  Vector3d field_W_T = Vector3d::Zero();  ///< magnetic reference; zero: none
  Pose X_BS;                              ///< mounting of the IMU as the designer drew it
};

/// Where the filter believes the ball to be, causal. Standard deviations are the filter's own.
struct NavState {
  RobotTime stamp{};
  bool valid = false;  ///< false until the filter has aligned
  Quaterniond q_WB = Quaterniond::Identity();
  Vector3d p_W = Vector3d::Zero();
  Vector3d v_W_m_s = Vector3d::Zero();
  Vector3d gyro_bias_rad_s = Vector3d::Zero();
  double chainage_m = 0;
  double chainage_sd_m = 0;
  Matrix3d attitude_covariance_rad2 = Matrix3d::Zero();  ///< of the error rotation in W
  std::optional<double> nis;  ///< normalised innovation squared of the last vector update
  int nis_dof = 0;
};

/// From one chainage to another.
struct ChainageInterval {
  double low_m = 0, high_m = 0;
  bool Holds(double chainage_m) const { return low_m <= chainage_m && chainage_m <= high_m; }
};

/// The middle 95 % of a normal distribution.
inline ChainageInterval CalcNormalInterval(double mean_m, double sigma_m) {
  constexpr double kQuantile975 = 1.959963984540054;
  return {mean_m - kQuantile975 * sigma_m, mean_m + kQuantile975 * sigma_m};
}

struct LeakEstimate {
  RobotTime t_cpa{};  ///< closest point of approach
  double chainage_m = 0;
  double sigma_m = 0;           ///< of the sound's place on the track and of the track
  ChainageInterval interval{};  ///< holds the leak with a probability of 95 %
  Vector3d p_W = Vector3d::Zero();
  std::optional<double> flow_m3_s;
  double flow_sigma_dB = 0;         ///< standard deviation of 20 lg flow, calibration included
  double confidence = 0;            ///< 0 to 1
  std::optional<std::string> at{};  ///< the map's fitting that may make this noise: "valve V1"
};

/// What Finish() may add: the track again, using all measurements.
struct SmoothedTrack {
  std::vector<NavState> states;
};

/// A filter as the robot runs it. Fed in the loop or from a log, the same measurements give the same bits.
class Estimator {
 public:
  virtual ~Estimator() = default;
  /// Measurements arrive in the order (stamp, channel name, row); those that are read out after the run
  /// (IsReadOutLater) in that order behind all others. nav() is no longer asked for then.
  virtual void Ingest(const Measurement& measurement) = 0;
  virtual const NavState& nav() const = 0;
  /// Leaks found so far, in order of t_cpa.
  virtual const std::vector<LeakEstimate>& leaks() const = 0;
  /// Called once after the last measurement: completes leaks(), may return a smoothed track.
  virtual std::optional<SmoothedTrack> Finish() = 0;
};

}  // namespace piperun::estimator
