#include "estimator/attitude_eskf.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/estimator/attitude_model.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the model world

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

Matrix3d Cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Rodrigues' formula.
Matrix3d Rotation(const Vector3d& v) {
  const double angle = v.norm();
  if (angle == 0) return Matrix3d::Identity();
  const Matrix3d K = Cross(v / angle);
  return Matrix3d::Identity() + std::sin(angle) * K + (1 - std::cos(angle)) * K * K;
}

/// The filter's equations once more, from the other side: errors local, in the axes of S, rotation matrices
/// by Rodrigues and whole 9 x 9 matrices in Joseph's form.
struct PlainEskf {
  AttitudeModelParams p;
  Matrix3d R;
  Vector3d b = Vector3d::Zero(), a = Vector3d::Zero();
  Matrix9d P = Matrix9d::Zero();

  void Propagate(const ImuStep& step, double motion_sd) {
    const double dt = step.dt_s, c = std::exp(-dt / p.motion_correlation_s);
    const Vector3d turn = step.dtheta_S_rad - b * dt;
    const Matrix3d A = Rotation(-turn);
    Matrix9d F = Matrix9d::Zero(), Q = Matrix9d::Zero();
    F.block<3, 3>(0, 0) = A;
    F.block<3, 3>(0, 3) = -dt * Rotation(-0.5 * turn);
    F.block<3, 3>(3, 3).setIdentity();
    F.block<3, 3>(6, 6) = c * A;
    Q.diagonal() << Vector3d::Constant(p.gyro_noise_rad_s_sqrtHz * p.gyro_noise_rad_s_sqrtHz * dt),
        Vector3d::Constant(p.gyro_bias_walk_rad_s2_sqrtHz * p.gyro_bias_walk_rad_s2_sqrtHz * dt),
        Vector3d::Constant(motion_sd * motion_sd * (1 - c * c));
    P = F * P * F.transpose() + Q;
    R = R * Rotation(turn);
    a = c * A * a;
  }
  void Update(const Eigen::Matrix<double, 3, 9>& H, const Vector3d& z, double r) {
    const Matrix3d S = H * P * H.transpose() + r * Matrix3d::Identity();
    const Eigen::Matrix<double, 9, 3> K = P * H.transpose() * S.inverse();
    const Matrix9d L = Matrix9d::Identity() - K * H;
    P = L * P * L.transpose() + r * K * K.transpose();
    Correct(K * z);
  }
  void Correct(const Vector9d& dx) {
    R = R * Rotation(dx.head<3>());
    // the errors keep their axes in W
    Matrix9d turn = Matrix9d::Identity();
    turn.block<3, 3>(0, 0) = turn.block<3, 3>(6, 6) = Rotation(-dx.head<3>());
    P = turn * P * turn.transpose();
    b += dx.segment<3>(3);
    a += dx.tail<3>();
  }
  void Gravity(const ImuStep& step) {
    const Vector3d up = R.transpose() * Vector3d(0, 0, kGravity);
    const Vector3d f = Rotation(-0.5 * (step.dtheta_S_rad - b * step.dt_s)) * step.f_S_m_s2;
    Eigen::Matrix<double, 3, 9> H = Eigen::Matrix<double, 3, 9>::Zero();
    H.leftCols<3>() = Cross(up);
    H.rightCols<3>().setIdentity();
    Update(H, f - up - a, p.accelerometer_noise_m_s2_sqrtHz * p.accelerometer_noise_m_s2_sqrtHz / step.dt_s);
  }
  void Magnetic(const Vector3d& m_S) {
    const Vector3d m = R * m_S;
    const double h2 = m.x() * m.x() + m.y() * m.y();
    const double z = std::remainder(std::atan2(kField_W_T.y(), kField_W_T.x()) - std::atan2(m.y(), m.x()),
                                    2 * std::numbers::pi);
    Vector9d h = Vector9d::Zero();
    h.head<3>() = R.transpose() * Vector3d(-m.z() * m.x() / h2, -m.z() * m.y() / h2, 1);
    const double r = p.magnetometer_sd_T * p.magnetometer_sd_T / h2;
    Vector9d K = P * h / (h.dot(P * h) + r);
    const Matrix3d about_up = R.transpose() * Vector3d::UnitZ() * Vector3d::UnitZ().transpose() * R;
    K.head<3>() = about_up * K.head<3>().eval();
    K.segment<3>(3) = about_up * K.segment<3>(3).eval();
    K.tail<3>().setZero();
    const Matrix9d L = Matrix9d::Identity() - K * h.transpose();
    P = L * P * L.transpose() + r * K * K.transpose();
    Correct(K * z);
  }
};

