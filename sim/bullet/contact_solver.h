#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <array>
#include <span>

#include "sim/bullet/contact_resistance.h"

namespace piperun::sim::bullet {

/// Bullet's sequential impulses for one body in front of walls that do not move, with resistance to rolling
/// and spinning.
///
/// Rows, their order and their arithmetic are those of btSequentialImpulseConstraintSolver; a contact has one
/// row along its normal n and two of friction across it, the first along the slip,
///
///   J += (b - J k/dt - m_e (d . dv + (r x d) . dw)),  0 <= J along n,  |J| <= mu J_n across it,
///
/// J impulse, d direction, r lever, dv and dw what the impulses so far did, m_e effective mass, b what stops
/// the approach, k compliance of a soft contact. What Bullet's solver does besides for many bodies and joints
/// (islands, orders of rows, split impulses, the zeros of the wall) has nothing to do here and is left out.
///
/// Rolling and spinning at a contact: sim/bullet/contact_resistance.h.
class ContactSolver : public btConstraintSolver {
 public:
  ContactSolver(btScalar radius, btScalar rolling_length, btScalar spinning_length)
      : radius_(radius), rolling_length_(rolling_length), spinning_length_(spinning_length) {}

  /// What the slip at every contact of the next solves shall come to, instead of none.
  void set_slip(const btVector3& slip) { slip_ = slip; }

  /// `bodies`: the one that moves, then a wall. `manifolds`: one of these two, in which every point brings
  /// its compliance (m_contactCFM). No joints, no forces on the body.
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) override;
  void reset() override {}
  btConstraintSolverType getSolverType() const override { return BT_SEQUENTIAL_IMPULSE_SOLVER; }

 private:
  /// One direction at one contact.
  struct Row {
    btVector3 direction;  // of the impulse
    btVector3 torque;     // of a unit of it
    btVector3 push;       // change of the velocity by a unit
    btVector3 turn;       // and of the angular velocity
    btScalar mass;        // effective
    btScalar inverse_mass;
    btScalar wanted;  // impulse that takes the approach, when nothing else acts
    btScalar softness;
    btScalar impulse;  // so far
  };
  struct ContactRows {
    Row normal;
    std::array<Row, 2> friction;
    btScalar friction_coefficient;
    ContactResistance resistance;
  };

  void SetUp(const btRigidBody& body, btManifoldPoint& point, btScalar per_s, ContactRows& rows) const;
  void SetUp(const btRigidBody& body, const btVector3& direction, const btVector3& lever, btScalar cfm,
             Row& row) const;
  std::span<ContactRows> contacts() { return {contacts_.data(), size_}; }
  btScalar Iterate(const btContactSolverInfo& info);
  btScalar IterateOnce();
  btScalar Resolve(Row& row, btScalar lower, btScalar upper);
  btScalar Resist(ContactRows& contact);

  btScalar radius_;
  btScalar rolling_length_;
  btScalar spinning_length_;
  btVector3 slip_{0, 0, 0};
  std::array<ContactRows, MANIFOLD_CACHE_SIZE> contacts_;
  std::size_t size_ = 0;
  btVector3 w_before_{0, 0, 0};
  btVector3 dv_{0, 0, 0}, dw_{0, 0, 0};  // what the impulses so far did
};

}  // namespace piperun::sim::bullet
