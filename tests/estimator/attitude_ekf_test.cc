#include "estimator/attitude_ekf.h"

#include <gtest/gtest.h>

#include <functional>

#include "estimator/printed_ekf.h"
#include "tests/estimator/rolling_ball.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the record generator

/// The filter told the errors that were put in, and no motion of its own.
AttitudeParams MatchedParams(const ImuErrors& errors, double mag_sd_T) {
  AttitudeParams p;
  p.gyro_noise_rad_s_sqrtHz = errors.gyro_noise_rad_s_sqrtHz;
  p.gyro_bias_sd_rad_s = errors.gyro_bias_sd_rad_s;
  p.gyro_bias_walk_rad_s2_sqrtHz = 0;
  p.gyro_scale_sd = errors.gyro_scale_sd;
  p.accelerometer_noise_m_s2_sqrtHz = errors.accelerometer_noise_m_s2_sqrtHz;
  p.magnetometer_sd_T = mag_sd_T;
  p.nis_gate = 1e9;
  return p;
}

/// Steady rolling along a straight, from a tilted start attitude.
RollingBall StraightRoll(double speed_m_s, double duration_s) {
  RollingBall ball;
  ball.line = RoundCorners({{0, 0, 0}, {100, 30, 0}}, 0);
  ball.speed_m_s = [=](double) { return speed_m_s; };
  ball.duration_s = duration_s;
  ball.q_WB_start = ExpSO3({0.3, -0.7, 1.1});
  return ball;
}

RollingBall Resting(double duration_s) { return StraightRoll(0, duration_s); }

using Each = std::function<void(std::size_t k, const BallTruth& truth)>;

/// Runs a filter over a record with a magnetometer at a quarter of the IMU's rate; `visit` after each sample.
void Feed(AttitudeFilter& filter, const BallRecord& record, const std::vector<ImuSample>& samples,
          const std::function<MagSample(const BallTruth&, std::size_t)>& magnetometer, const Each& visit = {},
          double motion_sd_m_s2 = AttitudeParams{}.motion_acceleration_sd_m_s2) {
  ImuStepper stepper;
  filter.AlignTilt(samples.front().f_WS_S_m_s2);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto step = stepper.Step(samples[k]);
    if (!step) continue;
    filter.Propagate(*step);
    filter.UpdateGravity(*step, motion_sd_m_s2);
    const BallTruth& truth = record.truth[k + 1];
    if (magnetometer && k % 4 == 0) filter.UpdateMagnetic(magnetometer(truth, k).m_S_T, Vector3d::Zero());
    if (visit) visit(k, truth);
  }
}

auto CleanField() {
  return [](const BallTruth& truth, std::size_t k) { return Magnetometer(truth, RobotTime{}, 0, 1, k); };
}

TEST(AttitudeEkf, PerfectInputAtRestGivesTheExactAttitude) {
  const RollingBall ball = Resting(10);
  const BallRecord record = ball.Roll(100);
  AttitudeEkf filter({}, kGravity, kField_W_T);
  Feed(filter, record, record.samples, CleanField());
  // the arbitrary first heading keeps the weight of its prior: pi R / (n pi^2) = 5e-7 rad after n = 250
  EXPECT_LT(AttitudeError_W(record.truth.back().q_WB, filter.q_WS()).norm(), 2e-6);
  EXPECT_LT(filter.gyro_bias_S_rad_s().norm(), 1e-6);
  EXPECT_TRUE(filter.Covariance_W_rad2().allFinite());
}

TEST(AttitudeEkf, BiasAtRestIsFoundOnEveryAxis) {
  const RollingBall ball = Resting(120);
  const BallRecord record = ball.Roll(100);
  std::vector<ImuSample> samples = record.samples;
  const Vector3d bias = Vector3d(0.05, -0.03, 0.04) * kDegree;
  for (ImuSample& s : samples) s.w_WS_S_rad_s += bias;
  AttitudeEkf filter({}, kGravity, kField_W_T);
  Feed(filter, record, samples, CleanField());
  EXPECT_LT((filter.gyro_bias_S_rad_s() - bias).norm(), 0.05 * bias.norm());
  EXPECT_LT(AttitudeError_W(record.truth.back().q_WB, filter.q_WS()).norm(), 0.01 * kDegree);
}

TEST(AttitudeEkf, HalfTurnsAndUpsideDownAreNoSpecialPlaces) {
  // 0.45 m/s on 30 mm: 2.4 revolutions a second, 0.15 rad per sample. The alignment is off by half of that
  // (it takes the first interval's mean for its end) and has ten seconds to settle.
  const BallRecord record = StraightRoll(0.45, 20).Roll(100);
  AttitudeEkf filter({}, kGravity, kField_W_T);
  double worst = 0;
  Feed(filter, record, record.samples, CleanField(), [&](std::size_t k, const BallTruth& truth) {
    if (k > 1000) worst = std::max(worst, AttitudeError_W(truth.q_WB, filter.q_WS()).norm());
  });
  EXPECT_LT(worst, 0.01 * kDegree);
}

