#include "sim/imu_strapdown.h"

namespace piperun::sim {

void StrapdownSum::Next(const Vector3d& theta, const Vector3d& nu) {
  const Vector3d theta_before = started_ ? theta_ : theta;
  const Vector3d nu_before = started_ ? nu_ : nu;
  sculled_ = nu + (theta_before.cross(nu) + nu_before.cross(theta)) / 12;
  theta_ = theta;
  nu_ = nu;
  started_ = true;
}

void StrapdownSum::Begin() {
  q_begin_end_ = Quaterniond::Identity();
  dv_ = Vector3d::Zero();
}

void StrapdownSum::Add(double part) {
  const Vector3d theta = part * theta_;
  const Vector3d turned = theta.cross(sculled_);
  dv_ += part * (q_begin_end_ * (sculled_ + 0.5 * turned + theta.cross(turned) / 6));
  q_begin_end_ = q_begin_end_ * ExpSO3(theta);
}

}  // namespace piperun::sim
