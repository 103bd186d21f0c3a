#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace piperun::sim::bullet {

/// What one contact does against a body's turning.
///
/// With the normal impulse J the wall resists rolling by an angular impulse q across the normal and spinning
/// by one along it,
///
///   |q| <= b J,      q opposite to the rolling velocity w_t = w - n (n . w), w_t = 0 while |q| < b J,
///   |q_n| <= b_sp J, q_n opposite to n . w, n . w = 0 while |q_n| < b_sp J,
///
/// b = c_rr r and b_sp = c_sp r, lengths. Bullet's own rolling friction bounds q along two axes of its
/// choice: up to sqrt(2) too much, and a slow sideways rocking would stop as if the ball were not rolling
/// forward at all.
class ContactResistance {
 public:
  ContactResistance(const btRigidBody& body, const btVector3& normal);

  /// One iteration: the change of w that takes the rolling, or as much of it as `limit` = b J lets it.
  btVector3 ResistRolling(const btVector3& w, btScalar limit);
  /// The same for the spinning, `limit` = b_sp J.
  btVector3 ResistSpinning(const btVector3& w, btScalar limit);

 private:
  btVector3 CalcRate(const btVector3& impulse) const;
  btVector3 CalcStopping(const btVector3& w_t) const;

  btVector3 normal_;
  btVector3 rolling_{0, 0, 0};  // q so far
  btScalar spinning_ = 0;       // q_n so far
  bool isotropic_;
  btScalar rate_;          // largest eigenvalue of B = T^T I^-1 T, T two axes across the normal
  btScalar inverse_rate_;  // and its inverse
  btMatrix3x3 rates_;      // I^-1, if not isotropic; so are
  btVector3 t1_, t2_;      // T
  btScalar b11_ = 0, b12_ = 0, b22_ = 0;
};

}  // namespace piperun::sim::bullet
