#pragma once

#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "scenarios/assemble.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// One pipe of the planned way.
struct MapLeg {
  std::string pipe;
  bool reversed = false;
  void Visit(ParamVisitor& v);
};

/// The drawings that the crew has: the pipes of the planned way and those that meet them.
struct MapParams {
  NetworkParams network;
  std::vector<MapLeg> way;
  GeoOrigin origin;
  void Visit(ParamVisitor& v);
};

/// EstimatorStart as it stands in a file.
struct ToldParams {
  bool map = true;
  double chainage_m = 0;
  double chainage_sd_m = 0;
  Vector3d p_W = Vector3d::Zero();
  std::optional<double> heading_rad;
  double heading_sd_rad = 0;
  double ball_radius_m = 0.03;
  double ball_radius_sd_m = 0;
  double gravity_m_s2 = 0;
  Vector3d field_W_T = Vector3d::Zero();
  Vector3d p_BS_m = Vector3d::Zero();
  double q_BS[4] = {1, 0, 0, 0};  ///< w x y z
  void Visit(ParamVisitor& v);
};

struct ToldEstimator {
  std::string name;
  KindEntry kind{FilterOptions, "quaternion_ekf"};
  ToldParams start;
  void Visit(ParamVisitor& v);
};

struct RecordedChannel {
  std::string name;
  std::string type;  ///< imu, magnetometer, pressure, audio
  void Visit(ParamVisitor& v);
};

/// Everything estimators are told, in the loop and in a replay: estimator_input.yaml. No leaks, no truth.
struct EstimatorInput {
  std::string schema = "piperun.estimator_input/1";
  double track_rate_Hz = 20;
  std::vector<RecordedChannel> channels;  ///< sorted by name
  MapParams map;
  std::vector<ToldEstimator> estimators;
  void Visit(ParamVisitor& v);
};

/// What the scenario's crew would write down. Throws InputError where a heading or map is asked for that is
/// not there.
EstimatorInput MakeEstimatorInput(const Scenario& scenario, const Assembly& assembly);
EstimatorInput LoadEstimatorInput(const std::string& path);

std::unique_ptr<estimator::Estimator> MakeEstimator(const EstimatorInput& input, const ToldEstimator& told);

}  // namespace piperun::scenarios
