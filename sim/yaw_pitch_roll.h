#pragma once

#include "base/pose.h"

namespace piperun::sim {

/// Attitude from yaw, pitch, roll (in this order, rad): R_WB = Rz(yaw) Ry(pitch) Rx(roll). All angles
/// allowed.
Quaterniond CalcAttitude(const Vector3d& yaw_pitch_roll_rad);

/// Angular velocity w_WB_B (rad/s) from the angles and their rates. All angles allowed.
Vector3d CalcBodyRate(const Vector3d& yaw_pitch_roll_rad, const Vector3d& yaw_pitch_roll_rates_rad_s);

}  // namespace piperun::sim
