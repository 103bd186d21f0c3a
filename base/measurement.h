#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "base/pose.h"
#include "base/time.h"

namespace piperun {

/// Increments over one IMU interval, for the mechanisation v += R dv + g dt; p += v dt; R = R Exp(dtheta).
struct ImuIncrements {
  Vector3d dtheta_S_rad = Vector3d::Zero();
  Vector3d dv_S_m_s = Vector3d::Zero();
};

/// What an inertial sensor's status register says of a sample.
struct ImuFlags {
  /// One bit per axis that met the end of its range since the last sample: gyroscope x, y, z, then
  /// accelerometer x, y, z from the lowest bit.
  std::uint8_t saturated = 0;
  bool duplicated = false;  ///< the values are those of the last sample
  bool any() const { return saturated != 0 || duplicated; }
  friend bool operator==(const ImuFlags&, const ImuFlags&) = default;
};

/// Inertial sample, stamped at the end of its interval (t - 1/rate, t]; rates are means over the interval.
struct ImuSample {
  RobotTime stamp{};
  Vector3d w_WS_S_rad_s = Vector3d::Zero();  ///< angular rate of S in W, in S
  Vector3d f_WS_S_m_s2 = Vector3d::Zero();   ///< specific force (acceleration minus gravity), in S
  std::optional<ImuIncrements> increments{};
  ImuFlags flags{};
};

/// Magnetic flux density at an instant.
struct MagSample {
  RobotTime stamp{};
  Vector3d m_S_T = Vector3d::Zero();
};

/// Absolute-minus-atmospheric (gauge) pressure at an instant.
struct PressureSample {
  RobotTime stamp{};
  double pressure_Pa = 0;
};

/// Temperature of the sensor at an instant.
struct TemperatureSample {
  RobotTime stamp{};
  double temperature_C = 0;
};

/// A pass of the ball below a receiver above ground, from the log that the crew reads out after the run.
struct MarkerPass {
  RobotTime stamp{};                ///< by the receiver's clock, compared with the ball's when it was put in
  int receiver = 0;                 ///< by the order in which they were set up
  Vector3d p_W = Vector3d::Zero();  ///< of the receiver, as surveyed
};

/// A run of hydrophone samples, stamped at the last one. The pressure is counts * scale_Pa.
struct AudioBlock {
  RobotTime stamp{};
  double rate_Hz = 0;
  double scale_Pa = 0;  ///< pascals per count
  std::span<const std::int32_t> counts{};
};

/// One measurement of one channel. `channel` indexes the run's channels in name order; an audio block's
/// counts are only valid while the measurement is being handed over.
struct Measurement {
  int channel = 0;
  std::variant<ImuSample, MagSample, PressureSample, TemperatureSample, MarkerPass, AudioBlock> value;
};

/// True of what is only known after the run. It comes behind everything else, its stamps going back.
inline bool IsReadOutLater(const Measurement& m) { return std::holds_alternative<MarkerPass>(m.value); }

inline RobotTime Stamp(const Measurement& m) {
  return std::visit([](const auto& v) { return v.stamp; }, m.value);
}

}  // namespace piperun
