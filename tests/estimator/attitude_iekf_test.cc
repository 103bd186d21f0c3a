#include "estimator/attitude_iekf.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>

#include "tests/estimator/attitude_model.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the model world

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Mean of Exp(s phi) over s, by the midpoint rule.
Matrix3d MeanRotation(const Vector3d& phi) {
  constexpr int kParts = 2000;
  Matrix3d sum = Matrix3d::Zero();
  for (int i = 0; i < kParts; ++i) {
    sum += Eigen::AngleAxisd((i + 0.5) / kParts * phi.norm(), phi.normalized()).toRotationMatrix();
  }
  return sum / kParts;
}

TEST(AttitudeIekf, LeftJacobianIsTheMeanRotation) {
  for (const double angle : {1e-5, 0.009, 0.011, 0.5, 3.0}) {
    const Vector3d phi = angle * Vector3d(0.6, -0.64, 0.48);
    // the rule's own error: angle^2 / (24 parts^2)
    EXPECT_LT((CalcLeftJacobian(phi) - MeanRotation(phi)).norm(), 1e-9 + 3e-8 * angle * angle) << angle;
  }
}

/// Two filters off by the same rotation in W, on two trajectories, without bias: the errors stay the same, as
/// do the covariances, through gyro and gravity alike.
TEST(AttitudeIekf, ErrorAndCovarianceKnowNothingOfTheTrajectoryWithoutBias) {
  ModelWorld world = MatchedWorld(0);
  world.params.gyro_bias_sd_rad_s = world.params.gyro_bias_walk_rad_s2_sqrtHz = 0;
  const Vector3d off(0.3, -0.2, 0.5);
  std::array<std::vector<Vector3d>, 2> errors, propagated;
  std::array<std::vector<Matrix3d>, 2> covariances;
  for (int i = 0; i < 2; ++i) {
    world.tumble_rad_s = i == 0 ? 0 : 9;
    const ModelRecord record = DrawPerfect(world);
    AttitudeIekf filter(world.params, kGravity, kField_W_T), blind = filter;
    filter.Align(ExpSO3(-off) * record.q_WS_start, Vector3d::Constant(0.5));
    blind.Align(ExpSO3(-off) * record.q_WS_start, Vector3d::Constant(0.5));
    for (const ModelStep& step : record.steps) {
      blind.Propagate(step.imu);
      filter.Propagate(step.imu);
      filter.UpdateGravity(step.imu, 0);
      errors[i].push_back(AttitudeError_W(step.q_WS, filter.q_WS()));
      propagated[i].push_back(AttitudeError_W(step.q_WS, blind.q_WS()));
      covariances[i].push_back(filter.Covariance_W_rad2());
    }
  }
  for (std::size_t k = 0; k < errors[0].size(); ++k) {
    ASSERT_LT((propagated[0][k] - off).norm(), 1e-11);
    ASSERT_LT((propagated[1][k] - off).norm(), 1e-11);
    ASSERT_LT((errors[0][k] - errors[1][k]).norm(), 1e-11);
    ASSERT_LT((covariances[0][k] - covariances[1][k]).norm(), 1e-11);
  }
  EXPECT_LT(errors[0].back().head<2>().norm(), 1e-3);  // and gravity did its work
}

/// The published equations in whole 6 x 6 matrices: Phi by the midpoint rule in 400 parts of a step, all
/// three numbers of the observation, rotations by angle and axis, Joseph's form.
struct PlainIekf {
  AttitudeModelParams p;
  Matrix3d R;
  Vector3d b = Vector3d::Zero();
  Matrix6d P = Matrix6d::Zero();

  void Propagate(const ImuStep& step) {
    constexpr int kParts = 400;
    const Vector3d turn = step.dtheta_S_rad - b * step.dt_s;
    const Matrix3d R_begin = R;
    Matrix6d Phi = Matrix6d::Identity();
    for (int i = 0; i < kParts; ++i) {
      const double s = (i + 0.5) / kParts;
      Phi.topRightCorner<3, 3>() -=
          R_begin * Eigen::AngleAxisd(s * turn.norm(), turn.normalized()) * (step.dt_s / kParts);
    }
    Matrix6d Q = Matrix6d::Zero();
    Q.diagonal() << Vector3d::Constant(p.gyro_noise_rad_s_sqrtHz * p.gyro_noise_rad_s_sqrtHz * step.dt_s),
        Vector3d::Constant(p.gyro_bias_walk_rad_s2_sqrtHz * p.gyro_bias_walk_rad_s2_sqrtHz * step.dt_s);
    P = Phi * P * Phi.transpose() + Q;
    R = R * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  }
  void Gravity(const ImuStep& step) {
    const Vector3d turn = step.dtheta_S_rad - b * step.dt_s;
    const Matrix3d R_mid = R * Eigen::AngleAxisd(-0.5 * turn.norm(), turn.normalized());
    const Vector3d z = R_mid * step.f_S_m_s2 / kGravity - Vector3d::UnitZ();
    const double density = p.accelerometer_noise_m_s2_sqrtHz * p.accelerometer_noise_m_s2_sqrtHz;
    double r = density / step.dt_s / kGravity / kGravity;
    const double excess = step.f_S_m_s2.norm() / kGravity - 1;
    r += std::max(0.0, excess * excess - 9 * r);
    Eigen::Matrix<double, 3, 6> H = Eigen::Matrix<double, 3, 6>::Zero();
    H(0, 1) = -1;
    H(1, 0) = 1;
    const Matrix3d S = H * P * H.transpose() + r * Matrix3d::Identity();
    const Eigen::Matrix<double, 6, 3> K = P * H.transpose() * S.inverse();
    const Matrix6d L = Matrix6d::Identity() - K * H;
    P = L * P * L.transpose() + r * K * K.transpose();
    const Vector6d dx = K * z;
    R = Eigen::AngleAxisd(dx.head<3>().norm(), dx.head<3>().normalized()) * R;
    b += dx.tail<3>();
  }
};

TEST(AttitudeIekf, FollowsItsEquationsInWholeMatricesSampleBySample) {
  ModelWorld world = MatchedWorld(0);
  world.count = 1000;
  const ModelRecord record = DrawModel(world, 11);
  AttitudeIekf filter(world.params, kGravity, Vector3d::Zero());
  const Quaterniond start = ExpSO3({0.03, -0.04, 0.1}) * record.q_WS_start;
  filter.Align(start, world.start_sd_W_rad);
  PlainIekf plain{world.params, start.toRotationMatrix()};
  plain.P.diagonal() << world.start_sd_W_rad.cwiseAbs2(),
      Vector3d::Constant(world.params.gyro_bias_sd_rad_s * world.params.gyro_bias_sd_rad_s);
  for (const ModelStep& step : record.steps) {
    filter.Propagate(step.imu);
    filter.UpdateGravity(step.imu, 0);
    plain.Propagate(step.imu);
    plain.Gravity(step.imu);
    ASSERT_LT((filter.q_WS().toRotationMatrix() - plain.R).norm(), 1e-8);
    ASSERT_LT((filter.gyro_bias_S_rad_s() - plain.b).norm(), 1e-8);
    ASSERT_LT((filter.covariance() - plain.P).norm(), 1e-8 * plain.P.norm());
  }
}

}  // namespace
}  // namespace piperun::estimator
