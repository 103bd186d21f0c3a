#include "sim/bullet/tube_world.h"

namespace piperun::sim::bullet {
namespace {

constexpr int kMaxIterations = 60;  // only a ball coming to rest needs more than a handful

}  // namespace

TubeWorld::TubeWorld(btDispatcher& dispatcher, btBroadphaseInterface& broadphase, ContactSolver& solver,
                     btCollisionConfiguration& configuration, btRigidBody& body, btCollisionObject& wall)
    : btDiscreteDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration),
      body_(body),
      wall_(wall),
      manifold_(&body, &wall, 0, SIMD_INFINITY, SIMD_INFINITY) {
  m_solverInfo.m_splitImpulse = 0;  // contacts act through velocities alone, so that IMU and trajectory agree
  m_solverInfo.m_erp2 = 1;
  m_solverInfo.m_numIterations = kMaxIterations;
  m_solverInfo.m_leastSquaresResidualThreshold = 1e-28;
  m_solverInfo.m_solverMode =
      SOLVER_USE_WARMSTARTING /* writes impulses back */ | SOLVER_USE_2_FRICTION_DIRECTIONS;
  setGravity({0, 0, 0});
  addRigidBody(&body_);
  addCollisionObject(&wall_);
}

TubeWorld::~TubeWorld() {
  removeRigidBody(&body_);
  removeCollisionObject(&wall_);
}

void TubeWorld::SetFriction(btScalar friction) {
  manifold_.setNumContacts(kMaxContacts);
  for (int i = 0; i < kMaxContacts; ++i) {
    btManifoldPoint& point = manifold_.getContactPoint(i);
    point = btManifoldPoint();
    point.m_combinedFriction = friction;
    point.m_combinedRestitution = 0;  // rebounds are aimed at through the distance
    point.m_contactPointFlags = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP;
    point.m_contactERP = 1;
  }
  ClearContacts();
}

void TubeWorld::AddContact(const Contact& contact) {
  const int i = manifold_.getNumContacts();
  manifold_.setNumContacts(i + 1);
  btManifoldPoint& point = manifold_.getContactPoint(i);
  point.m_normalWorldOnB = contact.normal;
  point.m_positionWorldOnA = body_.getCenterOfMassPosition() + contact.lever;
  point.m_positionWorldOnB = point.m_positionWorldOnA - contact.normal * contact.distance;
  point.m_distance1 = contact.distance;
  point.m_contactCFM = contact.firmness == kRigid ? 0 : 1 / contact.firmness;
  point.m_appliedImpulse = point.m_appliedImpulseLateral1 = point.m_appliedImpulseLateral2 = 0;
}

btVector3 TubeWorld::Impulse(int contact) const {
  const btManifoldPoint& point = manifold_.getContactPoint(contact);
  return point.m_normalWorldOnB * point.m_appliedImpulse +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
}

int TubeWorld::stepSimulation(btScalar dt, int, btScalar) {
  internalSingleStepSimulation(dt);
  return 1;
}

void TubeWorld::internalSingleStepSimulation(btScalar dt) {
  if (manifold_.getNumContacts() > 0) {
    m_solverInfo.m_timeStep = dt;
    btCollisionObject* bodies[] = {&body_, &wall_};
    btPersistentManifold* manifold = &manifold_;
    m_constraintSolver->solveGroup(bodies, 2, &manifold, 1, nullptr, 0, m_solverInfo, nullptr, m_dispatcher1);
  }
  body_.translate(body_.getLinearVelocity() * dt);
}

}  // namespace piperun::sim::bullet
