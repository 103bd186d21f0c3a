#pragma once

#include "base/water.h"
#include "sim/flow_timeline.h"
#include "sim/pipe_flow.h"
#include "sim/route_spot.h"

namespace piperun::sim {

/// Mean (not turbulent) flow as a ball sees it: averages over its frontal disc, in W.
struct WaterAtBall {
  Vector3d velocity_W = Vector3d::Zero();
  Vector3d acceleration_W = Vector3d::Zero();        ///< Du/Dt along the water's path
  Vector3d spin_W = Vector3d::Zero();                ///< 1/2 curl u
  Vector3d pressure_fall_W_Pa_m = Vector3d::Zero();  ///< -grad p that friction costs, along the flow
  double bulk_speed_m_s = 0;                         ///< Q/A, positive along the route
  double pressure_Pa = 0;                            ///< gauge, static, at the ball's centre
};

/// The flow along a route around a ball of one size:
///
///   u      = U uhat(offset) k t,      k = 1/(1 - d . kappa)   (d: from the axis to the ball's centre)
///   Du/Dt  = |u|^2 k kappa            centripetal, towards the bend's centre
///   curl u = grad u x t,              grad u the mean gradient over the disc
///   -dp/ds = f/D rho U^2/2            friction (Darcy-Weisbach)
///   p      = rho g (head - z)
///
/// uhat: profile of sim/pipe_flow.h. k makes the flow in a bend a free vortex (u ~ 1/r about the bend's
/// axis); it is 1 on a straight, and keeps the flow rate within (R/R_c)^2/4. Curvature and k begin at once
/// with the bend, where a real flow takes about a diameter. Left out: secondary flow, turbulence, unsteady
/// acceleration.
class FlowField {
 public:
  /// References are kept. The ball must fit the route's bore: d/D <= 0.95 (aborts).
  FlowField(const Route& route, const FlowTimeline& flow, const WaterProperties& water, double gravity_m_s2,
            double ball_radius_m);

  /// Flow at `spot` for a ball centred at p_W. No allocation.
  WaterAtBall Eval(const RouteSpot& spot, const Vector3d& p_W, TrueTime t) const;

 private:
  const Route& route_;
  const FlowTimeline& flow_;
  WaterProperties water_;
  double gravity_m_s2_;
  DiscMeanTable disc_;
};

}  // namespace piperun::sim
