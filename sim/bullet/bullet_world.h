#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>

#include "sim/bore_wall.h"
#include "sim/bullet/tube_world.h"

namespace piperun::sim::bullet {

/// A btDiscreteDynamicsWorld with one sphere inside a network's bores.
///
/// Bullet works in the frame of the piece that holds the ball; everything said to or heard from this class is
/// in the drawing L of the ball's pipe. Attitude stays outside: it does not act on the motion of a
/// homogeneous sphere.
class BulletWorld {
 public:
  /// Keeps a reference to the bore. Aborts when linked with Bullet in single precision.
  BulletWorld(const Bore& bore, const TubeBall& ball, const BallStart& start);
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// Where the ball is since the last step.
  void MoveTo(const SpotMove& move);
  /// One step of symplectic Euler: v += dv and w += dw, contact and friction impulses, p += v dt.
  void Step(const Vector3d& dv_L, const Vector3d& dw_L, double dt_s);

  Vector3d p_L() const;
  Vector3d v_L() const;
  Vector3d w_L() const;
  /// Of the wall on the ball, in the last step: sum over the contacts.
  double normal_impulse_N_s() const { return normal_impulse_N_s_; }
  /// Steps so far in which the ball's centre had left the water.
  std::int64_t rescues() const { return rescues_; }

 private:
  void AddContacts(const WallContacts& contacts, double dt_s);
  void ReadContacts();

  BoreWall wall_;
  NetworkSpot spot_;  // Bullet works in the frame of its piece
  double radius_m_;
  bool rigid_;
  double normal_impulse_N_s_ = 0;
  std::int64_t rescues_ = 0;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSimpleBroadphase broadphase_;
  btSphereShape sphere_shape_;
  btRigidBody ball_;
  StaticWall bore_;
  ContactSolver solver_;
  TubeWorld world_;
};

}  // namespace piperun::sim::bullet
