#include "sim/imu_interval.h"

#include <algorithm>
#include <cmath>

#include "sim/imu_steps.h"

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

/// Rate and angular acceleration, means over the step a -> b, in B.
struct Turning {
  Vector3d w;
  Vector3d w_dot;
};
Turning CalcTurning(const TruthState& a, const TruthState& b, double dt_s) {
  return {b.dtheta_B_rad / dt_s, (b.w_WB_B - a.w_WB_B) / dt_s};
}

/// Acceleration of the point relative to the centre, mean over the step a -> b, in B.
Vector3d CalcLeverAcceleration(const TruthState& a, const TruthState& b, const Vector3d& p_BP, double dt_s) {
  const Turning turning = CalcTurning(a, b, dt_s);
  return turning.w_dot.cross(p_BP) + turning.w.cross(turning.w.cross(p_BP));
}

Matrix3d CalcLeverTensor(const Vector3d& w, const Vector3d& w_dot) {
  const Matrix3d W = Skew(w);
  return Skew(w_dot) + W * W;
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

Matrix3d CalcMeanLeverTensor(const TruthWindow& window, TrueTime begin, TrueTime end) {
  const double dt = window.rate().Period_s();
  double steps = 0;
  Matrix3d sum = Matrix3d::Zero();
  ForEachStep(window, begin, end,
              [&](const TruthState& a, const TruthState& b, double from, double to, std::int64_t) {
                const Turning turning = CalcTurning(a, b, dt);
                steps += to - from;
                sum += (to - from) * CalcLeverTensor(turning.w, turning.w_dot);
              });
  return sum / steps;
}

ImuSignal CalcImuStep(const TruthState& a, const TruthState& b, const Vector3d& p_BP, double dt_s) {
  const Turning turning = CalcTurning(a, b, dt_s);
  const Matrix3d tensor = CalcLeverTensor(turning.w, turning.w_dot);
  return {turning.w, IntegrateCentre(a, b, 0, 1) + tensor * p_BP, tensor};
}

ImuSignal CalcImuInstant(const TruthWindow& window, TrueTime t, const Vector3d& p_BP) {
  const std::int64_t n = std::min(window.StepAt(t) + 1, window.last());
  const TruthState state = Interpolate(window, t);
  const Turning turning = CalcTurning(window.at(n - 1), window.at(n), window.rate().Period_s());
  const Matrix3d tensor = CalcLeverTensor(state.w_WB_B, turning.w_dot);
  return {state.w_WB_B, state.f_WB_B + tensor * p_BP, tensor};
}

}  // namespace piperun::sim
