#include "sim/bullet/contact_solver.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>

namespace piperun::sim::bullet {
namespace {

bool IsIsotropic(const btVector3& inverse_inertia) {
  return inverse_inertia.x() == inverse_inertia.y() && inverse_inertia.x() == inverse_inertia.z();
}

/// Change of w by an angular impulse.
btVector3 CalcRate(const btRigidBody& body, const btVector3& impulse) {
  const btVector3& local = body.getInvInertiaDiagLocal();
  return IsIsotropic(local) ? impulse * local.x() : body.getInvInertiaTensorWorld() * impulse;
}

/// Inverse inertia of a body for turning across a normal n: B = T^T I^-1 T, T two axes across n.
class CrossInertia {
 public:
  CrossInertia(const btRigidBody& body, const btVector3& n) : body_(body) {
    const btVector3& local = body.getInvInertiaDiagLocal();
    isotropic_ = IsIsotropic(local);
    most_ = local.x();
    if (isotropic_) return;
    btPlaneSpace1(n, t1_, t2_);
    const btVector3 a1 = CalcRate(body, t1_), a2 = CalcRate(body, t2_);
    b11_ = t1_.dot(a1), b12_ = t1_.dot(a2), b22_ = t2_.dot(a2);
    most_ = 0.5 * (b11_ + b22_ + std::hypot(b11_ - b22_, 2 * b12_));
  }

  /// Largest eigenvalue of B.
  btScalar most() const { return most_; }
  /// The impulse q across n with B q = w_t.
  btVector3 Stopping(const btVector3& w_t) const {
    if (isotropic_) return w_t / most_;
    const btScalar w1 = t1_.dot(w_t), w2 = t2_.dot(w_t), det = b11_ * b22_ - b12_ * b12_;
    return t1_ * ((b22_ * w1 - b12_ * w2) / det) + t2_ * ((b11_ * w2 - b12_ * w1) / det);
  }
  btVector3 RateOf(const btVector3& impulse) const { return CalcRate(body_, impulse); }

 private:
  const btRigidBody& body_;
  bool isotropic_;
  btScalar most_;
  btVector3 t1_, t2_;
  btScalar b11_ = 0, b12_ = 0, b22_ = 0;
};

}  // namespace

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

/// Gives the impulse that would stop the rolling; where that is more than allowed, all that is allowed,
/// against the rolling. Stopping takes the whole inertia; a direction against w_t is found by steps of the
/// gradient.
btScalar ContactSolver::ResistRolling(const btSolverConstraint& contact, btVector3& impulse) {
  btSolverBody& body = BodyOf(contact);
  const btVector3& n = contact.m_contactNormal1;
  const btVector3 w = body.m_angularVelocity + body.internalGetDeltaAngularVelocity();
  const btVector3 w_t = w - n * n.dot(w);
  const btScalar limit = rolling_length_ * contact.m_appliedImpulse;
  const CrossInertia inertia(*body.m_originalBody, n);
  btVector3 wanted = impulse - inertia.Stopping(w_t);
  if (wanted.length2() > limit * limit) {
    wanted = impulse - w_t / inertia.most();
    const btScalar length = wanted.length();
    if (length > limit) wanted *= limit / length;
  }
  const btVector3 change = inertia.RateOf(wanted - impulse);
  impulse = wanted;
  body.internalGetDeltaAngularVelocity() += change;
  return change.length2() * radius_ * radius_;
}

btScalar ContactSolver::ResistSpinning(const btSolverConstraint& contact, btScalar& impulse) {
  btSolverBody& body = BodyOf(contact);
  const btVector3& n = contact.m_contactNormal1;
  const btVector3 rate = CalcRate(*body.m_originalBody, n);
  const btScalar w_n = n.dot(body.m_angularVelocity + body.internalGetDeltaAngularVelocity());
  const btScalar limit = spinning_length_ * contact.m_appliedImpulse;
  const btScalar wanted = btClamped(impulse - w_n / n.dot(rate), -limit, limit);
  const btVector3 change = rate * (wanted - impulse);
  impulse = wanted;
  body.internalGetDeltaAngularVelocity() += change;
  return change.length2() * radius_ * radius_;
}

}  // namespace piperun::sim::bullet
