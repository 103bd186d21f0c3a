#include "sim/bullet/bullet_world.h"

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>

#include <cmath>

#include "base/check.h"
#include "sim/bullet/convert.h"

namespace piperun::sim::bullet {
namespace {

constexpr int kMaxIterations = 60;  // only a ball coming to rest needs more than a handful

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
      configuration_(MakeConfiguration()),
      dispatcher_(&configuration_),
      collision_(dispatcher_),
      broadphase_(4),
      solver_(ball.radius_m, ball.rolling_length_m),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
      sphere_shape_(ball.radius_m),
      bore_shape_(ball.compliance),
      ball_(BodyInfo(ball, sphere_shape_)) {
  Configure(ball);
  const Pose& X_FL = wall_.X_FL(spot_);
  ball_.setWorldTransform(btTransform(btQuaternion::getIdentity(), ToBullet(X_FL * start.X_LB.p)));
  ball_.setLinearVelocity(ToBullet(X_FL.q * start.v_WB_W));
  ball_.setAngularVelocity(ToBullet(X_FL.q * start.w_WB_W));
}

BulletWorld::~BulletWorld() {
  world_.removeRigidBody(&ball_);
  world_.removeCollisionObject(&bore_);
}

void BulletWorld::Configure(const TubeBall& ball) {
  btContactSolverInfo& solver = world_.getSolverInfo();
  solver.m_splitImpulse = 0;  // contacts act through velocities alone, so that IMU and trajectory agree
  solver.m_erp2 = 1;
  solver.m_numIterations = kMaxIterations;
  solver.m_leastSquaresResidualThreshold = 1e-28;
  solver.m_solverMode = SOLVER_USE_WARMSTARTING /* writes impulses back */ | SOLVER_USE_2_FRICTION_DIRECTIONS;
  world_.getDispatchInfo().m_useContinuous = false;
  world_.setGravity({0, 0, 0});
  world_.setForceUpdateAllAabbs(false);
  world_.getSimulationIslandManager()->setSplitIslands(false);

  ball_.setActivationState(DISABLE_DEACTIVATION);
  ball_.setDamping(0, 0);
  ball_.setFlags(0);  // no gyroscopic torque on a sphere
  ball_.setFriction(ball.friction);
  world_.addRigidBody(&ball_);
  bore_.setCollisionShape(&bore_shape_);
  bore_.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  world_.addCollisionObject(&bore_);
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
  bore_shape_.set_contacts(contacts);
  rescues_ += contacts.rescue ? 1 : 0;
  world_.stepSimulation(dt_s, 0);
  ReadContacts();
}

Vector3d BulletWorld::p_L() const {
  return wall_.X_LF(spot_) * FromBullet(ball_.getWorldTransform().getOrigin());
}

Vector3d BulletWorld::v_L() const { return wall_.X_LF(spot_).q * FromBullet(ball_.getLinearVelocity()); }

Vector3d BulletWorld::w_L() const { return wall_.X_LF(spot_).q * FromBullet(ball_.getAngularVelocity()); }

void BulletWorld::ReadContacts() {
  normal_impulse_N_s_ = 0;
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      normal_impulse_N_s_ += manifold.getContactPoint(j).getAppliedImpulse();
    }
  }
}

}  // namespace piperun::sim::bullet
