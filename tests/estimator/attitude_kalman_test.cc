// What every Kalman filter of attitude and gyro bias must do.

#include "estimator/attitude_kalman.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "estimator/attitude_eskf.h"
#include "estimator/attitude_iekf.h"
#include "estimator/attitude_ukf.h"
#include "tests/estimator/allocation_counter.h"
#include "tests/estimator/attitude_model.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the model world

template <class Filter>
class AttitudeKalmanTest : public ::testing::Test {
 protected:
  /// Motion that the filter's model can draw: the others call it white, so that it would not be theirs.
  static constexpr double kMotion_m_s2 = std::is_same_v<Filter, AttitudeEskf> ? 0.1 : 0;

  /// Sigma points see the bend of the group: on perfect input the mean moves by what is second order in the
  /// errors believed possible, rad. The linear filters stay where they are.
  static double SecondOrder_rad(const Filter& filter) {
    return std::is_same_v<Filter, AttitudeUkf> ? filter.Covariance_W_rad2().trace() : 0;
  }
  static Filter Make(const AttitudeModelParams& params) { return Filter(params, kGravity, kField_W_T); }
};

using Filters = ::testing::Types<AttitudeEskf, AttitudeIekf, AttitudeUkf>;
TYPED_TEST_SUITE(AttitudeKalmanTest, Filters);

TYPED_TEST(AttitudeKalmanTest, FindsTheAttitudeAtRestFromPerfectInput) {
  ModelWorld world = MatchedWorld(0);
  world.tumble_rad_s = 0;
  const ModelRecord record = DrawPerfect(world);
  TypeParam filter = this->Make(AttitudeModelParams{});
  filter.AlignTilt(record.steps.front().imu.f_S_m_s2);
  Feed(filter, record, 0, [&](std::size_t, const ModelStep&) {
    ASSERT_TRUE(filter.q_WS().coeffs().allFinite());
    ASSERT_TRUE(filter.covariance().allFinite());
  });
  // a thousand headings of sd 0.02 rad against a prior of pi leave 4e-8 of the first error, and the bias'
  // share of it; tilt comes from the alignment
  EXPECT_LT(Error_rad(filter, record.steps.back()), 1e-5);
  EXPECT_LT(filter.gyro_bias_S_rad_s().norm(), 1e-6);
}

TYPED_TEST(AttitudeKalmanTest, FollowsAConstantRateExactly) {
  ModelWorld world = MatchedWorld(0);
  const Vector3d w(3, -7, 11);
  TypeParam filter = this->Make(world.params);
  filter.Align(ExpSO3({0.4, -0.9, 1.3}), Vector3d::Constant(1e-6));
  Quaterniond q = ExpSO3({0.4, -0.9, 1.3});
  for (int k = 0; k < 2000; ++k) {
    ImuStep step;
    step.dt_s = world.dt_s;
    step.w_S_rad_s = w;
    step.dtheta_S_rad = w * step.dt_s;
    const Quaterniond q_mid = q * ExpSO3(0.5 * step.dtheta_S_rad);
    step.f_S_m_s2 = q_mid.conjugate() * Vector3d(0, 0, kGravity);
    q = q * ExpSO3(step.dtheta_S_rad);
    filter.Propagate(step);
    filter.UpdateGravity(step, 0);
  }
  EXPECT_LT(AttitudeError_W(q, filter.q_WS()).norm(), 1e-9 + this->SecondOrder_rad(filter));
  EXPECT_LT((filter.w_S_rad_s() - w).norm(), 1e-9 + this->SecondOrder_rad(filter) / world.dt_s);
}

TYPED_TEST(AttitudeKalmanTest, RecoversFromAWrongStart) {
  ModelWorld world = MatchedWorld(0);
  const ModelRecord record = DrawPerfect(world);
  for (const Vector3d& wrong : {Vector3d(0.8, 0, 0), Vector3d(0, -0.8, 3), Vector3d(0.5, 0.5, -2)}) {
    TypeParam filter = this->Make(world.params);
    filter.Align(ExpSO3(wrong) * record.q_WS_start, {0.8, 0.8, std::numbers::pi});
    Feed(filter, record, 0, [](std::size_t, const ModelStep&) {});
    EXPECT_LT(Error_rad(filter, record.steps.back()), 0.002) << wrong.transpose();
  }
}

TYPED_TEST(AttitudeKalmanTest, FindsTheBiasOnEveryAxis) {
  const ModelWorld world = MatchedWorld(0);
  ModelRecord record = DrawPerfect(world);
  const Vector3d bias(0.02, -0.015, 0.01);
  for (ModelStep& step : record.steps) {
    step.imu.w_S_rad_s += bias;
    step.imu.dtheta_S_rad += bias * step.imu.dt_s;
  }
  TypeParam filter = this->Make(world.params);
  filter.Align(record.q_WS_start, world.start_sd_W_rad);
  Feed(filter, record, 0, [](std::size_t, const ModelStep&) {});
  EXPECT_LT((filter.gyro_bias_S_rad_s() - bias).norm(), 0.01 * bias.norm());
  EXPECT_LT(Error_rad(filter, record.steps.back()), 1e-3);
}

TYPED_TEST(AttitudeKalmanTest, IsUnsureAboutAClippedAxisAndNoOther) {
  AttitudeModelParams params;
  params.clipped_rate_sd_rad_s = 4;
  params.clipped_correlation_s = 0.1;
  ImuStep step;
  step.dt_s = 0.01;
  const Quaterniond q = ExpSO3({0.4, -0.9, 1.3});
  Matrix3d P[2];
  for (const bool clipped : {false, true}) {
    TypeParam filter = this->Make(params);
    filter.Align(q, Vector3d::Constant(0.01));
    step.saturated = clipped ? 1 << 1 : 0;
    filter.Propagate(step);
    P[clipped] = filter.Covariance_W_rad2();
  }
  const Vector3d y_W = q * Vector3d::UnitY();
  const Matrix3d expected = (2 * 4 * 4 * 0.1 * 0.01) * (y_W * y_W.transpose());
  EXPECT_LT((P[1] - P[0] - expected).norm(), 1e-9);
}

