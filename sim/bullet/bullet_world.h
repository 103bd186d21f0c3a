#pragma once

#include <btBulletDynamicsCommon.h>

#include <array>
#include <cstdint>
#include <optional>

#include "sim/ball_world.h"
#include "sim/bore_wall.h"
#include "sim/bullet/tube_world.h"
#include "sim/impact.h"
#include "sim/tumbling.h"

namespace piperun::sim::bullet {

/// A ball inside a network's bores as Bullet sees it.
///
/// Bullet works in the frame F of the piece that holds the ball; everything said to or heard from this class
/// is in the drawing L of the ball's pipe. Its body has its origin at the centre of mass M; p and v_step are
/// those of the sphere's centre B. Where attitude acts on the motion (mass off the centre, unequal moments),
/// the body's axes are the principal ones half a step ahead, where momentum becomes angular velocity; an
/// isotropic body's are left alone.
class BulletWorld {
 public:
  /// Keeps a reference to the bore. Aborts when linked with Bullet in single precision.
  BulletWorld(const Bore& bore, const TubeBall& ball, const BallStart& start);
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// Where the ball is since the last step.
  void MoveTo(const SpotMove& move);
  /// One step of symplectic Euler over dt: the loads for `kick_s`, contact and friction impulses, drift.
  void Step(const BallLoad& load, double kick_s, double dt_s);

  const Vector3d& p_L() const { return p_L_; }
  const Quaterniond& q_LB() const { return q_LB_; }
  /// Of the last step; p = p_before + v_step dt, q = q_before Exp(dtheta).
  const Vector3d& v_step_L() const { return v_step_L_; }
  const Vector3d& w_L() const { return w_L_; }
  const Vector3d& dtheta_B_rad() const { return dtheta_B_rad_; }
  /// Of the wall on the ball, in the last step.
  const StepContacts& contacts() const { return contacts_; }
  double normal_impulse_N_s() const { return normal_impulse_N_s_; }
  /// Steps so far in which the ball's centre had left the water.
  std::int64_t rescues() const { return rescues_; }

 private:
  /// What a step knows before its contacts.
  struct StepPlan {
    double dt_s = 0;
    Vector3d lever_F = Vector3d::Zero();  // R p_BM
    /// v_step - (v_M - w x lever): what the lever turns over a whole step beyond w x lever.
    Vector3d turning_F = Vector3d::Zero();
    Vector3d w_kicked_F;      // without contacts, as are
    Vector3d v_step_F;        // these
    Vector3d acceleration_F;  // of B
  };

  /// What to tell of a contact that Bullet has been given.
  struct AimedContact {
    Vector3d normal_F;
    double closing_speed_m_s = 0;
    int feature = -1;
  };

  StepPlan Kick(const BallLoad& load, double kick_s, double dt_s);
  void KickTumbling(const BallLoad& load, double kick_s, StepPlan& plan);
  void AddContacts(const WallContacts& contacts, const StepPlan& plan);
  static WallApproach MakeApproach(const WallContact& contact, const StepPlan& plan);
  TubeWorld::Contact AimRigidly(const WallContact& contact, const WallApproach& approach, double dt_s) const;
  TubeWorld::Contact AimSoftly(const WallContact& contact, double dt_s) const;
  double CalcGapSpeedBefore_m_s(const WallContact& contact, double dt_s) const;
  double CalcGapBefore_m(const WallContact& contact, double dt_s) const;
  void ReadContacts();
  void Drift(const StepPlan& plan);

  BoreWall wall_;
  NetworkSpot spot_;  // Bullet works in the frame of its piece
  TubeBall data_;
  double impact_rad_s_;               // of a soft contact
  std::optional<Tumbling> tumbling_;  // of a ball whose attitude acts on its motion

  Vector3d p_F_;       // of B
  Vector3d v_step_F_;  // of B
  Vector3d p_L_, v_step_L_, w_L_;
  Quaterniond q_LB_;
  Vector3d dtheta_B_rad_ = Vector3d::Zero();
  StepContacts contacts_;
  std::array<AimedContact, WallContacts::kCapacity> aimed_;  // those that Bullet has been given
  double normal_impulse_N_s_ = 0;
  std::int64_t rescues_ = 0;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSimpleBroadphase broadphase_;
  btSphereShape sphere_shape_;
  btRigidBody body_;
  StaticWall bore_;
  ContactSolver solver_;
  TubeWorld world_;
};

}  // namespace piperun::sim::bullet
