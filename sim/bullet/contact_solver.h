#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include "sim/bullet/contact_resistance.h"

namespace piperun::sim::bullet {

/// Bullet's sequential impulses for one body in front of walls that do not move, with resistance to rolling
/// and spinning.
///
/// Rows, row solver and order are Bullet's. What its solver does besides for many bodies and joints (islands
/// and joints, orders of rows, split impulses, profiling) has nothing to do here and is left out: same bits
/// at a third of the cost.
///
/// Rolling and spinning at a contact: sim/bullet/contact_resistance.h.
class ContactSolver : public btSequentialImpulseConstraintSolver {
 public:
  ContactSolver(btScalar radius, btScalar rolling_length, btScalar spinning_length)
      : radius_(radius), rolling_length_(rolling_length), spinning_length_(spinning_length) {}

  /// What the slip at every contact of the next solves shall come to, instead of none.
  void set_slip(const btVector3& slip) { slip_ = slip; }

  /// `bodies`: the one that moves, then walls. `manifolds`: that body first in each. No joints.
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) override;

 private:
  void SetUp(btRigidBody& body, btPersistentManifold** manifolds, int manifold_count,
             const btContactSolverInfo& info);
  void AimAtSlip();
  btScalar Iterate();
  btScalar Resist(const btSolverConstraint& contact, ContactResistance& resistance);
  void WriteBack(btRigidBody& body, const btContactSolverInfo& info);
  btSolverBody& body() { return m_tmpSolverBodyPool[0]; }
  btSolverBody& wall() { return m_tmpSolverBodyPool[1]; }

  btScalar radius_;
  btScalar rolling_length_;
  btScalar spinning_length_;
  btVector3 slip_{0, 0, 0};
  btAlignedObjectArray<ContactResistance> resistances_;  // one per contact
};

}  // namespace piperun::sim::bullet