TEST(AttitudeEskf, FollowsItsEquationsInWholeMatricesSampleBySample) {
  const ModelWorld world = MatchedWorld(0.1);
  const ModelRecord record = DrawModel(world, 7);
  AttitudeEskf filter(world.params, kGravity, kField_W_T);
  const Quaterniond start = ExpSO3({0.03, -0.04, 0.1}) * record.q_WS_start;
  filter.Align(start, world.start_sd_W_rad);
  PlainEskf plain{world.params, start.toRotationMatrix()};
  plain.P.topLeftCorner<3, 3>() =
      plain.R.transpose() * world.start_sd_W_rad.cwiseAbs2().asDiagonal() * plain.R;
  plain.P.diagonal().segment<3>(3).setConstant(world.params.gyro_bias_sd_rad_s *
                                               world.params.gyro_bias_sd_rad_s);
  for (const ModelStep& step : record.steps) {
    filter.Propagate(step.imu);
    filter.UpdateGravity(step.imu, 0.1);
    plain.Propagate(step.imu, 0.1);
    plain.Gravity(step.imu);
    if (step.field_S_T) {
      filter.UpdateMagnetic(*step.field_S_T, Vector3d::Zero());
      plain.Magnetic(*step.field_S_T);
    }
    ASSERT_LT((filter.q_WS().toRotationMatrix() - plain.R).norm(), 1e-9);
    ASSERT_LT((filter.gyro_bias_S_rad_s() - plain.b).norm(), 1e-9);
    ASSERT_LT((filter.acceleration_W_m_s2() - plain.R * plain.a).norm(), 1e-8);
    Matrix9d T = Matrix9d::Identity();
    T.block<3, 3>(0, 0) = T.block<3, 3>(6, 6) = plain.R;
    const Matrix9d P = T * plain.P * T.transpose();
    ASSERT_LT((filter.covariance() - P).norm(), 1e-9 * P.norm());
  }
}

/// A push of 4 m/s^2 that lasts 4 s, as in the thesis' experiment: 22 degrees for whoever takes it for
/// gravity.
TEST(AttitudeEskf, TakesASustainedPushForAcceleration) {
  const ModelWorld world = MatchedWorld(0);
  ModelRecord record = DrawPerfect(world);
  for (std::size_t k = 1000; k < 1400; ++k) {
    ImuStep& step = record.steps[k].imu;
    const Quaterniond q_mid = record.steps[k].q_WS * ExpSO3(-0.5 * step.dtheta_S_rad);
    step.f_S_m_s2 += q_mid.conjugate() * Vector3d(4, 0, 0);
  }
  AttitudeEskf filter(AttitudeModelParams{}, kGravity, kField_W_T);
  filter.Align(record.q_WS_start, world.start_sd_W_rad);
  double worst = 0;
  Vector3d seen = Vector3d::Zero();
  Feed(filter, record, 0.05, [&](std::size_t k, const ModelStep& step) {
    if (k >= 1000) worst = std::max(worst, Error_rad(filter, step));
    if (k == 1300) seen = filter.acceleration_W_m_s2();
  });
  std::printf("push of 4 m/s^2 for 4 s: attitude %.3f deg at worst\n", worst / kDegree);
  EXPECT_LT(worst, 1 * kDegree);
  EXPECT_LT((seen - Vector3d(4, 0, 0)).norm(), 0.2);
}

/// Launched at 1 m/s^2 the sensor aligns 5.8 degrees off. The first force is already spent on the alignment:
/// it must not count once more as knowledge of the tilt.
TEST(AttitudeEskf, AlignmentSharesItsErrorBetweenTiltAndAcceleration) {
  const Vector3d a_W(1, 0, 0);
  const Quaterniond truth = ExpSO3({0, 0, 0.3});
  ImuStep step;
  step.dt_s = 0.0025;
  step.f_S_m_s2 = truth.conjugate() * (a_W + kGravity * Vector3d::UnitZ());
  AttitudeModelParams params;
  params.motion_acceleration_sd_m_s2 = 1;
  params.motion_correlation_s = 1e6;
  AttitudeEskf filter(params, kGravity, Vector3d::Zero());
  filter.AlignTilt(step.f_S_m_s2);
  const Matrix3d before = filter.Covariance_W_rad2();
  filter.Propagate(step);
  filter.UpdateGravity(step, 1);
  EXPECT_LT((filter.Covariance_W_rad2() - before).cwiseAbs().maxCoeff(), 1e-5);
  // its own sigma covers the error, atan(1 / 9.8)
  const Vector3d error = AttitudeError_W(ExpSO3({0, 0, -0.3}) * truth, filter.q_WS());
  EXPECT_LT(error.head<2>().norm(), 1.5 * std::sqrt(filter.Covariance_W_rad2()(0, 0)));
}

}  // namespace
}  // namespace piperun::estimator
