#include "sim/tumbling.h"

namespace piperun::sim {

Tumbling::Tumbling(const RotaryInertia& inertia, const Quaterniond& q_WB, const Vector3d& w_WB_W)
    : inertia_(inertia),
      momentum_W_(inertia.Momentum(q_WB.toRotationMatrix(), w_WB_W)),
      w_kicked_W_(w_WB_W),
      w_before_W_(w_WB_W),
      w_foreseen_W_(w_WB_W),
      R_mid_(q_WB.toRotationMatrix()) {}

void Tumbling::Kick(const Vector3d& impulse_W_N_m_s, const Quaterniond& q_WB, double dt_s) {
  momentum_W_ += impulse_W_N_m_s;
  R_mid_ = (ExpSO3(0.5 * dt_s * w_foreseen_W_) * q_WB).toRotationMatrix();
  w_kicked_W_ = inertia_.Rate(R_mid_, momentum_W_);
}

void Tumbling::Finish(const Vector3d& dw_W, bool smooth) {
  momentum_W_ += inertia_.Momentum(R_mid_, dw_W);
  const Vector3d w_WB_W = w_kicked_W_ + dw_W;
  w_foreseen_W_ = smooth ? Vector3d(2 * w_WB_W - w_before_W_) : w_WB_W;
  w_before_W_ = w_WB_W;
}

Vector3d CalcTurnedBy(const Vector3d& theta, const Vector3d& x) {
  const Quaterniond q = ExpSO3(theta);
  const Vector3d twice = 2 * q.vec().cross(x);
  return q.w() * twice + q.vec().cross(twice);
}

}  // namespace piperun::sim
