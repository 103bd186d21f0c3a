#include "sim/imu_interval.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

/// Integral over x in [from, to] of Exp(-x dtheta) f: a vector that stands still in W, seen from a ball
/// turning by dtheta per unit of x. Relative error (|dtheta| (to - from))^4 / 1920.
Vector3d IntegrateTurning(const Vector3d& f, const Vector3d& dtheta, double from, double to) {
  if (to <= from) return Vector3d::Zero();
  const double h = to - from;
  const Vector3d middle = ExpSO3(-0.5 * (from + to) * dtheta) * f;
  return h * (middle + h * h / 24 * dtheta.cross(dtheta.cross(middle)));
}

/// Integral of the centre's specific force over the part [from, to] of the step a -> b, in steps.
Vector3d IntegrateCentre(const TruthState& a, const TruthState& b, double from, double to) {
  const Vector3d& dtheta = b.dtheta_B_rad;
  return IntegrateTurning(a.f_WB_B, dtheta, from, std::min(to, 0.5)) +
         IntegrateTurning(b.f_WB_B, dtheta, std::max(from, 0.5) - 1, to - 1);
}

/// Acceleration of the point relative to the centre, mean over the step a -> b, in B.
Vector3d CalcLeverAcceleration(const TruthState& a, const TruthState& b, const Vector3d& p_BP, double dt_s) {
  const Vector3d w = b.dtheta_B_rad / dt_s;
  const Vector3d w_dot = (b.w_WB_B - a.w_WB_B) / dt_s;
  return w_dot.cross(p_BP) + w.cross(w.cross(p_BP));
}

/// Exp(theta) p - p without cancellation: sin(t)/t theta x p + (1 - cos(t))/t^2 theta x (theta x p).
Vector3d CalcTurnChange(const Vector3d& theta, const Vector3d& p) {
  const double angle = theta.norm();
  const double half = 0.5 * angle;
  const double sinc = angle > 0 ? std::sin(angle) / angle : 1;
  const double half_sinc = angle > 0 ? std::sin(half) / half : 1;
  const Vector3d turned = theta.cross(p);
  return sinc * turned + 0.5 * half_sinc * half_sinc * theta.cross(turned);
}

/// R_{n-1}^T (u_n - u_{n-1} - g dt) for a = n-1, b = n.
Vector3d CalcVelocityIncrement(const TruthState& a, const TruthState& b, const Vector3d& p_BP,
                               const Vector3d& gravity_W, double dt_s, bool a_is_start) {
  const Vector3d dv_W = b.v_step_W - a.v_step_W - dt_s * gravity_W;
  const Vector3d u_lever_before_B =
      a_is_start ? Vector3d(a.w_WB_B.cross(p_BP)) : Vector3d(-CalcTurnChange(-a.dtheta_B_rad, p_BP) / dt_s);
  return a.X_WB.q.conjugate() * dv_W + CalcTurnChange(b.dtheta_B_rad, p_BP) / dt_s - u_lever_before_B;
}

/// Calls visit(a, b, from, to, n) for every step n, from state a to state b, of which the part from `from` to
/// `to` lies inside (begin, end].
template <class Visit>
void ForEachStep(const TruthWindow& window, TrueTime begin, TrueTime end, const Visit& visit) {
  bool done = false;
  for (std::int64_t n = window.StepAt(begin) + 1; !done; ++n) {
    const TruthState& a = window.at(n - 1);
    const TruthState& b = window.at(n);
    const double step_s = Seconds(b.time - a.time);
    const double from = std::max(0.0, Seconds(begin - a.time) / step_s);
    const double to = std::min(1.0, Seconds(end - a.time) / step_s);
    visit(a, b, from, to, n);
    done = b.time >= end;
  }
}

}  // namespace

ImuInterval CalcImuInterval(const TruthWindow& window, TrueTime begin, TrueTime end, const Vector3d& p_BP) {
  const double dt = window.rate().Period_s();
  double steps = 0;
  Vector3d dtheta = Vector3d::Zero(), f = Vector3d::Zero();
  ForEachStep(window, begin, end,
              [&](const TruthState& a, const TruthState& b, double from, double to, std::int64_t) {
                const double part = to - from;
                steps += part;
                dtheta += part * b.dtheta_B_rad;
                f += IntegrateCentre(a, b, from, to) + part * CalcLeverAcceleration(a, b, p_BP, dt);
              });
  return {steps * dt, dtheta / (steps * dt), f / steps};
}

ImuIntervalIncrements CalcImuIncrements(const TruthWindow& window, TrueTime begin, TrueTime end,
                                        const Vector3d& p_BP, const Vector3d& gravity_W) {
  const double dt = window.rate().Period_s();
  double steps = 0;
  Vector3d dv = Vector3d::Zero();
  Quaterniond q_begin_B = Quaterniond::Identity();  // from the ball's axes at the end of the last part
  ForEachStep(window, begin, end,
              [&](const TruthState& a, const TruthState& b, double from, double to, std::int64_t n) {
                const double part = to - from;
                steps += part;
                const Quaterniond q_begin_a = q_begin_B * ExpSO3(-from * b.dtheta_B_rad);
                dv += part * (q_begin_a * CalcVelocityIncrement(a, b, p_BP, gravity_W, dt, n == 1));
                q_begin_B = q_begin_B * ExpSO3(part * b.dtheta_B_rad);
              });
  return {steps * dt, LogSO3(q_begin_B), dv};
}

}  // namespace piperun::sim
