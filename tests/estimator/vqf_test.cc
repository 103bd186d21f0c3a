#include "estimator/vqf.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/estimator/allocation_counter.h"
#include "tests/estimator/attitude_model.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the model world

ImuStep AtRest(const Quaterniond& q_WS, const Vector3d& bias) {
  ImuStep step;
  step.dt_s = 0.01;
  step.w_S_rad_s = bias;
  step.dtheta_S_rad = bias * step.dt_s;
  step.f_S_m_s2 = q_WS.conjugate() * Vector3d(0, 0, kGravity);
  return step;
}

/// y'' = 2 (u - y) / tau^2 - 2 y' / tau in a hundred thousand parts of a second, by the midpoint rule.
TEST(MeanLowPass, SolvesItsDifferentialEquationForStepsOfAnyLength) {
  const double tau = 0.5;
  MeanLowPass<1> filter(tau);
  using Vector = MeanLowPass<1>::Vector;
  filter.Step(Vector(1.0), 0.2);
  EXPECT_DOUBLE_EQ(filter.Step(Vector(4.0), 0.4)[0], 3.0);  // (1 * 0.2 + 4 * 0.4) / 0.6
  double y = 3, dy = 0;
  for (const double dt : {0.01, 0.03, 0.5, 0.01, 0.02}) {
    const double u = 10 * dt, h = 1e-5;
    for (int i = 0; i < static_cast<int>(std::lround(dt / h)); ++i) {
      const auto ddy = [&](double at, double rate) { return 2 * (u - at) / (tau * tau) - 2 * rate / tau; };
      const double dy_mid = dy + 0.5 * h * ddy(y, dy), y_mid = y + 0.5 * h * dy;
      y += h * dy_mid;
      dy += h * ddy(y_mid, dy_mid);
    }
    EXPECT_NEAR(filter.Step(Vector(u), dt)[0], y, 1e-8) << dt;
  }
}

/// Where its amplitude is 1/sqrt(2): sqrt(2) / (2 pi tau).
TEST(MeanLowPass, HasItsCornerWhereThePaperSays) {
  const double tau = 0.5, w = std::sqrt(2.0) / tau, dt = 1e-4;
  MeanLowPass<1> filter(tau);
  double largest = 0;
  for (int k = 0; k < 300000; ++k) {
    const double y = filter.Step(MeanLowPass<1>::Vector(std::sin(w * k * dt)), dt)[0];
    if (k > 200000) largest = std::max(largest, y);
  }
  EXPECT_NEAR(largest, std::sqrt(0.5), 1e-4);
}