TEST(AttitudeEkf, RollingMakesTheScaleFactorOfTheSpinAxisVisible) {
  RollingBall ball = StraightRoll(0.4, 30);
  ball.q_WB_start = ExpSO3({0, 0, std::atan2(0.3, 1)});  // spins about its y axis
  const BallRecord record = ball.Roll(400);
  std::vector<ImuSample> samples = record.samples;
  const Vector3d scale(0, 2e-3, 0);
  for (ImuSample& s : samples) s.w_WS_S_rad_s += scale.cwiseProduct(s.w_WS_S_rad_s);
  AttitudeParams params;
  params.gyro_bias_sd_rad_s = 1e-5;  // else bias and scale of the spin axis share the blame at constant speed
  AttitudeEkf filter(params, kGravity, kField_W_T);
  Feed(filter, record, samples, CleanField());
  EXPECT_NEAR(filter.gyro_scale_error().y(), scale.y(), 0.02 * scale.y());
  EXPECT_LT(AttitudeError_W(record.truth.back().q_WB, filter.q_WS()).norm(), 1e-3);
}

TEST(AttitudeEkf, HeadingConvergesFromAnyStart) {
  for (int i = 0; i < 12; ++i) {
    RollingBall ball = Resting(2);
    ball.q_WB_start = ExpSO3({0, 0, i * 30 * kDegree}) * ExpSO3({0.5, 0, 0});
    const BallRecord record = ball.Roll(100);
    AttitudeEkf filter({}, kGravity, kField_W_T);
    Feed(filter, record, record.samples, CleanField());
    // prior's weight as above with n = 50: 2.5e-6 rad, and as much again while the bias is unknown
    EXPECT_LT(AttitudeError_W(record.truth.back().q_WB, filter.q_WS()).norm(), 1e-5) << i * 30 << " deg";
  }
}

TEST(AttitudeEkf, WrongMagnetometerDoesNotTilt) {
  const BallRecord record = StraightRoll(0.35, 60).Roll(400);
  const auto disturbed = [](const BallTruth& truth, std::size_t k) {
    // turned by 40 degrees from half a minute on, the magnitude unchanged
    const Quaterniond turn = ExpSO3({0, 0, truth.t_s > 30 ? 40 * kDegree : 0});
    MagSample m = Magnetometer(truth, RobotTime{}, 0, 1, k);
    m.m_S_T = truth.q_WB.conjugate() * (turn * kField_W_T);
    return m;
  };
  AttitudeParams params;
  params.nis_gate = 1e9;  // let it through on purpose
  AttitudeEkf filter(params, kGravity, kField_W_T);
  double worst_tilt = 0, last_heading = 0;
  Feed(filter, record, record.samples, disturbed, [&](std::size_t k, const BallTruth& truth) {
    const Vector3d error = AttitudeError_W(truth.q_WB, filter.q_WS());
    const Vector3d up = (truth.q_WB * filter.q_WS().conjugate()) * Vector3d::UnitZ();
    if (k > 400) worst_tilt = std::max(worst_tilt, std::acos(std::min(1.0, up.z())));
    last_heading = error.z();
  });
  EXPECT_GT(std::abs(last_heading), 20 * kDegree);  // the disturbance did get in
  EXPECT_LT(worst_tilt, std::abs(last_heading) / 50);
}

TEST(AttitudeEkf, GateKeepsASuddenFieldDisturbanceOut) {
  const BallRecord record = StraightRoll(0.35, 20).Roll(400);
  const auto disturbed = [](const BallTruth& truth, std::size_t k) {
    MagSample m = Magnetometer(truth, RobotTime{}, 0.2e-6, 1, k);
    if (truth.t_s > 10) m.m_S_T = truth.q_WB.conjugate() * (ExpSO3({0, 0, 0.7}) * kField_W_T);
    return m;
  };
  AttitudeEkf filter({}, kGravity, kField_W_T);
  Feed(filter, record, Corrupt(record, kWalkGrade, 3), disturbed);
  EXPECT_LT(std::abs(AttitudeError_W(record.truth.back().q_WB, filter.q_WS()).z()), 2 * kDegree);
}

TEST(AttitudeEkf, AccelerationDisturbanceIsWeightedDownAndForgotten) {
  const BallRecord record = Resting(20).Roll(100);
  std::vector<ImuSample> samples = record.samples;
  for (std::size_t k = 1000; k < 1400; ++k) samples[k].f_WS_S_m_s2 += Vector3d(4, 0, 0);  // the paper's 4 s
  AttitudeEkf filter({}, kGravity, kField_W_T);
  double worst = 0;
  Feed(filter, record, samples, CleanField(), [&](std::size_t k, const BallTruth& truth) {
    if (k >= 1000) worst = std::max(worst, AttitudeError_W(truth.q_WB, filter.q_WS()).norm());
  });
  // unweighted, the attitude would follow the disturbed vertical: atan(4 / 9.8) = 22 degrees
  EXPECT_LT(worst, 3 * kDegree);
  EXPECT_LT(AttitudeError_W(record.truth.back().q_WB, filter.q_WS()).norm(), 0.3 * kDegree);
}

