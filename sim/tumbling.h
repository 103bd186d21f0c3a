#pragma once

#include "sim/rotary_inertia.h"

namespace piperun::sim {

/// The turning of a body with unequal moments of inertia, leapfrog in its angular momentum:
///
///   L(n+1/2) = L(n-1/2) + torque impulse,  w(n+1/2) = I(n+1/2)^-1 L(n+1/2),  R(n+1) = Exp(w dt) R(n)
///
/// I(n+1/2) is the tensor at the attitude half a step ahead, Exp(w' dt/2) R(n), with w' = 2 w(n-1/2) -
/// w(n-3/2). Without torque L is kept to rounding; attitude and energy are of second order.
class Tumbling {
 public:
  Tumbling(const RotaryInertia& inertia, const Quaterniond& q_WB, const Vector3d& w_WB_W);

  /// Begins the step from attitude `q_WB`: takes the impulse of the loads, finds I(n+1/2).
  void Kick(const Vector3d& impulse_W_N_m_s, const Quaterniond& q_WB, double dt_s);
  /// Ends the step: takes what contacts have changed w by. `smooth`: the change of w over this step says what
  /// the next will be; not so after an impact.
  void Finish(const Vector3d& dw_W, bool smooth);

  const Vector3d& momentum_W() const { return momentum_W_; }
  /// w(n+1/2) as the loads alone leave it.
  const Vector3d& w_kicked_W() const { return w_kicked_W_; }
  /// w(n+1/2) as foreseen, contacts included: of second order.
  const Vector3d& w_foreseen_W() const { return w_foreseen_W_; }
  /// Attitude half a step ahead.
  const Matrix3d& R_mid() const { return R_mid_; }

 private:
  const RotaryInertia inertia_;
  Vector3d momentum_W_;
  Vector3d w_kicked_W_;
  Vector3d w_before_W_;  // w(n-1/2)
  Vector3d w_foreseen_W_;
  Matrix3d R_mid_;
};

/// (Exp(theta) - E) x without the difference of near numbers.
Vector3d CalcTurnedBy(const Vector3d& theta, const Vector3d& x);

}  // namespace piperun::sim
