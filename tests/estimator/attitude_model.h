#pragma once

#include <cmath>
#include <vector>

#include "base/random.h"
#include "estimator/attitude_filter.h"
#include "estimator/attitude_model.h"
#include "tests/estimator/rolling_ball.h"

namespace piperun::estimator::testing {

/// One interval of a sensor that is what the filters' model says, with its truth at the interval's end.
struct ModelStep {
  ImuStep imu;
  Quaterniond q_WS;
  Vector3d bias_S;
  std::optional<Vector3d> field_S_T;
};

struct ModelRecord {
  Quaterniond q_WS_start;
  std::vector<ModelStep> steps;
};

/// The numbers of a model world and of the start's error. Deviations of zero leave a noise out.
struct ModelWorld {
  AttitudeModelParams params;
  double dt_s = 0.01;
  int count = 4000;
  Vector3d start_sd_W_rad{0.05, 0.05, 0.08};
  double tumble_rad_s = 2;
};

/// Parameters that say what the world does, without gates.
inline ModelWorld MatchedWorld(double motion_sd_m_s2) {
  ModelWorld world;
  AttitudeModelParams& p = world.params;
  p.gyro_noise_rad_s_sqrtHz = 1e-3;
  p.gyro_bias_sd_rad_s = 0.01;
  p.gyro_bias_walk_rad_s2_sqrtHz = 2e-4;
  p.accelerometer_noise_m_s2_sqrtHz = 0.02;
  p.motion_acceleration_sd_m_s2 = motion_sd_m_s2;
  p.motion_correlation_s = 0.5;
  p.magnetometer_sd_T = 0.5e-6;
  p.gate_probability = 1 - 1e-12;
  return world;
}

/// A sensor that tumbles about a wandering axis, its rate constant over each interval.
inline Vector3d TumbleRate(const ModelWorld& world, double t_s) {
  return world.tumble_rad_s *
         Vector3d(std::cos(0.9 * t_s), std::sin(0.7 * t_s), 0.6 * std::cos(0.31 * t_s + 1));
}

/// The filters' own model, drawn: bias a random walk from its prior, acceleration first-order Gauss-Markov in
/// W from zero, gyro, accelerometer and magnetometer (every fourth interval) with white noise.
inline ModelRecord DrawModel(const ModelWorld& world, std::uint64_t seed) {
  const AttitudeModelParams& p = world.params;
  const RandomStream random(seed, "model", 0);
  const double dt = world.dt_s, c = std::exp(-dt / p.motion_correlation_s);
  Quaterniond q = ExpSO3({0.4, -0.9, 1.3});
  Vector3d bias = p.gyro_bias_sd_rad_s * Normal3(random, 0, 0), a_W = Vector3d::Zero();
  ModelRecord record{q, {}};
  for (std::uint64_t k = 1; k <= static_cast<std::uint64_t>(world.count); ++k) {
    const Vector3d w = TumbleRate(world, static_cast<double>(k) * dt);
    const Quaterniond half = ExpSO3(0.5 * dt * w), q_mid = q * half;
    q = (q_mid * half).normalized();
    bias += p.gyro_bias_walk_rad_s2_sqrtHz * std::sqrt(dt) * Normal3(random, k, 0);
    a_W = c * a_W + p.motion_acceleration_sd_m_s2 * std::sqrt(1 - c * c) * Normal3(random, k, 1);
    ModelStep step{{}, q, bias, std::nullopt};
    step.imu.dt_s = dt;
    step.imu.w_S_rad_s = w + bias + p.gyro_noise_rad_s_sqrtHz / std::sqrt(dt) * Normal3(random, k, 2);
    step.imu.dtheta_S_rad = dt * step.imu.w_S_rad_s;
    step.imu.f_S_m_s2 = q_mid.conjugate() * (a_W + kGravity * Vector3d::UnitZ()) +
                        p.accelerometer_noise_m_s2_sqrtHz / std::sqrt(dt) * Normal3(random, k, 3);
    if (k % 4 == 0) step.field_S_T = q.conjugate() * kField_W_T + p.magnetometer_sd_T * Normal3(random, k, 4);
    record.steps.push_back(step);
  }
  return record;
}

/// The same sensor without any noise, bias or motion of its own.
inline ModelRecord DrawPerfect(ModelWorld world) {
  AttitudeModelParams& p = world.params;
  p.gyro_noise_rad_s_sqrtHz = p.gyro_bias_sd_rad_s = p.gyro_bias_walk_rad_s2_sqrtHz = 0;
  p.accelerometer_noise_m_s2_sqrtHz = p.motion_acceleration_sd_m_s2 = p.magnetometer_sd_T = 0;
  return DrawModel(world, 1);
}

/// Feeds a record; `visit(k, step)` after each interval.
template <class Visit>
void Feed(AttitudeFilter& filter, const ModelRecord& record, double motion_sd_m_s2, Visit&& visit) {
  for (std::size_t k = 0; k < record.steps.size(); ++k) {
    const ModelStep& step = record.steps[k];
    filter.Propagate(step.imu);
    filter.UpdateGravity(step.imu, motion_sd_m_s2);
    if (step.field_S_T) filter.UpdateMagnetic(*step.field_S_T, Vector3d::Zero());
    visit(k, step);
  }
}

inline double Error_rad(const AttitudeFilter& filter, const ModelStep& step) {
  return AttitudeError_W(step.q_WS, filter.q_WS()).norm();
}

}  // namespace piperun::estimator::testing
