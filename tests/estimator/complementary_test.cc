// Madgwick's and Mahony's filters against their equations, written down here once more in matrix form.

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "estimator/madgwick.h"
#include "estimator/mahony.h"

namespace piperun::estimator {
namespace {

constexpr double kDt = 0.01;
const Vector3d kField_M(20e-6, 0, -40e-6);

struct Sample {
  Vector3d w, f, m;
};

/// A sensor that turns at 2 rad/s about an axis that wanders, with noise.
Sample DrawSample(const RandomStream& random, std::uint64_t k, Quaterniond& truth) {
  const auto n = random.Normals(k, 0), o = random.Normals(k, 1), p = random.Normals(k, 2);
  const double t = static_cast<double>(k) * kDt;
  const Vector3d w(2 * std::cos(t), 2 * std::sin(0.7 * t), 0.5);
  truth = truth * ExpSO3(w * kDt);
  return {w + 0.01 * Vector3d(n[0], n[1], n[2]),
          truth.conjugate() * Vector3d(0, 0, 9.81) + 0.3 * Vector3d(o[0], o[1], o[2]),
          truth.conjugate() * kField_M + 1e-6 * Vector3d(p[0], p[1], p[2])};
}

using Jacobian = Eigen::Matrix<double, 3, 4>;

/// f(q, d, s) = R(q)^T d - s, in the form of eq. 20 of Madgwick's report (q_1 .. q_4 there are w .. z).
Vector3d Objective(const Eigen::Vector4d& q, const Vector3d& d, const Vector3d& s) {
  const double a = q[0], b = q[1], c = q[2], e = q[3];
  return {
      2 * d.x() * (0.5 - c * c - e * e) + 2 * d.y() * (a * e + b * c) + 2 * d.z() * (b * e - a * c) - s.x(),
      2 * d.x() * (b * c - a * e) + 2 * d.y() * (0.5 - b * b - e * e) + 2 * d.z() * (a * b + c * e) - s.y(),
      2 * d.x() * (a * c + b * e) + 2 * d.y() * (c * e - a * b) + 2 * d.z() * (0.5 - b * b - c * c) - s.z()};
}

/// Its Jacobian by differences; quadratic in q, so that central ones are exact but for rounding.
Jacobian Differentiate(const Eigen::Vector4d& q, const Vector3d& d, const Vector3d& s) {
  Jacobian J;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d step = 0.5 * Eigen::Vector4d::Unit(i);
    J.col(i) = Objective(q + step, d, s) - Objective(q - step, d, s);
  }
  return J;
}

/// 1/2 q (0, w), by the matrix that multiplies from the right.
Eigen::Vector4d Rate(const Eigen::Vector4d& q, const Vector3d& w) {
  Eigen::Matrix4d right;
  right << 0, -w.x(), -w.y(), -w.z(), w.x(), 0, w.z(), -w.y(), w.y(), -w.z(), 0, w.x(), w.z(), w.y(), -w.x(),
      0;
  return 0.5 * right * q;
}

Eigen::Vector4d ToVector(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

Vector3d Reference(const Quaterniond& q, const Vector3d& m) {
  const Vector3d h = q.toRotationMatrix() * m.normalized();
  return {h.head<2>().norm(), 0, h.z()};
}

class Madgwicks : public testing::TestWithParam<bool> {};

TEST_P(Madgwicks, FollowTheReportsEquationsSampleBySample) {
  const bool published = GetParam();
  Madgwick filter({.beta_rad_s = 0.1, .published = published});
  const RandomStream random(1, "madgwick", 0);
  Quaterniond truth = ExpSO3({0.3, -0.2, 1});
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const Sample sample = DrawSample(random, k, truth);
    const Eigen::Vector4d q = ToVector(filter.q_MS());
    const bool magnetic = k % 3 == 0;
    const Vector3d up = Vector3d::UnitZ(), a = sample.f.normalized(), m = sample.m.normalized();
    Eigen::Vector4d gradient = Differentiate(q, up, a).transpose() * Objective(q, up, a);
    if (magnetic) {
      const Vector3d b = (published ? 0.5 : 1) * Reference(filter.q_MS(), sample.m);
      gradient += Differentiate(q, b, m).transpose() * Objective(q, b, m);
      filter.Step(sample.w, sample.f, sample.m, kDt);
    } else {
      filter.Step(sample.w, sample.f, kDt);
    }
    const Eigen::Vector4d expected =
        (q + (Rate(q, sample.w) - 0.1 * gradient.normalized()) * kDt).normalized();
    ASSERT_LT((ToVector(filter.q_MS()) - expected).norm(), 1e-12) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Madgwick, Madgwicks, testing::Bool(), [](const auto& info) {
  return info.param ? std::string("AsPublished") : std::string("Corrected");
});

TEST(Mahony, FollowsItsEquationsSampleBySample) {
  Mahony filter({.kp_rad_s = 0.5, .ki_rad_s2 = 0.1});
  const RandomStream random(2, "mahony", 0);
  Quaterniond truth = ExpSO3({0.3, -0.2, 1});
  Vector3d bias = Vector3d::Zero();
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const Sample sample = DrawSample(random, k, truth);
    const Quaterniond q = filter.q_MS();
    const Matrix3d R = q.toRotationMatrix();
    const bool magnetic = k % 3 == 0;
    Vector3d error = sample.f.normalized().cross(R.transpose() * Vector3d::UnitZ());
    if (magnetic) error += sample.m.normalized().cross(R.transpose() * Reference(q, sample.m));
    bias -= 0.1 * error * kDt;
    if (magnetic) {
      filter.Step(sample.w, sample.f, sample.m, kDt);
    } else {
      filter.Step(sample.w, sample.f, kDt);
    }
    const Eigen::Vector4d expected =
        (ToVector(q) + Rate(ToVector(q), sample.w - bias + 0.5 * error) * kDt).normalized();
    ASSERT_LT((ToVector(filter.q_MS()) - expected).norm(), 1e-12) << k;
    ASSERT_LT((filter.bias_S_rad_s() - bias).norm(), 1e-12);
  }
}

/// Angle by which the filter is off when a resting sensor without noise has been watched for five minutes.
template <class Filter>
double Settle(Filter filter) {
  const Quaterniond truth = ExpSO3({0.4, -0.3, 0.8});
  const Vector3d f = truth.conjugate() * Vector3d(0, 0, 9.81), m = truth.conjugate() * kField_M;
  for (int k = 0; k < 30000; ++k) filter.Step(Vector3d::Zero(), f, m, kDt);
  return filter.q_MS().angularDistance(truth);
}

TEST(Madgwick, FindsTheAttitudeAtRest) {
  EXPECT_LT(Settle(Madgwick({.beta_rad_s = 0.1})), 0.1 * kDt);  // it goes to and fro by one step
}

TEST(Mahony, FindsTheAttitudeAtRest) { EXPECT_LT(Settle(Mahony({.kp_rad_s = 1, .ki_rad_s2 = 0})), 1e-6); }

TEST(Mahony, FindsTheBias) {
  Mahony filter({.kp_rad_s = 1, .ki_rad_s2 = 0.3});
  const Vector3d bias(0.01, -0.02, 0.015), f(0, 0, 9.81);
  for (int k = 0; k < 20000; ++k) filter.Step(bias, f, kField_M, kDt);
  EXPECT_LT((filter.bias_S_rad_s() - bias).norm(), 1e-6);
}

// the gradient is exactly zero here: the copied code divides by it
TEST(Madgwick, StaysFiniteOnPerfectInput) {
  for (const bool published : {false, true}) {
    Madgwick filter({.beta_rad_s = 0.1, .published = published});
    for (int k = 0; k < 10; ++k) {
      filter.Step(Vector3d::Zero(), {0, 0, 9.81}, kDt);
      filter.Step(Vector3d::Zero(), {0, 0, 9.81}, kField_M, kDt);
      filter.Step(Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), kDt);
    }
    EXPECT_TRUE(filter.q_MS().coeffs().allFinite());
    EXPECT_NEAR(filter.q_MS().norm(), 1, 1e-15);
  }
}

}  // namespace
}  // namespace piperun::estimator
