#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/measurement.h"
#include "base/network.h"
#include "base/params.h"
#include "base/random.h"
#include "sim/pipe_magnetism.h"
#include "sim/truth.h"

namespace piperun::sim {

struct SensorContext {
  RandomStream random;  ///< the channel's own stream
  ClockModel clock;
  Vector3d gravity_W{0, 0, -9.80665};
  Rate truth_rate{1000};
  double water_temperature_C = 10;
  double water_density_kg_m3 = 999.7;
  /// The pipes, and the joints of their sticks as far as they are described. The caller's, and alive as long
  /// as the sensor; null: no pipes.
  const Network* network = nullptr;
  std::span<const StickJoint> joints{};
  /// For what sensors share (the field in a pipe) and draw under a name of its own.
  std::uint64_t seed = 0;
  std::uint64_t run = 0;
};

/// What an IMU's slowly varying errors add up to now; EuRoC ground truth carries it beside the pose.
struct ImuBias {
  Vector3d gyro_rad_s = Vector3d::Zero();
  Vector3d accel_m_s2 = Vector3d::Zero();
};

/// In place of a sample that was taken but never arrived.
struct LostSample {};

using SensorValue = std::variant<ImuSample, MagSample, PressureSample, TemperatureSample, LostSample>;

/// One measuring channel of the ball. Sample k is a pure function of (parameters, stream, truth up to its due
/// time plus one physics step) and of the samples before it.
class Sensor {
 public:
  virtual ~Sensor() = default;
  virtual Rate rate() const = 0;
  /// True time at which sample k (0, 1, ...) is complete and stamped. Interval sensors: SampleTime(k + 1);
  /// point sensors: SampleTime(k); both beside it where sampling scatters.
  virtual TrueTime DueTime(std::int64_t k) const = 0;
  /// How far before and behind DueTime(k) the truth of sample k may lie.
  virtual Duration history() const { return SampleOffset(1, rate()); }
  virtual Duration lookahead() const { return Duration(0); }
  /// Called once per k, in order, when the window reaches at least one step past DueTime(k) + lookahead().
  virtual SensorValue Sample(std::int64_t k, const TruthWindow& window) = 0;
  /// What is only read out after the run, by stamps; called once, behind the last Sample().
  virtual std::vector<MarkerPass> ReadOut(const TruthWindow&) { return {}; }
  /// Pose of the sensor frame in the ball.
  virtual Pose X_BS() const = 0;
  /// True additive bias at the last sample; inertial sensors, and only they, have one.
  virtual std::optional<ImuBias> bias() const { return std::nullopt; }
};

struct SensorKind {
  std::string_view name;
  std::string_view doc;
  /// What its samples are: "imu", "magnetometer", "pressure", "temperature" or "marker".
  std::string_view records;
  std::unique_ptr<Params> (*make_params)();
  std::unique_ptr<Sensor> (*make)(const Params& params, const SensorContext& context);
};

/// Generated from sim/sensors/*.cc.
const std::vector<SensorKind>& SensorKinds();

}  // namespace piperun::sim
