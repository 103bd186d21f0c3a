#pragma once

#include <functional>
#include <memory>

#include "base/time.h"
#include "sim/route_spot.h"

namespace piperun::sim {

/// A homogeneous sphere in a tube. The mass is the inertial one: the added mass of the water belongs into it.
struct TubeBall {
  double radius_m = 0;
  double mass_kg = 0;
  double inertia_kg_m2 = 0;     ///< about the centre
  double friction = 0;          ///< Coulomb coefficient at the wall
  double rolling_length_m = 0;  ///< b = c_rr r: resisting torque over normal force
};

struct BallStart {
  Pose X_WB;
  Vector3d v_WB_W = Vector3d::Zero();
  Vector3d w_WB_W = Vector3d::Zero();
};

/// The ball at a whole step, as the loads on it need it; velocities to second order in the step.
struct BallInstant {
  TrueTime time{};
  Vector3d p_WB;
  Vector3d v_WB_W;
  Vector3d w_WB_W;
  RouteSpot spot;
};

struct BallLoad {
  Vector3d force_W_N = Vector3d::Zero();  ///< everything but the wall, weight included
  Vector3d torque_W_N_m = Vector3d::Zero();
};

using BallLoadFunction = std::function<BallLoad(const BallInstant&)>;

/// The ball at step n, complete.
struct BallState {
  TrueTime time{};
  Pose X_WB;
  Vector3d v_WB_W, w_WB_W;      ///< mean of the half steps before and after
  Vector3d a_WB_W, alpha_WB_W;  ///< their difference over the step
  Vector3d v_step_W;            ///< p = p_before + v_step dt
  Vector3d dtheta_B_rad;        ///< R = R_before Exp(dtheta)
  RouteSpot spot;
  double normal_force_N = 0;  ///< of the wall on the ball, mean over the step around `time`
};

/// A ball under given loads inside the pipe of a route, in a Bullet scene.
///
/// Integrated leapfrog: v(n+1/2) = v(n-1/2) + dt (F_n + contact_n)/m, p(n+1) = p(n) + dt v(n+1/2), with half
/// a kick in the first step. F_n is evaluated at v_n = v(n-1/2) + a(n-1) dt/2, so straight motion and
/// frictionless rocking are of second order; rolling friction on a turning contact normal is of first. The
/// contact is inelastic and rigid; sliding friction obeys Coulomb's cone, rolling resistance a disc of radius
/// b N. The state at step n needs the velocity half a step later: the world runs one step ahead of what it
/// tells.
class BallWorld {
 public:
  /// Keeps a reference to the route. The ball must start inside the pipe, near its first piece.
  BallWorld(const Route& route, const TubeBall& ball, Rate rate, const BallStart& start,
            BallLoadFunction load);
  ~BallWorld();

  const BallState& state() const;
  void Step();  ///< no allocation

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace piperun::sim
