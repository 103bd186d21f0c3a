#pragma once

#include <vector>

#include "base/params.h"
#include "sim/cubic_spline.h"
#include "sim/script.h"

namespace piperun::sim {

struct WaypointParams {
  std::vector<double> poses_s_m_rad;  ///< rows of t, x, y, z, yaw, pitch, roll

  void Visit(ParamVisitor& v);
};

/// Timed poses joined by C2 cubic splines, one through the positions and one through the angles (see
/// CubicSpline for stops): R_WB = Rz(yaw) Ry(pitch) Rx(roll). Angles are taken as written and never
/// unwrapped: from 350 to 370 degrees is a turn by 20, from 350 to 10 one back by 340. Every angle is
/// allowed; but near a pitch of 90 degrees a change of yaw turns about the same axis as one of roll.
class WaypointScript final : public Script {
 public:
  /// Throws InputError (key waypoints.poses_s_m_rad) when there are fewer than two rows, the first time is
  /// not zero, or times do not increase.
  explicit WaypointScript(const WaypointParams& params);
  /// The same from points in code: angles are yaw, pitch, roll.
  WaypointScript(const std::vector<double>& times_s, const std::vector<Vector3d>& positions_m,
                 const std::vector<Vector3d>& angles_rad);

  double duration_s() const override { return duration_s_; }
  ScriptPoint Eval(double t_s) const override;
  const std::vector<double>& knots_s() const override { return knots_s_; }

 private:
  double duration_s_;
  CubicSpline position_;
  CubicSpline angles_;
  std::vector<double> knots_s_;
};

}  // namespace piperun::sim