/// Two seconds at 3 rad/s beyond the range of the gyro's x axis.
TYPED_TEST(AttitudeKalmanTest, ComesBackAfterAClippedGyro) {
  const ModelWorld world = MatchedWorld(0);
  ModelRecord clean = DrawPerfect(world), clipped = clean;
  for (std::size_t k = 1000; k < 1200; ++k) {
    ImuStep& step = clipped.steps[k].imu;
    step.w_S_rad_s.x() -= 3;
    step.dtheta_S_rad.x() -= 3 * step.dt_s;
    step.saturated = 1;
  }
  TypeParam filter = this->Make(world.params), deaf = this->Make(world.params);
  filter.Align(clean.q_WS_start, world.start_sd_W_rad);
  double afterwards = 0;
  Feed(filter, clipped, 0, [&](std::size_t k, const ModelStep& step) {
    if (k == 999) {
      EXPECT_LT(filter.Covariance_W_rad2().trace(), 1e-3);
    }
    if (k == 1400) afterwards = Error_rad(filter, step);
  });
  EXPECT_LT(afterwards, 0.02);
  // the same reading, its flag lost: the filter learns a bias that is not there
  for (ModelStep& step : clipped.steps) step.imu.saturated = 0;
  deaf.Align(clean.q_WS_start, world.start_sd_W_rad);
  Feed(deaf, clipped, 0, [&](std::size_t k, const ModelStep& step) {
    if (k == 1400) {
      EXPECT_GT(Error_rad(deaf, step), 3 * afterwards);
    }
  });
}

TYPED_TEST(AttitudeKalmanTest, LeavesAClippedAccelerometerOut) {
  const ModelWorld world = MatchedWorld(0);
  ModelRecord record = DrawPerfect(world);
  for (std::size_t k = 1000; k < 1200; ++k) {
    record.steps[k].imu.f_S_m_s2 = {30, 0, 0};
    record.steps[k].imu.saturated = 1 << 3;
  }
  TypeParam filter = this->Make(world.params);
  filter.Align(record.q_WS_start, Vector3d::Constant(1e-6));
  Feed(filter, record, 0, [&](std::size_t k, const ModelStep& step) {
    if (k < 1300) {
      ASSERT_LT(Error_rad(filter, step), 1e-6 + this->SecondOrder_rad(filter)) << k;
    }
  });
}

TYPED_TEST(AttitudeKalmanTest, HasErrorsAsItsCovarianceSaysOverAHundredRunsSlow) {
  // sum over runs of e^T P^-1 e is chi-square of 600; each of twenty epochs has its own band
  constexpr int kRuns = 100, kEpochs = 20;
  const ModelWorld world = MatchedWorld(this->kMotion_m_s2);
  const std::size_t every = static_cast<std::size_t>(world.count) / kEpochs;
  std::array<double, kEpochs> nees{};
  double nis = 0, nis_dof = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const ModelRecord record = DrawModel(world, seed);
    TypeParam filter = this->Make(world.params);
    const RandomStream random(seed, "start", 0);
    const Vector3d off = world.start_sd_W_rad.cwiseProduct(Normal3(random, 0, 0));
    filter.Align(ExpSO3(off) * record.q_WS_start, world.start_sd_W_rad);
    Feed(filter, record, this->kMotion_m_s2, [&](std::size_t k, const ModelStep& step) {
      nis += filter.nis()->value;
      nis_dof += filter.nis()->dof;
      if (k % every != every - 1) return;
      Eigen::Matrix<double, 6, 1> e;
      e << AttitudeError_W(step.q_WS, filter.q_WS()), step.bias_S - filter.gyro_bias_S_rad_s();
      nees[k / every] += e.dot(filter.covariance().template topLeftCorner<6, 6>().inverse() * e);
    });
  }
  const double low = CalcChiSquareQuantile(0.025, 6 * kRuns), high = CalcChiSquareQuantile(0.975, 6 * kRuns);
  int inside = 0;
  double sum = 0;
  for (const double v : nees) {
    inside += v > low && v < high;
    sum += v;
  }
  std::printf("NEES/dof %.3f, band %.3f to %.3f, %d of %d epochs inside; NIS/dof %.4f\n",
              sum / (6 * kRuns * kEpochs), low / (6 * kRuns), high / (6 * kRuns), inside, kEpochs,
              nis / nis_dof);
  EXPECT_GE(inside, 16);
  EXPECT_GT(nees.back(), low);
  EXPECT_LT(nees.back(), high);
  // white innovations: at least 100 x 4000 of them with one degree of freedom, sd of their mean 0.0022
  EXPECT_NEAR(nis / nis_dof, 1, 0.01);
}

TYPED_TEST(AttitudeKalmanTest, AllocatesNothing) {
  const ModelWorld world = MatchedWorld(0.1);
  const ModelRecord record = DrawModel(world, 1);
  TypeParam filter = this->Make(world.params);
  filter.Align(record.q_WS_start, world.start_sd_W_rad);
  const std::size_t before = AllocationCount();
  Feed(filter, record, 0.1, [](std::size_t, const ModelStep&) {});
  filter.UpdateRestRate({0.01, 0, 0}, 1);
  filter.UpdateHeading(0.1, 0.1);
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace
}  // namespace piperun::estimator
