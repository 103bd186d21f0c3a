#include "sim/bullet/rolling_solver.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace piperun::sim::bullet {

void RollingSolver::convertContacts(btPersistentManifold** manifolds, int count,
                                    const btContactSolverInfo& info) {
  btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
  impulses_.resizeNoInitialize(m_tmpSolverContactConstraintPool.size());
  for (int i = 0; i < impulses_.size(); ++i) impulses_[i].setZero();
}

btScalar RollingSolver::solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info, btIDebugDraw* draw) {
  btScalar residual = btSequentialImpulseConstraintSolver::solveSingleIteration(
      iteration, bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, draw);
  if (rolling_length_ == 0) return residual;
  for (int i = 0; i < impulses_.size(); ++i) {
    residual = btMax(residual, ResistRolling(m_tmpSolverContactConstraintPool[i], impulses_[i]));
  }
  return residual;
}

/// Gives the impulse that would stop the rolling, no longer than allowed. Returns the squared change of the
/// surface speed.
btScalar RollingSolver::ResistRolling(const btSolverConstraint& contact, btVector3& impulse) {
  btSolverBody& body = m_tmpSolverBodyPool[contact.m_solverBodyIdA];
  const btScalar inverse_inertia =
      body.m_originalBody->getInvInertiaDiagLocal().x();  // a sphere's, isotropic
  const btVector3& n = contact.m_contactNormal1;
  const btVector3 w = body.m_angularVelocity + body.internalGetDeltaAngularVelocity();
  const btScalar limit = rolling_length_ * contact.m_appliedImpulse;
  btVector3 wanted = impulse - (w - n * n.dot(w)) / inverse_inertia;
  const btScalar length = wanted.length();
  if (length > limit) wanted *= limit / length;
  const btVector3 change = (wanted - impulse) * inverse_inertia;
  impulse = wanted;
  body.internalGetDeltaAngularVelocity() += change;
  return change.length2() * radius_ * radius_;
}

}  // namespace piperun::sim::bullet
