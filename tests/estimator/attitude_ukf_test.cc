#include "estimator/attitude_ukf.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <vector>

#include "estimator/attitude_iekf.h"
#include "tests/estimator/attitude_model.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the model world

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Matrix3d Rotation(const Vector3d& v) {
  const double angle = v.norm();
  return angle == 0 ? Matrix3d(Matrix3d::Identity()) : Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

/// The unscented transform as the books have it, with lambda = alpha^2 (n + kappa) - n for n = 6, kappa = 0,
/// alpha = 0.1, beta = 2; rotation matrices.
struct PlainUkf {
  static constexpr double kLambda = 0.01 * 6 - 6;
  AttitudeModelParams p;
  Matrix3d R, R_mid = Matrix3d::Identity();
  Vector3d b = Vector3d::Zero();
  Matrix6d P = Matrix6d::Zero();

  std::vector<Vector6d> Points() const {
    const Matrix6d L = Matrix6d((6 + kLambda) * P).llt().matrixL();
    std::vector<Vector6d> points{Vector6d::Zero()};
    for (int i = 0; i < 6; ++i) points.push_back(L.col(i));
    for (int i = 0; i < 6; ++i) points.push_back(-L.col(i));
    return points;
  }
  static double Mean(std::size_t i) { return i == 0 ? kLambda / (6 + kLambda) : 0.5 / (6 + kLambda); }
  static double Spread(std::size_t i) { return Mean(i) + (i == 0 ? 1 - 0.01 + 2 : 0); }

  void Correct(const Vector6d& dx) {
    R = Rotation(dx.head<3>()) * R;
    b += dx.tail<3>();
  }
  void Propagate(const ImuStep& step) {
    const auto points = Points();
    const Vector3d turn = step.dtheta_S_rad - b * step.dt_s;
    const Matrix3d R_new = R * Rotation(turn);
    R_mid = R * Rotation(0.5 * turn);
    std::vector<Vector6d> after;
    Vector6d mean = Vector6d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Matrix3d R_i =
          Rotation(points[i].head<3>()) * R * Rotation(turn - step.dt_s * points[i].tail<3>());
      const Eigen::AngleAxisd off(Matrix3d(R_i * R_new.transpose()));
      Vector6d x;
      x << off.angle() * off.axis(), points[i].tail<3>();
      after.push_back(x);
      mean += Mean(i) * x;
    }
    P.setZero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      P += Spread(i) * (after[i] - mean) * (after[i] - mean).transpose();
    }
    Vector6d Q;
    Q << Vector3d::Constant(p.gyro_noise_rad_s_sqrtHz * p.gyro_noise_rad_s_sqrtHz * step.dt_s),
        Vector3d::Constant(p.gyro_bias_walk_rad_s2_sqrtHz * p.gyro_bias_walk_rad_s2_sqrtHz * step.dt_s);
    P.diagonal() += Q;
    R = R_new;
    Correct(mean);
  }
  void Gravity(const ImuStep& step) {
    const auto points = Points();
    std::vector<Vector3d> y;
    Vector3d mean = Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      y.push_back(Rotation(-points[i].head<3>()) * Vector3d::UnitZ());
      mean += Mean(i) * y[i];
    }
    double r = p.accelerometer_noise_m_s2_sqrtHz * p.accelerometer_noise_m_s2_sqrtHz / step.dt_s / kGravity /
               kGravity;
    const double excess = step.f_S_m_s2.norm() / kGravity - 1;
    r += std::max(0.0, excess * excess - 9 * r);
    Matrix3d S = r * Matrix3d::Identity();
    Eigen::Matrix<double, 6, 3> C = Eigen::Matrix<double, 6, 3>::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      S += Spread(i) * (y[i] - mean) * (y[i] - mean).transpose();
      C += Spread(i) * points[i] * (y[i] - mean).transpose();
    }
    const Eigen::Matrix<double, 6, 3> K = C * S.inverse();
    P -= K * S * K.transpose();
    Correct(K * (R_mid * step.f_S_m_s2 / kGravity - mean));
  }
};

TEST(AttitudeUkf, FollowsTheUnscentedTransformSampleBySample) {
  ModelWorld world = MatchedWorld(0);
  world.count = 1000;
  const ModelRecord record = DrawModel(world, 5);
  AttitudeUkf filter(world.params, kGravity, Vector3d::Zero());
  const Quaterniond start = ExpSO3({0.03, -0.04, 0.1}) * record.q_WS_start;
  filter.Align(start, world.start_sd_W_rad);
  PlainUkf plain{world.params, start.toRotationMatrix()};
  plain.P.diagonal() << world.start_sd_W_rad.cwiseAbs2(),
      Vector3d::Constant(world.params.gyro_bias_sd_rad_s * world.params.gyro_bias_sd_rad_s);
  for (const ModelStep& step : record.steps) {
    filter.Propagate(step.imu);
    filter.UpdateGravity(step.imu, 0);
    plain.Propagate(step.imu);
    plain.Gravity(step.imu);
    ASSERT_LT((filter.q_WS().toRotationMatrix() - plain.R).norm(), 1e-8);
    ASSERT_LT((filter.gyro_bias_S_rad_s() - plain.b).norm(), 1e-8);
    ASSERT_LT((filter.covariance() - plain.P).norm(), 1e-7 * plain.P.norm());
  }
}

/// Where the errors are small nothing bends, and both filters are the linear one.
TEST(AttitudeUkf, IsTheInvariantFilterWhereErrorsAreSmall) {
  ModelWorld world = MatchedWorld(0);
  AttitudeModelParams& p = world.params;
  p.gyro_noise_rad_s_sqrtHz = p.gyro_bias_sd_rad_s = 1e-6;
  p.gyro_bias_walk_rad_s2_sqrtHz = 1e-7;
  p.accelerometer_noise_m_s2_sqrtHz = 1e-5;
  p.magnetometer_sd_T = 1e-10;
  world.start_sd_W_rad.setConstant(1e-5);
  const ModelRecord record = DrawModel(world, 2);
  AttitudeUkf filter(p, kGravity, kField_W_T);
  AttitudeIekf linear(p, kGravity, kField_W_T);
  filter.Align(record.q_WS_start, world.start_sd_W_rad);
  linear.Align(record.q_WS_start, world.start_sd_W_rad);
  Feed(linear, record, 0, [](std::size_t, const ModelStep&) {});
  Feed(filter, record, 0, [](std::size_t, const ModelStep&) {});
  EXPECT_LT(AttitudeError_W(linear.q_WS(), filter.q_WS()).norm(), 1e-9);
  EXPECT_LT((linear.covariance() - filter.covariance()).norm(), 1e-3 * linear.covariance().norm());
}

TEST(AttitudeUkf, RootOfASingularCovarianceIsARoot) {
  Matrix6d A = Matrix6d::Zero();
  A.leftCols<3>() << 1, 2, 3, 0, 1, 4, 0, 0, 0, 2, 1, 0, 1, 1, 1, 5, 0, 2;
  const Matrix6d P = A * A.transpose();
  const Matrix6d L = CalcRoot(P);
  EXPECT_LT((L * L.transpose() - P).norm(), 1e-12 * P.norm());
  EXPECT_EQ(CalcRoot(Matrix6d::Zero()), Matrix6d(Matrix6d::Zero()));
}

}  // namespace
}  // namespace piperun::estimator
