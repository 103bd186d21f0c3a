#pragma once

#include <btBulletDynamicsCommon.h>

#include "sim/bullet/rolling_solver.h"
#include "sim/bullet/tube_collision.h"
#include "sim/tube_wall.h"

namespace piperun::sim::bullet {

/// The ball as Bullet sees it: a homogeneous sphere.
struct Sphere {
  double radius_m = 0;
  double mass_kg = 0;  ///< inertial: with added mass
  double inertia_kg_m2 = 0;
  double friction = 0;
  double rolling_length_m = 0;
};

/// A btDiscreteDynamicsWorld with one sphere inside the tube of a route.
///
/// Bullet works in the frame of the piece that holds the ball; everything said to or heard from this class is
/// in W. Attitude stays outside: it does not act on the motion of a homogeneous sphere.
class BulletWorld {
 public:
  /// Keeps a reference to the route. Aborts when linked with Bullet in single precision.
  BulletWorld(const Route& route, const Sphere& sphere, const Vector3d& p_W, const Vector3d& v_W,
              const Vector3d& w_W);
  ~BulletWorld();
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// One step of symplectic Euler: v += dv and w += dw, contact and friction impulses, p += v dt. `at` is the
  /// ball's spot before the step.
  void Step(const RouteSpot& at, const Vector3d& dv_W, const Vector3d& dw_W, double dt_s);

  Vector3d p_W() const;
  Vector3d v_W() const;
  Vector3d w_W() const;
  /// Of the wall on the ball, in the last step.
  double normal_impulse_N_s() const { return normal_impulse_N_s_; }

 private:
  void Rebase(std::size_t piece);
  void Configure(const Sphere& sphere);
  void ReadContact();

  TubeWall wall_;
  std::size_t piece_ = 0;  // whose frame Bullet works in
  double normal_impulse_N_s_ = 0;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  TubeCollision collision_;
  btSimpleBroadphase broadphase_;
  RollingSolver solver_;
  btDiscreteDynamicsWorld world_;
  btSphereShape sphere_shape_;
  TubeShape tube_shape_;
  btRigidBody ball_;
  btCollisionObject tube_;
};

}  // namespace piperun::sim::bullet