TEST(AttitudeEkf, ErrorsAndInnovationsMatchTheirCovarianceOverSeedsSlow) {
  // NEES of three attitude components and NIS, averaged over independent seeds and over epochs 5 s apart.
  // 40 seeds x 5 epochs x 3 dof: sum ~ chi2(600) if epochs were independent; they are not, so only the seeds
  // are counted: mean of 40 chi2(3) variates / 3 has sd sqrt(2 / 120) = 0.129; bounds are +-3.3 sd.
  const RollingBall ball = StraightRoll(0.35, 30);
  const BallRecord record = ball.Roll(400);
  const double mag_sd_T = 0.3e-6;
  double nees = 0, nis = 0;
  std::size_t nees_dof = 0, nis_dof = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    AttitudeEkf filter(MatchedParams(kWalkGrade, mag_sd_T), kGravity, kField_W_T);
    const auto field = [&](const BallTruth& truth, std::size_t k) {
      return Magnetometer(truth, RobotTime{}, mag_sd_T, seed, k);
    };
    Feed(
        filter, record, Corrupt(record, kWalkGrade, seed), field,
        [&](std::size_t k, const BallTruth& truth) {
          if (k < 4000) return;
          nis += filter.nis()->value;
          nis_dof += static_cast<std::size_t>(filter.nis()->dof);
          if (k % 2000 != 1) return;
          const Vector3d e = AttitudeError_W(truth.q_WB, filter.q_WS());
          nees += e.dot(filter.Covariance_W_rad2().inverse() * e);
          nees_dof += 3;
        },
        0);
  }
  std::printf("NEES/dof %.3f, NIS/dof %.4f\n", nees / static_cast<double>(nees_dof),
              nis / static_cast<double>(nis_dof));
  EXPECT_NEAR(nees / static_cast<double>(nees_dof), 1, 3.3 * 0.129);
  // innovations are white: 40 x 8000 of them, sd below 0.003
  EXPECT_NEAR(nis / static_cast<double>(nis_dof), 1, 0.02);
}

TEST(AttitudeEkf, CovarianceStaysSymmetricAndPositive) {
  const BallRecord record = StraightRoll(0.35, 60).Roll(400);
  AttitudeEkf filter({}, kGravity, kField_W_T);
  Feed(filter, record, Corrupt(record, kWalkGrade, 5), CleanField(), [&](std::size_t, const BallTruth&) {
    const Matrix3d P = filter.Covariance_W_rad2();
    ASSERT_EQ(P, Matrix3d(P.transpose()));
    ASSERT_GT(P.determinant(), 0);
    ASSERT_GT(P.trace(), 0);
  });
}

/// Tilts slowly by `amplitude_rad` about x and back, with an IMU at 100 Hz.
BallRecord SlowTilt(double amplitude_rad, double period_s) {
  BallRecord record{100, {}, {}};
  const double dt = 0.01, k = 2 * std::numbers::pi / period_s;
  const auto angle = [=](double t) { return 0.5 * amplitude_rad * (1 - std::cos(k * t)); };
  record.truth.push_back({});
  record.truth.back().q_WB = Quaterniond::Identity();
  for (int i = 0; i < static_cast<int>(2 * period_s / dt); ++i) {
    const double t = i * dt;
    const Quaterniond q_mid = ExpSO3({angle(t + 0.5 * dt), 0, 0});
    record.samples.push_back({RobotTime(SampleOffset(i + 1, Rate(100))),
                              {(angle(t + dt) - angle(t)) / dt, 0, 0},
                              q_mid.conjugate() * Vector3d(0, 0, kGravity),
                              std::nullopt});
    record.truth.push_back({});
    record.truth.back().q_WB = ExpSO3({angle(t + dt), 0, 0});
  }
  return record;
}

double WorstError(AttitudeFilter& filter, const BallRecord& record) {
  double worst = 0;
  Feed(filter, record, record.samples, CleanField(), [&](std::size_t k, const BallTruth& truth) {
    if (k > 200) worst = std::max(worst, AttitudeError_W(truth.q_WB, filter.q_WS()).norm());
  });
  return worst;
}

TEST(PrintedEkf, WorksBelowAQuarterTurnAndFailsUpsideDown) {
  PrintedEkf inside({}, kGravity, kField_W_T), beyond({}, kGravity, kField_W_T);
  EXPECT_LT(WorstError(inside, SlowTilt(70 * kDegree, 20)), 1.5 * kDegree);
  EXPECT_GT(WorstError(beyond, SlowTilt(180 * kDegree, 20)), 30 * kDegree);
  AttitudeEkf ours({}, kGravity, kField_W_T);
  EXPECT_LT(WorstError(ours, SlowTilt(180 * kDegree, 20)), 0.1 * kDegree);
}

TEST(PrintedEkf, LosesARollingBall) {
  const BallRecord record = StraightRoll(0.35, 20).Roll(100);
  PrintedEkf printed({}, kGravity, kField_W_T);
  EXPECT_GT(WorstError(printed, record), 30 * kDegree);
}

}  // namespace
}  // namespace piperun::estimator
