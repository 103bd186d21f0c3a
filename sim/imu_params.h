#pragma once

#include "base/params.h"
#include "sim/imu_error_params.h"
#include "sim/imu_sampling.h"
#include "sim/sensor.h"
#include "sim/thermal.h"

namespace piperun::sim {

/// Parameters of an inertial sensor. The defaults are those of an ideal one.
struct ImuParams : ParamsOf<ImuParams> {
  double rate_Hz = 400;
  std::string output = "mean";
  bool increments = false;
  bool coning_sculling = true;
  Vector3d lever_arm_m = Vector3d::Zero();
  Matrix3d accel_positions_m = Matrix3d::Zero();  ///< rows: of the x-, y- and z-accelerometer, in S
  Vector3d mounting_rad = Vector3d::Zero();
  Vector3d mounting_error_rad = Vector3d::Zero();
  double mounting_error_sd_rad = 0;
  SamplingParams sampling;
  ThermalParams thermal;
  double reference_C = 25;
  TriadErrorParams gyro;
  TriadErrorParams accel;

  void Visit(ParamVisitor& v) override;
  /// Throws InputError for what contradicts itself or the context.
  void Check(const SensorContext& context) const;
  bool filtered() const { return gyro.filter.on() || accel.filter.on(); }
  bool point() const { return output == "point"; }
};

}  // namespace piperun::sim
