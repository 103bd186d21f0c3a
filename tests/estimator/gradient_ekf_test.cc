// The thesis' filter against its equations, written down here once more.

#include "estimator/gradient_ekf.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/random.h"

namespace piperun::estimator {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr double kDt = 0.01;
const Vector3d kField_M(20e-6, 0, -40e-6);

Vector4d ToVector(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// Eqs 5.33 and 5.39: R^T d - s, d = (d_x, 0, d_z).
Vector3d Objective(const Vector4d& q, double d_x, double d_z, const Vector3d& s) {
  return {2 * d_x * (0.5 - q[2] * q[2] - q[3] * q[3]) + 2 * d_z * (q[1] * q[3] - q[0] * q[2]) - s.x(),
          2 * d_x * (q[1] * q[2] - q[0] * q[3]) + 2 * d_z * (q[0] * q[1] + q[2] * q[3]) - s.y(),
          2 * d_x * (q[0] * q[2] + q[1] * q[3]) + 2 * d_z * (0.5 - q[1] * q[1] - q[2] * q[2]) - s.z()};
}

/// Its Jacobian: quadratic in q, so that central differences are exact but for rounding.
Eigen::Matrix<double, 3, 4> Differentiate(const Vector4d& q, double d_x, double d_z) {
  Eigen::Matrix<double, 3, 4> J;
  for (int i = 0; i < 4; ++i) {
    const Vector4d step = 0.5 * Vector4d::Unit(i);
    J.col(i) =
        Objective(q + step, d_x, d_z, Vector3d::Zero()) - Objective(q - step, d_x, d_z, Vector3d::Zero());
  }
  return J;
}

struct PlainGradientEkf {
  GradientEkfParams p;
  Vector4d x;
  Matrix4d P = 0.1 * Matrix4d::Identity();

  static Matrix4d Omega(const Vector3d& w) {
    Matrix4d m;
    m << 0, -w.x(), -w.y(), -w.z(), w.x(), 0, w.z(), -w.y(), w.y(), -w.z(), 0, w.x(), w.z(), w.y(), -w.x(), 0;
    return m;
  }
  void Step(const Vector3d& w, const Vector3d& f, const Vector3d* m) {
    const Quaterniond q(x[0], x[1], x[2], x[3]);
    Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
    Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
    J.topRows<3>() = Differentiate(x, 0, 1);
    error.head<3>() = Objective(x, 0, 1, f.normalized());
    if (m) {
      const Vector3d h = q.toRotationMatrix() * m->normalized();
      J.bottomRows<3>() = Differentiate(x, h.head<2>().norm(), h.z());
      error.tail<3>() = Objective(x, h.head<2>().norm(), h.z(), m->normalized());
    }
    const Vector4d gradient = J.transpose() * error, d = gradient.normalized();
    const double mu =
        p.printed ? p.alpha * (0.5 * Omega(w) * x).norm() * kDt : gradient.norm() / (J * d).squaredNorm();
    Vector4d z = (x - mu * d).normalized();
    Matrix4d F = Matrix4d::Identity() + 0.5 * kDt * Omega(w);
    if (p.printed) {
      F(2, 1) = 0.5 * kDt * w.z();
    } else {
      const double half = 0.5 * kDt * w.norm();
      F = std::cos(half) * Matrix4d::Identity() + std::sin(half) / w.norm() * Omega(w);
      z = F * z;
    }
    const double N2 = p.gyro_noise_rad_s_sqrtHz * p.gyro_noise_rad_s_sqrtHz;
    P = F * P * F.transpose() + 0.25 * N2 * kDt * (Matrix4d::Identity() - x * x.transpose());
    x = F * x;
    const Matrix4d K = P * (P + p.observation_sd * p.observation_sd * Matrix4d::Identity()).inverse();
    x = (x + K * (z - x)).normalized();
    P -= K * P;
  }
};

class GradientEkfs : public testing::TestWithParam<bool> {};

TEST_P(GradientEkfs, FollowTheThesisSampleBySample) {
  const GradientEkfParams params{.printed = GetParam()};
  GradientEkf filter(params);
  const RandomStream random(1, "gradient", 0);
  Quaterniond truth = ExpSO3({0.3, -0.2, 1});
  filter.Set(truth);
  PlainGradientEkf plain{params, ToVector(truth)};
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const auto n = random.Normals(k, 0), o = random.Normals(k, 1), r = random.Normals(k, 2);
    const double t = static_cast<double>(k) * kDt;
    const Vector3d w =
        Vector3d(2 * std::cos(t), 2 * std::sin(0.7 * t), 0.5) + 0.01 * Vector3d(n[0], n[1], n[2]);
    const Vector3d f = truth.conjugate() * Vector3d(0, 0, 9.81) + 0.3 * Vector3d(o[0], o[1], o[2]);
    const Vector3d m = truth.conjugate() * kField_M + 1e-6 * Vector3d(r[0], r[1], r[2]);
    truth = (truth * ExpSO3(w * kDt)).normalized();
    if (k % 3 == 0) {
      filter.Step(w, f, m, kDt);
      plain.Step(w, f, &m);
    } else {
      filter.Step(w, f, kDt);
      plain.Step(w, f, nullptr);
    }
    ASSERT_LT((ToVector(filter.q_MS()) - plain.x).norm(), 1e-8) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, GradientEkfs, testing::Bool(), [](const auto& info) {
  return info.param ? std::string("AsPrinted") : std::string("Corrected");
});

/// Angle by which the filter is off when a resting sensor without noise has been watched for five minutes.
double Settle(bool printed) {
  GradientEkf filter({.printed = printed});
  const Quaterniond truth = ExpSO3({0.4, -0.3, 0.8});
  const Vector3d f = truth.conjugate() * Vector3d(0, 0, 9.81), m = truth.conjugate() * kField_M;
  for (int k = 0; k < 30000; ++k) filter.Step(Vector3d::Zero(), f, m, kDt);
  return filter.q_MS().angularDistance(truth);
}

TEST(GradientEkf, FindsTheAttitudeAtRest) { EXPECT_LT(Settle(false), 1e-6); }

/// mu = alpha |q_dot| dt is zero there: it stays 0.94 rad away, where it started.
TEST(GradientEkf, AsPrintedNeverCorrectsASensorAtRest) {
  EXPECT_NEAR(Settle(true), Vector3d(0.4, -0.3, 0.8).norm(), 1e-9);
}

/// The largest angle by which it is off while it turns about z, then x, at 3 rad/s on perfect input.
double FollowTurns(bool printed) {
  GradientEkf filter({.printed = printed});
  Quaterniond truth = Quaterniond::Identity();
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vector3d w = k < 1000 ? Vector3d(0.5, 0, 3) : Vector3d(3, 0, 0.5);
    filter.Step(w, truth.conjugate() * Vector3d(0, 0, 9.81), truth.conjugate() * kField_M, kDt);
    truth = (truth * ExpSO3(w * kDt)).normalized();
    worst = std::max(worst, filter.q_MS().angularDistance(truth));
  }
  return worst;
}

TEST(GradientEkf, FollowsAConstantRateAndAsPrintedDoesNot) {
  EXPECT_LT(FollowTurns(false), 1e-7);
  EXPECT_GT(FollowTurns(true), 0.1);
}

TEST(GradientEkf, StaysFiniteOnPerfectInputAndOnNone) {
  for (const bool printed : {false, true}) {
    GradientEkf filter({.printed = printed});
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
