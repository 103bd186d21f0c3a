#include "sim/bullet/contact_solver.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace piperun::sim::bullet {

btScalar ContactSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                   btPersistentManifold** manifolds, int manifold_count, btTypedConstraint**,
                                   int, const btContactSolverInfo& info, btIDebugDraw*, btDispatcher*) {
  SetUp(bodies, body_count, manifolds, manifold_count, info);
  btScalar residual = 0;
  for (int i = 0; i < info.m_numIterations; ++i) {
    residual = Iterate();
    if (residual <= info.m_leastSquaresResidualThreshold) break;
  }
  writeBackContacts(0, m_tmpSolverContactConstraintPool.size(), info);
  writeBackBodies(0, m_tmpSolverBodyPool.size(), info);
  return residual;
}

void ContactSolver::SetUp(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                          int manifold_count, const btContactSolverInfo& info) {
  m_fixedBodyId = -1;
  m_tmpSolverContactConstraintPool.resizeNoInitialize(0);
  m_tmpSolverContactFrictionConstraintPool.resizeNoInitialize(0);
  m_tmpSolverBodyPool.resizeNoInitialize(0);
  for (int i = 0; i < body_count; ++i) bodies[i]->setCompanionId(-1);
  convertBodies(bodies, body_count, info);
  convertContacts(manifolds, manifold_count, info);
  AimAtSlip();
  resistances_.resizeNoInitialize(m_tmpSolverContactConstraintPool.size());
  for (int i = 0; i < resistances_.size(); ++i) resistances_[i] = {{0, 0, 0}, 0};
}

void ContactSolver::AimAtSlip() {
  if (slip_.isZero()) return;
  for (int i = 0; i < m_tmpSolverContactFrictionConstraintPool.size(); ++i) {
    btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[i];
    row.m_rhs += row.m_contactNormal1.dot(slip_) * row.m_jacDiagABInv;
  }
}

/// Returns the largest squared change of a velocity.
btScalar ContactSolver::Iterate() {
  btScalar residual = 0;
  const auto count = [&](btScalar change) { residual = btMax(residual, change * change); };
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    const btSolverConstraint& row = m_tmpSolverContactConstraintPool[i];
    count(resolveSingleConstraintRowLowerLimit(BodyOf(row), WallOf(row), row));
  }
  for (int i = 0; i < m_tmpSolverContactFrictionConstraintPool.size(); ++i) {
    btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[i];
    const btScalar normal_impulse = m_tmpSolverContactConstraintPool[row.m_frictionIndex].m_appliedImpulse;
    if (!(normal_impulse > 0)) continue;
    row.m_lowerLimit = -(row.m_friction * normal_impulse);
    row.m_upperLimit = row.m_friction * normal_impulse;
    count(resolveSingleConstraintRowGeneric(BodyOf(row), WallOf(row), row));
  }
  for (int i = 0; i < resistances_.size(); ++i) {
    residual = btMax(residual, Resist(m_tmpSolverContactConstraintPool[i], resistances_[i]));
  }
  return residual;
}

/// Returns the squared change of the surface speed.
btScalar ContactSolver::Resist(const btSolverConstraint& contact, Resistance& given) {
  btScalar residual = 0;
  if (rolling_length_ > 0) residual = ResistRolling(contact, given.rolling);
  if (spinning_length_ > 0) residual = btMax(residual, ResistSpinning(contact, given.spinning));
  return residual;
}

/// Gives the impulse that would stop the rolling, no longer than allowed.
btScalar ContactSolver::ResistRolling(const btSolverConstraint& contact, btVector3& impulse) {
  btSolverBody& body = BodyOf(contact);
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

btScalar ContactSolver::ResistSpinning(const btSolverConstraint&, btScalar&) { return 0; }

}  // namespace piperun::sim::bullet
