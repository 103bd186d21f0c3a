#include "sim/bullet/contact_resistance.h"

#include <cmath>

namespace piperun::sim::bullet {

ContactResistance::ContactResistance(const btRigidBody& body, const btVector3& normal) : normal_(normal) {
  const btVector3& local = body.getInvInertiaDiagLocal();
  isotropic_ = local.x() == local.y() && local.x() == local.z();
  rate_ = local.x();
  if (!isotropic_) {
    rates_ = body.getInvInertiaTensorWorld();
    btPlaneSpace1(normal_, t1_, t2_);
    const btVector3 a1 = rates_ * t1_, a2 = rates_ * t2_;
    b11_ = t1_.dot(a1), b12_ = t1_.dot(a2), b22_ = t2_.dot(a2);
    rate_ = 0.5 * (b11_ + b22_ + std::hypot(b11_ - b22_, 2 * b12_));
  }
  inverse_rate_ = 1 / rate_;
}

/// Stopping takes the whole inertia; where that is more than allowed, steps of the gradient find the impulse
/// that opposes w_t.
btVector3 ContactResistance::ResistRolling(const btVector3& w, btScalar limit) {
  const btVector3 w_t = w - normal_ * normal_.dot(w);
  btVector3 wanted = rolling_ - CalcStopping(w_t);
  if (wanted.length2() > limit * limit) {
    wanted = rolling_ - w_t * inverse_rate_;
    const btScalar length = wanted.length();
    if (length > limit) wanted *= limit / length;
  }
  const btVector3 change = wanted - rolling_;
  rolling_ = wanted;
  return CalcRate(change);
}

btVector3 ContactResistance::ResistSpinning(const btVector3& w, btScalar limit) {
  const btVector3 rate = CalcRate(normal_);
  const btScalar wanted = btClamped(spinning_ - normal_.dot(w) / normal_.dot(rate), -limit, limit);
  const btScalar change = wanted - spinning_;
  spinning_ = wanted;
  return rate * change;
}

btVector3 ContactResistance::CalcRate(const btVector3& impulse) const {
  return isotropic_ ? impulse * rate_ : rates_ * impulse;
}

/// The impulse q across the normal with B q = w_t.
btVector3 ContactResistance::CalcStopping(const btVector3& w_t) const {
  if (isotropic_) return w_t * inverse_rate_;
  const btScalar w1 = t1_.dot(w_t), w2 = t2_.dot(w_t), det = b11_ * b22_ - b12_ * b12_;
  return t1_ * ((b22_ * w1 - b12_ * w2) / det) + t2_ * ((b11_ * w2 - b12_ * w1) / det);
}

}  // namespace piperun::sim::bullet