TEST(Vqf, CorrectionBringsAnyForceToTheVerticalTheShortestWay) {
  for (const Vector3d& a :
       {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(-0.48, 0.6, -0.64), Vector3d(0, 0, -1)}) {
    const Quaterniond C = CalcInclinationCorrection(a);
    EXPECT_LT((C * a - Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_EQ(C.z(), 0);
    EXPECT_NEAR(LogSO3(C).norm(), std::acos(a.z()), 1e-12);
  }
}

/// VQF as published, section 3: rotation matrices, its own low pass as an explicit two-state system, no bias.
struct PlainVqf {
  Matrix3d R_IS = Matrix3d::Identity(), R_EI = Matrix3d::Identity();
  Vector3d y = Vector3d::Zero(), dy = Vector3d::Zero(), sum = Vector3d::Zero();
  double elapsed = 0;

  static Matrix3d Rotation(const Vector3d& v) {
    const double angle = v.norm();
    return angle == 0 ? Matrix3d(Matrix3d::Identity())
                      : Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
  }
  /// exp(A h) by its series, A = [0 1; -2/tau^2 -2/tau].
  static Eigen::Matrix2d Transition(double h, double tau) {
    Eigen::Matrix2d A, term = Eigen::Matrix2d::Identity(), sum = term;
    A << 0, 1, -2 / (tau * tau), -2 / tau;
    for (int i = 1; i < 20; ++i) {
      term = term * A * (h / i);
      sum += term;
    }
    return sum;
  }
  void Step(const ImuStep& step, const Vector3d& bias) {
    const double dt = step.dt_s;
    const Vector3d turn = step.dtheta_S_rad - bias * dt;
    const Vector3d f = R_IS * Rotation(0.5 * turn) * step.f_S_m_s2;
    R_IS = R_IS * Rotation(turn);
    if (elapsed < 3) {
      elapsed += dt;
      sum += f * dt;
      y = sum / elapsed;
    } else {
      const Eigen::Matrix2d T = Transition(dt, 3);
      const Vector3d off = y - f;
      y = f + T(0, 0) * off + T(0, 1) * dy;
      dy = T(1, 0) * off + T(1, 1) * dy;
    }
    const Vector3d a = (R_EI * y).normalized();
    const Vector3d axis = a.cross(Vector3d::UnitZ());
    if (axis.norm() > 0) R_EI = Rotation(axis.normalized() * std::atan2(axis.norm(), a.z())) * R_EI;
  }
};

/// The bias is the filter's own of the step before, so that all else is told apart.
TEST(Vqf, StrapdownAndInclinationFollowThePaperSampleBySample) {
  const ModelRecord record = DrawModel(MatchedWorld(0.3), 3);
  Vqf filter({}, {}, Vector3d::Zero());
  PlainVqf plain;
  plain.R_EI = CalcTilt(record.steps.front().imu.f_S_m_s2).toRotationMatrix();
  filter.AlignTilt(record.steps.front().imu.f_S_m_s2);
  for (const ModelStep& step : record.steps) {
    plain.Step(step.imu, filter.gyro_bias_S_rad_s());
    filter.Propagate(step.imu);
    filter.UpdateGravity(step.imu, 0.3);
    ASSERT_LT((filter.q_WS().toRotationMatrix() - plain.R_EI * plain.R_IS).norm(), 1e-10);
  }
}

/// The bias filter's equations once more, on given directions, with the low passes written as lists.
TEST(VqfBias, FollowsItsKalmanFilterSampleBySample) {
  const VqfBiasParams params;
  VqfBias filter(params);
  const RandomStream random(4, "vqf", 0);
  const double dt = 0.01, v = std::pow(0.1 * kDegree, 2) / params.forgetting_s;
  MeanLowPass<9> C_filter(3);
  MeanLowPass<2> b_filter(3);
  Vector3d b = Vector3d::Zero();
  Matrix3d P = std::pow(params.start_sd_rad_s, 2) * Matrix3d::Identity();
  Quaterniond q = Quaterniond::Identity();
  for (std::uint64_t k = 0; k < 2000; ++k) {
    q = (q * ExpSO3(0.05 * Normal3(random, k, 0))).normalized();
    const Matrix3d R = q.toRotationMatrix();
    const Vector3d a = (Vector3d::UnitZ() + 1e-4 * Normal3(random, k, 1)).normalized();
    const Vector3d w = 0.01 * Normal3(random, k, 2);
    const bool rest = k % 300 > 200;
    filter.Step(a, R, rest ? std::optional(w) : std::nullopt, dt);

    Eigen::Matrix<double, 9, 1> flat;
    for (int i = 0; i < 9; ++i) flat[i] = R(i / 3, i % 3);
    const auto C_flat = C_filter.Step(flat, dt);
    const Eigen::Vector2d Rb = b_filter.Step((R * b).head<2>(), dt);
    Matrix3d C;
    for (int i = 0; i < 9; ++i) C(i / 3, i % 3) = C_flat[i];
    const double p = std::pow(rest ? params.rest_sd_rad_s : params.motion_sd_rad_s, 2);
    Vector3d W = Vector3d::Constant(p * p / (v * dt) + p), y(-a.y() / dt + Rb.x(), a.x() / dt + Rb.y(), 0);
    if (rest) {
      C.setIdentity();
      y = w;
    } else {
      W.z() /= params.vertical_factor;
    }
    for (int i = 0; i < 3; ++i) P(i, i) += P(i, i) < std::pow(params.start_sd_rad_s, 2) ? v * dt : 0;
    Vector3d e = y - C * b;
    for (double& x : e) x = std::clamp(x, -params.limit_rad_s, params.limit_rad_s);
    const Matrix3d K = P * C.transpose() * (C * P * C.transpose() + Matrix3d(W.asDiagonal())).inverse();
    b += K * e;
    for (double& x : b) x = std::clamp(x, -params.limit_rad_s, params.limit_rad_s);
    P -= K * C * P;
    ASSERT_LT((filter.bias_S_rad_s() - b).norm(), 1e-12) << k;
    ASSERT_LT((filter.covariance() - P).norm(), 1e-9 * P.norm()) << k;
  }
}

TEST(Vqf, FindsTheAttitudeAtRestFromPerfectInput) {
  const Quaterniond q = ExpSO3({0.4, -0.3, 2.5});
  Vqf filter({}, {}, kField_W_T);
  filter.AlignTilt({0, 0, kGravity});  // wrong by the whole tilt
  for (int k = 0; k < 12000; ++k) {
    filter.Propagate(AtRest(q, Vector3d::Zero()));
    filter.UpdateGravity(AtRest(q, Vector3d::Zero()), 0);
    filter.UpdateMagnetic(q.conjugate() * kField_W_T, Vector3d::Zero());
    ASSERT_TRUE(filter.q_WS().coeffs().allFinite());
  }
  EXPECT_TRUE(filter.at_rest());
  EXPECT_FALSE(filter.disturbed());
  EXPECT_LT(AttitudeError_W(q, filter.q_WS()).norm(), 1e-5);
}

TEST(Vqf, FindsTheBiasAtRestOnEveryAxis) {
  const Quaterniond q = ExpSO3({0.4, -0.3, 2.5});
  const Vector3d bias(0.01, -0.02, 0.015);
  Vqf filter({}, {}, Vector3d::Zero());
  filter.AlignTilt(AtRest(q, bias).f_S_m_s2);
  for (int k = 0; k < 3000; ++k) {
    filter.Propagate(AtRest(q, bias));
    filter.UpdateGravity(AtRest(q, bias), 0);
  }
  EXPECT_LT((filter.gyro_bias_S_rad_s() - bias).norm(), 0.02 * bias.norm());
}

TEST(Vqf, FindsTheBiasInMotion) {
  ModelWorld world = MatchedWorld(0);
  world.tumble_rad_s = 0.3;  // slower than the low pass, which else sees little of a bias in S
  world.count = 120000;      // twelve times the forgetting time, C taking three quarters of the information
  ModelRecord record = DrawPerfect(world);
  const Vector3d bias(0.01, -0.012, 0.008);
  Vqf filter({}, {}, kField_W_T);
  filter.AlignTilt(record.steps.front().imu.f_S_m_s2);
  for (ModelStep& step : record.steps) {
    step.imu.w_S_rad_s += bias;
    step.imu.dtheta_S_rad += bias * step.imu.dt_s;
  }
  Feed(filter, record, 0, [](std::size_t, const ModelStep&) {});
  EXPECT_FALSE(filter.at_rest());
  EXPECT_LT((filter.gyro_bias_S_rad_s() - bias).norm(), 0.02 * bias.norm());
  EXPECT_LT(Error_rad(filter, record.steps.back()), 0.5 * kDegree);
}

/// A magnet for ten seconds: 50 % more field from elsewhere.
TEST(Vqf, LeavesAMagneticDisturbanceOut) {
  const ModelRecord record = DrawPerfect(MatchedWorld(0));
  ModelRecord disturbed = record;
  for (std::size_t k = 2500; k < 3500; ++k) {
    auto& m = disturbed.steps[k].field_S_T;
    if (m) *m += record.steps[k].q_WS.conjugate() * Vector3d(24e-6, 0, 0);
  }
  Vqf clean({}, {}, kField_W_T), filter({}, {}, kField_W_T);
  double worst = 0;
  bool seen = false;
  std::vector<Quaterniond> expected;
  Feed(clean, record, 0, [&](std::size_t, const ModelStep&) { expected.push_back(clean.q_WS()); });
  Feed(filter, disturbed, 0, [&](std::size_t k, const ModelStep&) {
    worst = std::max(worst, AttitudeError_W(expected[k], filter.q_WS()).norm());
    seen = seen || (k > 2600 && filter.disturbed());
  });
  EXPECT_TRUE(seen);
  // 24 of 25 uT would turn the heading by 40 degrees
  EXPECT_LT(worst, 0.3 * kDegree);
}

TEST(Vqf, FollowsAConstantRate) {
  Vqf filter({}, {}, Vector3d::Zero());
  const Vector3d w(3, -7, 11);
  Quaterniond q = CalcTilt(Vector3d(1, 2, 3));
  filter.AlignTilt(Vector3d(1, 2, 3));
  for (int k = 0; k < 2000; ++k) {
    ImuStep step;
    step.dt_s = 0.01;
    step.w_S_rad_s = w;
    step.dtheta_S_rad = w * step.dt_s;
    step.f_S_m_s2 = (q * ExpSO3(0.5 * step.dtheta_S_rad)).conjugate() * Vector3d(0, 0, kGravity);
    q = q * ExpSO3(step.dtheta_S_rad);
    filter.Propagate(step);
    filter.UpdateGravity(step, 0);
  }
  EXPECT_LT(AttitudeError_W(q, filter.q_WS()).norm(), 1e-9);
}

}  // namespace
}  // namespace piperun::estimator
