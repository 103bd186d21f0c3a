#include "sim/bullet/contact_solver.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace piperun::sim::bullet {

btScalar ContactSolver::solveGroup(btCollisionObject** bodies, int, btPersistentManifold** manifolds,
                                   int manifold_count, btTypedConstraint**, int,
                                   const btContactSolverInfo& info, btIDebugDraw*, btDispatcher*) {
  btRigidBody& moving = *btRigidBody::upcast(bodies[0]);
  SetUp(moving, manifolds, manifold_count, info);
  btScalar residual = 0;
  for (int i = 0; i < info.m_numIterations; ++i) {
    residual = Iterate();
    if (residual <= info.m_leastSquaresResidualThreshold) break;
  }
  WriteBack(moving, info);
  return residual;
}

void ContactSolver::SetUp(btRigidBody& moving, btPersistentManifold** manifolds, int manifold_count,
                          const btContactSolverInfo& info) {
  if (m_tmpSolverBodyPool.size() == 0) {
    m_tmpSolverBodyPool.resizeNoInitialize(2);
    m_fixedBodyId = 1;  // all that does not move
    initSolverBody(&wall(), nullptr, info.m_timeStep);
  }
  initSolverBody(&body(), &moving, info.m_timeStep);
  moving.setCompanionId(0);
  m_tmpSolverContactConstraintPool.resizeNoInitialize(0);
  m_tmpSolverContactFrictionConstraintPool.resizeNoInitialize(0);
  convertContacts(manifolds, manifold_count, info);
  AimAtSlip();
  resistances_.resizeNoInitialize(0);
  if (rolling_length_ == 0 && spinning_length_ == 0) return;
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    resistances_.push_back(ContactResistance(moving, m_tmpSolverContactConstraintPool[i].m_contactNormal1));
  }
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
    count(resolveSingleConstraintRowLowerLimit(body(), wall(), m_tmpSolverContactConstraintPool[i]));
  }
  for (int i = 0; i < m_tmpSolverContactFrictionConstraintPool.size(); ++i) {
    btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[i];
    const btScalar normal_impulse = m_tmpSolverContactConstraintPool[row.m_frictionIndex].m_appliedImpulse;
    if (!(normal_impulse > 0)) continue;
    row.m_lowerLimit = -(row.m_friction * normal_impulse);
    row.m_upperLimit = row.m_friction * normal_impulse;
    count(resolveSingleConstraintRowGeneric(body(), wall(), row));
  }
  for (int i = 0; i < resistances_.size(); ++i) {
    residual = btMax(residual, Resist(m_tmpSolverContactConstraintPool[i], resistances_[i]));
  }
  return residual;
}

/// Returns the squared change of the surface speed.
btScalar ContactSolver::Resist(const btSolverConstraint& contact, ContactResistance& resistance) {
  const btScalar normal_impulse = contact.m_appliedImpulse;
  btVector3& dw = body().internalGetDeltaAngularVelocity();
  btScalar change = 0;
  const auto turn = [&](const btVector3& by) {
    dw += by;
    change = btMax(change, by.length2() * radius_ * radius_);
  };
  const btVector3& w = body().m_angularVelocity;
  if (rolling_length_ > 0) turn(resistance.ResistRolling(w + dw, rolling_length_ * normal_impulse));
  if (spinning_length_ > 0) turn(resistance.ResistSpinning(w + dw, spinning_length_ * normal_impulse));
  return change;
}

void ContactSolver::WriteBack(btRigidBody& moving, const btContactSolverInfo& info) {
  writeBackContacts(0, m_tmpSolverContactConstraintPool.size(), info);
  body().writebackVelocity();
  moving.setLinearVelocity(body().m_linearVelocity);
  moving.setAngularVelocity(body().m_angularVelocity);
}

}  // namespace piperun::sim::bullet
