#include "estimator/mahony.h"

#include <cmath>

#include "estimator/attitude_rate.h"

namespace piperun::estimator {

void MahonyParams::Visit(ParamVisitor& v) {
  v.Number({"kp_rad_s", "How fast accelerometer and magnetometer turn the attitude."}, Range::NonNegative(),
           kp_rad_s);
  v.Number({"ki_rad_s2", "How fast they change the gyro's bias."}, Range::NonNegative(), ki_rad_s2);
}

void Mahony::Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, double dt_s) {
  const Vector3d up_S = CalcUp_S(q_MS_);
  Turn(w_S_rad_s, Direction(f_S).cross(up_S), dt_s);
}

void Mahony::Step(const Vector3d& w_S_rad_s, const Vector3d& f_S, const Vector3d& m_S, double dt_s) {
  const Vector3d a = Direction(f_S), m = Direction(m_S);
  if (a.isZero(0) || m.isZero(0)) return Step(w_S_rad_s, f_S, dt_s);
  const Vector3d h = q_MS_ * m;
  const Vector3d b_M(std::sqrt(h.x() * h.x() + h.y() * h.y()), 0, h.z());
  Turn(w_S_rad_s, a.cross(CalcUp_S(q_MS_)) + m.cross(q_MS_.conjugate() * b_M), dt_s);
}

void Mahony::Turn(const Vector3d& w_S_rad_s, const Vector3d& error, double dt_s) {
  bias_S_rad_s_ -= params_.ki_rad_s2 * dt_s * error;
  const Vector3d w = w_S_rad_s - bias_S_rad_s_ + params_.kp_rad_s * error;
  q_MS_ = StepEuler(q_MS_, CalcAttitudeRate(q_MS_, w), dt_s);
}

}  // namespace piperun::estimator
