#include "sim/bullet/bullet_world.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sim/bullet/convert.h"

namespace piperun::sim::bullet {
namespace {

constexpr double kMaxPush_m_s = 1;  // at which a rigid overlap is undone; along a wall there is none

/// Bullet's headers follow BT_USE_DOUBLE_PRECISION, its libraries do not: the float ones link and start
/// without an error. A function that lives in the library tells them apart.
void RequireDoublePrecision() {
  const btSphereShape sphere(0.03);
  btVector3 inertia(0, 0, 0);
  sphere.calculateLocalInertia(2.0, inertia);
  Demand(sizeof(btScalar) == 8 && std::abs(inertia.z() - 0.4 * 2.0 * 0.03 * 0.03) < 1e-15,
         "piperun is linked with Bullet in single precision; link bullet-float64");
}

/// The first thing that is asked of Bullet.
btDefaultCollisionConstructionInfo MakeConfiguration() {
  RequireDoublePrecision();
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 4;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 4;
  return info;
}

btRigidBody::btRigidBodyConstructionInfo BodyInfo(const TubeBall& ball, btSphereShape& shape) {
  const btScalar inertia = ball.inertia_kg_m2;
  btRigidBody::btRigidBodyConstructionInfo info(ball.mass_kg, nullptr, &shape, {inertia, inertia, inertia});
  info.m_friction = ball.friction;
  return info;
}

}  // namespace

BulletWorld::BulletWorld(const Bore& bore, const TubeBall& ball, const BallStart& start)
    : wall_(bore),
      spot_(start.spot),
      radius_m_(ball.radius_m),
      rigid_(!ball.compliance),
      configuration_(MakeConfiguration()),
      dispatcher_(&configuration_),
      broadphase_(4),
      sphere_shape_(ball.radius_m),
      ball_(BodyInfo(ball, sphere_shape_)),
      solver_(ball.radius_m, ball.rolling_length_m, 0),
      world_(dispatcher_, broadphase_, solver_, configuration_, ball_, bore_) {
  world_.SetMaterial(ball.friction, ball.compliance);
  ball_.setFlags(0);  // gyroscopic torque is ours
  const Pose& X_FL = wall_.X_FL(spot_);
  ball_.setWorldTransform(btTransform(btQuaternion::getIdentity(), ToBullet(X_FL * start.X_LB.p)));
  ball_.setLinearVelocity(ToBullet(X_FL.q * start.v_WB_W));
  ball_.setAngularVelocity(ToBullet(X_FL.q * start.w_WB_W));
}

void BulletWorld::MoveTo(const SpotMove& move) {
  const Pose X_LF = wall_.X_LF(spot_), X_GL = wall_.X_FL(move.spot);
  const bool same_frame = move.spot.pipe == spot_.pipe && move.spot.piece == spot_.piece;
  spot_ = move.spot;
  if (same_frame) return;
  const Vector3d shift_L = move.crossing ? move.crossing->shift_L : Vector3d::Zero();
  const Vector3d p = X_GL * (X_LF * FromBullet(ball_.getWorldTransform().getOrigin()) + shift_L);
  const Vector3d v = X_GL.q * (X_LF.q * FromBullet(ball_.getLinearVelocity()));
  const Vector3d w = X_GL.q * (X_LF.q * FromBullet(ball_.getAngularVelocity()));
  ball_.setWorldTransform(btTransform(btQuaternion::getIdentity(), ToBullet(p)));
  ball_.setLinearVelocity(ToBullet(v));
  ball_.setAngularVelocity(ToBullet(w));
}

void BulletWorld::Step(const Vector3d& dv_L, const Vector3d& dw_L, double dt_s) {
  const Quaterniond& q_FL = wall_.X_FL(spot_).q;
  // kicked here and not through forces: Bullet's friction does not see torques before the step is over
  ball_.setLinearVelocity(ball_.getLinearVelocity() + ToBullet(q_FL * dv_L));
  ball_.setAngularVelocity(ball_.getAngularVelocity() + ToBullet(q_FL * dw_L));
  const WallContacts contacts = wall_.Probe(spot_, FromBullet(ball_.getWorldTransform().getOrigin()),
                                            FromBullet(ball_.getLinearVelocity()), radius_m_, dt_s);
  rescues_ += contacts.rescue ? 1 : 0;
  AddContacts(contacts, dt_s);
  world_.stepSimulation(dt_s);
  ReadContacts();
}

Vector3d BulletWorld::p_L() const {
  return wall_.X_LF(spot_) * FromBullet(ball_.getWorldTransform().getOrigin());
}

Vector3d BulletWorld::v_L() const { return wall_.X_LF(spot_).q * FromBullet(ball_.getLinearVelocity()); }

Vector3d BulletWorld::w_L() const { return wall_.X_LF(spot_).q * FromBullet(ball_.getAngularVelocity()); }

void BulletWorld::AddContacts(const WallContacts& contacts, double dt_s) {
  world_.ClearContacts();
  for (const WallContact& contact : contacts) {
    const btVector3 normal = ToBullet(contact.normal_F);
    const double distance = rigid_ ? std::max(contact.gap_m, -kMaxPush_m_s * dt_s) : contact.gap_m;
    world_.AddContact({normal, normal * -radius_m_, distance});
  }
}

void BulletWorld::ReadContacts() {
  normal_impulse_N_s_ = 0;
  for (int i = 0; i < world_.contact_count(); ++i) normal_impulse_N_s_ += world_.NormalImpulse(i);
}

}  // namespace piperun::sim::bullet
