#include "estimator/rest_alignment.h"

#include <cmath>

namespace piperun::estimator {

RestAlignment::RestAlignment(double duration_s, double gyro_noise_rad_s_sqrtHz, double gyro_bias_sd_rad_s)
    : duration_s_(duration_s), noise_(gyro_noise_rad_s_sqrtHz), bias_sd_(gyro_bias_sd_rad_s) {}

std::optional<RestAlignment::Result> RestAlignment::Step(const Vector3d& w_S_rad_s, double dt_s) {
  if (done_) return std::nullopt;
  const Vector3d angle_rad = halves_[0].angle_rad + halves_[1].angle_rad;
  const double elapsed_s = halves_[0].duration_s + halves_[1].duration_s;
  if (elapsed_s > 0) {
    const double variance = noise_ * noise_ * (1 / dt_s + 1 / elapsed_s);
    const Vector3d deviation = w_S_rad_s - angle_rad / elapsed_s;
    steady_ = steady_ && deviation.cwiseAbs().maxCoeff() < 6 * std::sqrt(variance);
  }
  Mean& half = halves_[elapsed_s < 0.5 * duration_s_ ? 0 : 1];
  half.angle_rad += w_S_rad_s * dt_s;
  half.duration_s += dt_s;
  if (elapsed_s + dt_s < duration_s_) return std::nullopt;
  done_ = true;
  return Result{Rested(), (halves_[0].angle_rad + halves_[1].angle_rad) / (elapsed_s + dt_s),
                elapsed_s + dt_s};
}

bool RestAlignment::Rested() const {
  if (!steady_ || halves_[1].duration_s == 0) return false;
  const Vector3d change = halves_[1].Rate() - halves_[0].Rate();
  const double variance = noise_ * noise_ * (1 / halves_[0].duration_s + 1 / halves_[1].duration_s);
  const Vector3d mean = 0.5 * (halves_[0].Rate() + halves_[1].Rate());
  return change.cwiseAbs().maxCoeff() < 4 * std::sqrt(variance) &&
         mean.cwiseAbs().maxCoeff() < 5 * std::hypot(bias_sd_, noise_ / std::sqrt(halves_[0].duration_s));
}

}  // namespace piperun::estimator
