#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/centreline.h"
#include "base/measurement.h"
#include "base/random.h"

namespace piperun::estimator::testing {

constexpr double kGravity = 9.80665;
constexpr double kDegree = std::numbers::pi / 180;
inline const Vector3d kField_W_T{2.6e-6, 25.1e-6, -40.4e-6};

/// What is true at the end of an IMU interval.
struct BallTruth {
  double t_s = 0;
  Quaterniond q_WB = Quaterniond::Identity();
  Vector3d p_W = Vector3d::Zero();
  Vector3d v_W = Vector3d::Zero();
  Vector3d w_W = Vector3d::Zero();
  double chainage_m = 0;
};

/// A noise-free IMU record (means over its intervals) with its truth; truth[0] is the start, truth[k + 1]
/// belongs to samples[k].
struct BallRecord {
  double rate_Hz = 0;
  std::vector<ImuSample> samples;
  std::vector<BallTruth> truth;
};

/// A ball that rolls without slipping or spinning about its contact normal, on the invert of a pipe with the
/// given centreline (or, with depth 0, on a plane), by exact kinematics: w = n x v / r, integrated in steps
/// of 1/8000 s by the exponential map, a and f from the path's curvature.
struct RollingBall {
  std::vector<CentrelinePiece> line;
  double radius_m = 0.03;
  double depth_m = 0;                       ///< centre below the axis: bore radius - ball radius
  std::function<double(double)> speed_m_s;  ///< of the chainage, at time t
  double duration_s = 0;
  Quaterniond q_WB_start = Quaterniond::Identity();

  double length_m() const { return line.back().s_end_m(); }
  BallRecord Roll(double rate_Hz) const;
};

struct CentreState {
  Vector3d p, tangent, normal;
  double stretch;  // d|p_centre| / ds
  Vector3d turn;   // d(tangent) / ds
};

inline CentreState EvalCentre(const RollingBall& ball, double s) {
  std::size_t i = 0;
  while (i + 1 < ball.line.size() && s >= ball.line[i].s_end_m()) ++i;
  const CentrelinePoint c = EvalCentreline(ball.line[i], s);
  const Vector3d n = (Vector3d::UnitZ() - c.tangent_W.z() * c.tangent_W).normalized();
  return {c.p_W - ball.depth_m * n, c.tangent_W, n, 1 + ball.depth_m * c.curvature_W.dot(n), c.curvature_W};
}

inline BallRecord RollingBall::Roll(double rate_Hz) const {
  const int fine = static_cast<int>(8000 / rate_Hz);
  const double h = 1 / (rate_Hz * fine);
  BallRecord record{rate_Hz, {}, {}};
  const auto centre_velocity = [&](double s, double t) -> Vector3d {
    const CentreState c = EvalCentre(*this, s);
    return speed_m_s(t) * c.stretch * c.tangent;
  };
  double s = 0;
  Quaterniond q = q_WB_start;
  record.truth.push_back({0, q, EvalCentre(*this, 0).p, Vector3d::Zero(), Vector3d::Zero(), 0});
  const auto count = static_cast<std::int64_t>(duration_s * rate_Hz);
  for (std::int64_t k = 0; k < count; ++k) {
    Vector3d w_sum = Vector3d::Zero(), f_sum = Vector3d::Zero(), v = Vector3d::Zero(), w = Vector3d::Zero();
    for (int i = 0; i < fine; ++i) {
      const double t_mid = (static_cast<double>(k * fine + i) + 0.5) * h;
      const double s_mid = s + 0.5 * h * speed_m_s(t_mid - 0.25 * h);
      const CentreState c = EvalCentre(*this, s_mid);
      v = centre_velocity(s_mid, t_mid);
      w = c.normal.cross(v) / radius_m;
      const double d = 0.5 * h;
      const Vector3d a = (centre_velocity(s_mid + d * speed_m_s(t_mid), t_mid + d) -
                          centre_velocity(s_mid - d * speed_m_s(t_mid), t_mid - d)) /
                         h;
      const Quaterniond half = ExpSO3(0.5 * h * w);
      const Quaterniond q_mid = half * q;
      w_sum += q_mid.conjugate() * w;
      f_sum += q_mid.conjugate() * (a + kGravity * Vector3d::UnitZ());
      q = (half * q_mid).normalized();
      s += h * speed_m_s(t_mid);
    }
    const RobotTime stamp(SampleOffset(k + 1, Rate(rate_Hz)));
    record.samples.push_back({stamp, w_sum / fine, f_sum / fine, std::nullopt});
    const CentreState c = EvalCentre(*this, s);
    record.truth.push_back({static_cast<double>(k + 1) / rate_Hz, q, c.p, v, w, s});
  }
  return record;
}

/// Errors of an IMU, drawn from one seed: turn-on bias and scale factor per axis, white noise.
struct ImuErrors {
  double gyro_noise_rad_s_sqrtHz = 0;
  double gyro_bias_sd_rad_s = 0;
  double gyro_scale_sd = 0;
  double accelerometer_noise_m_s2_sqrtHz = 0;
};

/// The grade the walks are required with.
inline constexpr ImuErrors kWalkGrade{0.01 * kDegree, 0.05 * kDegree, 1e-3, 200e-6 * kGravity};

inline Vector3d Normal3(const RandomStream& random, std::uint64_t sample, std::uint64_t slot) {
  const auto n = random.Normals(sample, slot);
  return {n[0], n[1], n[2]};
}

struct DrawnErrors {
  Vector3d gyro_bias, gyro_scale;
};

inline DrawnErrors Draw(const ImuErrors& errors, std::uint64_t seed) {
  const RandomStream random(seed, "imu", 0);
  return {errors.gyro_bias_sd_rad_s * Normal3(random, 0, 0), errors.gyro_scale_sd * Normal3(random, 0, 1)};
}

inline std::vector<ImuSample> Corrupt(const BallRecord& record, const ImuErrors& errors, std::uint64_t seed) {
  const RandomStream random(seed, "imu", 0);
  const DrawnErrors drawn = Draw(errors, seed);
  const double root = std::sqrt(record.rate_Hz);
  std::vector<ImuSample> samples = record.samples;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ImuSample& s = samples[k];
    s.w_WS_S_rad_s += drawn.gyro_scale.cwiseProduct(s.w_WS_S_rad_s) + drawn.gyro_bias +
                      errors.gyro_noise_rad_s_sqrtHz * root * Normal3(random, k, 2);
    s.f_WS_S_m_s2 += errors.accelerometer_noise_m_s2_sqrtHz * root * Normal3(random, k, 3);
  }
  return samples;
}

/// Magnetometer at every `every`-th IMU stamp, from the truth.
inline MagSample Magnetometer(const BallTruth& truth, RobotTime stamp, double sd_T, std::uint64_t seed,
                              std::uint64_t k) {
  const RandomStream random(seed, "mag", 0);
  return {stamp, truth.q_WB.conjugate() * kField_W_T + sd_T * Normal3(random, k, 0)};
}

/// Error rotation in W: R_true = Exp(e) R_estimated.
inline Vector3d AttitudeError_W(const Quaterniond& truth, const Quaterniond& estimate) {
  return LogSO3(truth * estimate.conjugate());
}

inline double Median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.size() % 2 ? v[v.size() / 2] : 0.5 * (v[v.size() / 2 - 1] + v[v.size() / 2]);
}

}  // namespace piperun::estimator::testing
