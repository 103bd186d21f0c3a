#pragma once

#include "base/pose.h"

namespace piperun::estimator {

/// What the attitude filter says about one inertial interval.
struct AttitudeStep {
  double dt_s = 0;
  Vector3d rotation_W_rad = Vector3d::Zero();  ///< Log(R_k R_(k-1)^T), both corrected by all measurements
  Vector3d f_W_m_s2 = Vector3d::Zero();        ///< mean specific force of the ball's centre
  Vector3d f_S_m_s2 = Vector3d::Zero();        ///< the same in the sensor frame
  double tilt_variance_rad2 = 0;               ///< larger of the two
  double heading_variance_rad2 = 0;
};

struct PositionState {
  Vector3d p_W = Vector3d::Zero();
  Vector3d v_W_m_s = Vector3d::Zero();
  double chainage_m = 0;
  double chainage_sd_m = 0;
};

/// Turns the attitude's history into a position.
class PositionFilter {
 public:
  virtual ~PositionFilter() = default;
  virtual void Step(const AttitudeStep& step) = 0;
  virtual const PositionState& state() const = 0;
};

}  // namespace piperun::estimator
