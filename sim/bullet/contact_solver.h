#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

namespace piperun::sim::bullet {

/// Bullet's sequential impulses for one body in front of walls that do not move, with resistance to rolling
/// and spinning.
///
/// Rows, row solver and order are Bullet's. What its solver does besides for many bodies and joints (islands
/// and joints, orders of rows, split impulses, profiling) has nothing to do here and is left out: same bits
/// at a third of the cost.
///
/// At a contact with normal impulse J the wall resists rolling by an angular impulse q across the normal and
/// spinning by one along it,
///
///   |q| <= b J,      q opposite to the rolling velocity w_t = w - n (n . w), w_t = 0 while |q| < b J,
///   |q_n| <= b_sp J, q_n opposite to n . w, n . w = 0 while |q_n| < b_sp J,
///
/// b = c_rr r and b_sp = c_sp r, lengths. Bullet's own rolling friction bounds q along two axes of its
/// choice: up to sqrt(2) too much, and a slow sideways rocking would stop as if the ball were not rolling
/// forward at all.
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
  /// Angular impulses that one contact has given.
  struct Resistance {
    btVector3 rolling;
    btScalar spinning;
  };

  void SetUp(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds, int manifold_count,
             const btContactSolverInfo& info);
  void AimAtSlip();
  btScalar Iterate();
  btScalar Resist(const btSolverConstraint& contact, Resistance& given);
  btScalar ResistRolling(const btSolverConstraint& contact, btVector3& impulse);
  btScalar ResistSpinning(const btSolverConstraint& contact, btScalar& impulse);
  btSolverBody& BodyOf(const btSolverConstraint& row) { return m_tmpSolverBodyPool[row.m_solverBodyIdA]; }
  btSolverBody& WallOf(const btSolverConstraint& row) { return m_tmpSolverBodyPool[row.m_solverBodyIdB]; }

  btScalar radius_;
  btScalar rolling_length_;
  btScalar spinning_length_;
  btVector3 slip_{0, 0, 0};
  btAlignedObjectArray<Resistance> resistances_;  // one per contact
};

}  // namespace piperun::sim::bullet
