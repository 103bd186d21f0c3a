#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

namespace piperun::sim::bullet {

/// Bullet's sequential impulses with rolling resistance that is the same in every direction.
///
/// At a contact with normal impulse J the wall resists rolling by an angular impulse q across the normal,
///
///   |q| <= b J,   q opposite to the rolling velocity w_t = w - n (n . w), and w_t = 0 while |q| < b J,
///
/// b = c_rr r, a length. Bullet's own rolling friction bounds q along two axes of its choice: up to sqrt(2)
/// too much, and a slow sideways rocking would stop as if the ball were not rolling forward at all.
class RollingSolver : public btSequentialImpulseConstraintSolver {
 public:
  RollingSolver(btScalar radius, btScalar rolling_length)
      : radius_(radius), rolling_length_(rolling_length) {}

 protected:
  void convertContacts(btPersistentManifold** manifolds, int count, const btContactSolverInfo& info) override;
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* draw) override;

 private:
  btScalar ResistRolling(const btSolverConstraint& contact, btVector3& impulse);

  btScalar radius_;
  btScalar rolling_length_;
  btAlignedObjectArray<btVector3> impulses_;  // q, one per contact
};

}  // namespace piperun::sim::bullet
