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

btRigidBody::btRigidBodyConstructionInfo BodyInfo(const Sphere& sphere, btSphereShape& shape) {
  const btScalar inertia = sphere.inertia_kg_m2;
  btRigidBody::btRigidBodyConstructionInfo info(sphere.mass_kg, nullptr, &shape, {inertia, inertia, inertia});
  info.m_friction = sphere.friction;
  return info;
}

}  // namespace

BulletWorld::BulletWorld(const Route& route, const Sphere& sphere, const Vector3d& p_W, const Vector3d& v_W,
                         const Vector3d& w_W)
    : wall_(route),
      configuration_(MakeConfiguration()),
      dispatcher_(&configuration_),
      collision_(dispatcher_),
      broadphase_(4),
      solver_(sphere.radius_m, sphere.rolling_length_m),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
      sphere_shape_(sphere.radius_m),
      tube_shape_(wall_),
      ball_(BodyInfo(sphere, sphere_shape_)) {
  Configure(sphere);
  const Pose& X_FW = wall_.X_FW(piece_);
  ball_.setWorldTransform(btTransform(btQuaternion::getIdentity(), ToBullet(X_FW * p_W)));
  ball_.setLinearVelocity(ToBullet(X_FW.q * v_W));
  ball_.setAngularVelocity(ToBullet(X_FW.q * w_W));
}

BulletWorld::~BulletWorld() {
  world_.removeRigidBody(&ball_);
  world_.removeCollisionObject(&tube_);
}

void BulletWorld::Configure(const Sphere& sphere) {
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
  ball_.setFriction(sphere.friction);
  world_.addRigidBody(&ball_);
  tube_.setCollisionShape(&tube_shape_);
  tube_.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  world_.addCollisionObject(&tube_);
}

void BulletWorld::Rebase(std::size_t piece) {
  const Pose& X_WF = wall_.X_WF(piece_);
  const Pose& X_GW = wall_.X_FW(piece);
  const Vector3d p = X_GW * (X_WF * FromBullet(ball_.getWorldTransform().getOrigin()));
  const Vector3d v = X_GW.q * (X_WF.q * FromBullet(ball_.getLinearVelocity()));
  const Vector3d w = X_GW.q * (X_WF.q * FromBullet(ball_.getAngularVelocity()));
  ball_.setWorldTransform(btTransform(btQuaternion::getIdentity(), ToBullet(p)));
  ball_.setLinearVelocity(ToBullet(v));
  ball_.setAngularVelocity(ToBullet(w));
  piece_ = piece;
}

void BulletWorld::Step(const RouteSpot& at, const Vector3d& dv_W, const Vector3d& dw_W, double dt_s) {
  if (at.piece != piece_) Rebase(at.piece);
  tube_shape_.set_spot(at);
  const Quaterniond& q_FW = wall_.X_FW(piece_).q;
  // kicked here and not through forces: Bullet's friction does not see torques before the step is over
  ball_.setLinearVelocity(ball_.getLinearVelocity() + ToBullet(q_FW * dv_W));
  ball_.setAngularVelocity(ball_.getAngularVelocity() + ToBullet(q_FW * dw_W));
  world_.stepSimulation(dt_s, 0);
  ReadContact();
}

Vector3d BulletWorld::p_W() const {
  return wall_.X_WF(piece_) * FromBullet(ball_.getWorldTransform().getOrigin());
}

Vector3d BulletWorld::v_W() const { return wall_.X_WF(piece_).q * FromBullet(ball_.getLinearVelocity()); }

Vector3d BulletWorld::w_W() const { return wall_.X_WF(piece_).q * FromBullet(ball_.getAngularVelocity()); }

void BulletWorld::ReadContact() {
  normal_impulse_N_s_ = 0;
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      normal_impulse_N_s_ += manifold.getContactPoint(j).getAppliedImpulse();
    }
  }
}

}  // namespace piperun::sim::bullet
