#pragma once

#include <optional>
#include <vector>

#include "base/params.h"
#include "base/route.h"
#include "sim/script.h"
#include "sim/waypoint_script.h"

namespace piperun::sim {

struct WalkParams {
  double speed_m_s = 1;
  double acceleration_time_s = 1;
  std::optional<double> leg_length_m = 10;
  double stop_s = 2;
  double rest_s = 2;
  double turn_time_s = 1;
  double height_m = 1;
  double wobble_m = 0;
  double wobble_rad = 0;
  double wobble_Hz = 2;

  void Visit(ParamVisitor& v);
};

/// A device carried by hand along a route, at a constant height above its axis, in legs of equal length with
/// a stop after each. Along the route it follows SpeedProfile in every leg; its yaw is that of the chord of
/// the route from half a turn time behind to half a turn time ahead (at walking speed), so it stands still
/// when the walker does. While walking the hand may wobble, in proportion to the speed: up and down and in
/// pitch at `wobble_Hz`, in roll at half of it (one stride is two steps).
///
/// Where a route goes from straight to bend its curvature jumps; a C2 motion cannot follow it exactly. This
/// one is the WaypointScript through poses at most 0.05 s apart (a twenty-fourth of a wobble), within about
/// v^2 dt^2 / (50 R) of the route (0.1 mm at 1 m/s, R = 0.5 m) and to rounding on the straights.
class WalkScript final : public Script {
 public:
  /// Throws InputError (keys walk...) when a leg is too short for the acceleration or the route is vertical.
  WalkScript(const WalkParams& params, const Route& route);

  double duration_s() const override { return track_.duration_s(); }
  ScriptPoint Eval(double t_s) const override { return track_.Eval(t_s); }
  const std::vector<double>& knots_s() const override { return track_.knots_s(); }
  Vector3d route_offset_W() const override { return {0, 0, height_m_}; }

 private:
  double height_m_;
  WaypointScript track_;
};

}  // namespace piperun::sim
