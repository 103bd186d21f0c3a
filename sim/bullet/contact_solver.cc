#include "sim/bullet/contact_solver.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace piperun::sim::bullet {
namespace {

/// Along the slip and across it; any two where nothing slips.
void AimFriction(btManifoldPoint& point, const btVector3& velocity) {
  const btVector3& n = point.m_normalWorldOnB;
  btVector3 &along = point.m_lateralFrictionDir1, &across = point.m_lateralFrictionDir2;
  along = velocity - n * n.dot(velocity);
  const btScalar slip2 = along.length2();
  if (slip2 > SIMD_EPSILON) {
    along *= 1 / btSqrt(slip2);
    across = along.cross(n);
    across.normalize();
  } else {
    btPlaneSpace1(n, along, across);
  }
}

}  // namespace

btScalar ContactSolver::solveGroup(btCollisionObject** bodies, int, btPersistentManifold** manifolds, int,
                                   btTypedConstraint**, int, const btContactSolverInfo& info, btIDebugDraw*,
                                   btDispatcher*) {
  btRigidBody& body = *btRigidBody::upcast(bodies[0]);
  btPersistentManifold& manifold = *manifolds[0];
  w_before_ = body.getAngularVelocity();
  dv_.setZero();
  dw_.setZero();
  size_ = static_cast<std::size_t>(manifold.getNumContacts());
  for (std::size_t i = 0; i < size_; ++i) {
    SetUp(body, manifold.getContactPoint(static_cast<int>(i)), 1 / info.m_timeStep, contacts_[i]);
  }
  const btScalar residual = Iterate(info);
  for (std::size_t i = 0; i < size_; ++i) {
    btManifoldPoint& point = manifold.getContactPoint(static_cast<int>(i));
    point.m_appliedImpulse = contacts_[i].normal.impulse;
    point.m_appliedImpulseLateral1 = contacts_[i].friction[0].impulse;
    point.m_appliedImpulseLateral2 = contacts_[i].friction[1].impulse;
  }
  body.setLinearVelocity(body.getLinearVelocity() + dv_);
  body.setAngularVelocity(w_before_ + dw_);
  return residual;
}

void ContactSolver::SetUp(const btRigidBody& body, btManifoldPoint& point, btScalar per_s,
                          ContactRows& rows) const {
  const btVector3& n = point.m_normalWorldOnB;
  const btVector3 lever = point.m_positionWorldOnA - body.getWorldTransform().getOrigin();
  AimFriction(point, body.getVelocityInLocalPoint(lever));
  SetUp(body, n, lever, point.m_contactCFM * per_s, rows.normal);
  rows.normal.wanted -= point.m_distance1 * per_s * rows.normal.mass;
  SetUp(body, point.m_lateralFrictionDir1, lever, 0, rows.friction[0]);
  SetUp(body, point.m_lateralFrictionDir2, lever, 0, rows.friction[1]);
  for (Row& row : rows.friction) row.wanted += row.direction.dot(slip_) * row.mass;
  rows.friction_coefficient = point.m_combinedFriction;
  rows.resistance.SetUp(body, n);
}

/// Of an impulse that stops the point of the body; `cfm`: speed that it leaves for a unit of impulse.
void ContactSolver::SetUp(const btRigidBody& body, const btVector3& direction, const btVector3& lever,
                          btScalar cfm, Row& row) const {
  row.direction = direction;
  row.torque = lever.cross(direction);
  row.push = direction * body.getInvMass();
  row.turn = body.getInvInertiaTensorWorld() * row.torque;
  row.inverse_mass = body.getInvMass() + direction.dot(row.turn.cross(lever)) + cfm;
  row.mass = 1 / row.inverse_mass;
  row.wanted = -(direction.dot(body.getLinearVelocity()) + row.torque.dot(w_before_)) * row.mass;
  row.softness = cfm * row.mass;
  row.impulse = 0;
}

/// The changes c_k of the velocities fall like a geometric series, so that the next one is about
/// c_k^2/c_(k-1): when that is small enough, too, it is left out. Returns the square of the last change.
btScalar ContactSolver::Iterate(const btContactSolverInfo& info) {
  const btScalar enough = info.m_leastSquaresResidualThreshold;
  btScalar before = 0, residual = 0;
  for (int i = 0; i < info.m_numIterations; ++i) {
    residual = IterateOnce();
    if (residual <= enough || residual * residual <= enough * before) break;
    before = residual;
  }
  return residual;
}

/// Returns the largest squared change of a velocity.
btScalar ContactSolver::IterateOnce() {
  btScalar residual = 0;
  const auto count = [&](btScalar change) { residual = btMax(residual, change * change); };
  for (ContactRows& contact : contacts()) count(Resolve(contact.normal, 0, SIMD_INFINITY));
  for (ContactRows& contact : contacts()) {
    if (!(contact.normal.impulse > 0)) continue;
    const btScalar limit = contact.friction_coefficient * contact.normal.impulse;
    for (Row& row : contact.friction) count(Resolve(row, -limit, limit));
  }
  if (rolling_length_ == 0 && spinning_length_ == 0) return residual;
  for (ContactRows& contact : contacts()) residual = btMax(residual, Resist(contact));
  return residual;
}

/// A step of projected Gauss and Seidel. Returns the change of the velocity along the row.
btScalar ContactSolver::Resolve(Row& row, btScalar lower, btScalar upper) {
  const btScalar speed = row.direction.dot(dv_) + row.torque.dot(dw_);
  const btScalar before = row.impulse;
  const btScalar change = row.wanted - before * row.softness - speed * row.mass;
  const btScalar wanted = before + change;
  const bool free = wanted >= lower && wanted <= upper;
  row.impulse = free ? wanted : wanted < lower ? lower : upper;
  const btScalar given = free ? change : row.impulse - before;
  dv_ += row.push * given;
  dw_ += row.turn * given;
  return given * row.inverse_mass;
}

/// Returns the squared change of the surface speed.
btScalar ContactSolver::Resist(ContactRows& contact) {
  const btScalar normal_impulse = contact.normal.impulse;
  btScalar change = 0;
  const auto turn = [&](const btVector3& by) {
    dw_ += by;
    change = btMax(change, by.length2() * radius_ * radius_);
  };
  if (rolling_length_ > 0) {
    turn(contact.resistance.ResistRolling(w_before_ + dw_, rolling_length_ * normal_impulse));
  }
  if (spinning_length_ > 0) {
    turn(contact.resistance.ResistSpinning(w_before_ + dw_, spinning_length_ * normal_impulse));
  }
  return change;
}

}  // namespace piperun::sim::bullet
