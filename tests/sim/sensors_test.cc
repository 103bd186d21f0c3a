#include "sim/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "sim/imu_error.h"
#include "tests/support/function_script.h"
#include "tests/support/set_params.h"

namespace piperun::sim {
namespace {

using testing::FunctionScript;
using testing::MakeTruth;
using testing::ParamValues;

const Vector3d kGravity_W(0, 0, -9.80665);
constexpr double kSigmas = 4.5;

SensorContext MakeContext(std::string_view channel = "sensor0", std::uint64_t run = 0) {
  return {RandomStream(7, channel, run), {}, kGravity_W, Rate(1000)};
}

std::unique_ptr<Sensor> MakeSensor(std::string_view kind_name, const ParamValues& values,
                                   const SensorContext& context = MakeContext()) {
  const SensorKind& kind = testing::FindKind(SensorKinds(), kind_name);
  return kind.make(*testing::MakeParamsOf(kind, values), context);
}

/// At the origin, turning at a constant body rate from an attitude; gauge pressure rising by 1 kPa/s.
TruthWindow TurningTruth(const Vector3d& w_B, const Quaterniond& q_start, std::int64_t steps) {
  const auto turning = MakeTruth(FunctionScript([&](double t) {
                                   ScriptPoint s;
                                   s.X_WB.q = q_start * ExpSO3(t * w_B);
                                   s.w_WB_B = w_B;
                                   return s;
                                 }),
                                 Rate(1000), steps, kGravity_W);
  TruthWindow window(Rate(1000), static_cast<std::size_t>(steps) + 1);
  for (std::int64_t k = 0; k <= steps; ++k) {
    TruthState state = turning.at(k);
    state.pressure_Pa = 2e5 + static_cast<double>(k);
    window.Push(state);
  }
  return window;
}

template <class T>
T SampleAt(Sensor& sensor, std::int64_t k, const TruthWindow& window) {
  return std::get<T>(sensor.Sample(k, window));
}

TEST(Imu, StampsTheEndOfItsIntervalOnTheRobotClock) {
  SensorContext context = MakeContext();
  context.clock.offset = Duration(5'000'000);
  context.clock.drift_ppm = 100;
  const auto imu = MakeSensor("imu", {{"rate_Hz", 400.0}}, context);
  EXPECT_EQ(imu->DueTime(0), TrueTime(Duration(2'500'000)));
  EXPECT_EQ(imu->DueTime(3), TrueTime(Duration(10'000'000)));
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 4);
  EXPECT_EQ(SampleAt<ImuSample>(*imu, 0, window).stamp, RobotTime(Duration(2'500'000 + 5'000'000 + 250)));
}

TEST(Imu, IsIdealByDefault) {
  const Vector3d w(3, -20, 7);
  const auto window = TurningTruth(w, Quaterniond::Identity(), 4);
  const auto imu = MakeSensor("imu", {});
  const auto sample = SampleAt<ImuSample>(*imu, 0, window);
  EXPECT_LT((sample.w_WS_S_rad_s - w).norm(), 1e-12);
  EXPECT_FALSE(sample.increments.has_value());
  EXPECT_EQ(imu->rate(), Rate(400));
}

TEST(Imu, MeasuresInItsOwnFrame) {
  // S turned by +90 degrees about z of B: its x axis is B's y, its y axis is B's -x
  const auto imu = MakeSensor("imu", {{"mounting_rad", std::vector<double>{0, 0, M_PI / 2}}});
  const auto window = TurningTruth({1, 2, 3}, Quaterniond::Identity(), 4);
  const auto sample = SampleAt<ImuSample>(*imu, 0, window);
  EXPECT_LT((sample.w_WS_S_rad_s - Vector3d(2, -1, 3)).norm(), 1e-12);
  EXPECT_LT((imu->X_BS().q * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
}

TEST(Imu, ASpinBeyondTheRangeReadsExactlyTheRange) {
  const double range = 34.906585;  // 2000 deg/s
  const auto imu = MakeSensor("imu", {{"gyro.range_rad_s", range}, {"increments", true}});
  const auto window = TurningTruth({0, -40, 1}, Quaterniond::Identity(), 4);
  const auto sample = SampleAt<ImuSample>(*imu, 0, window);
  EXPECT_EQ(sample.w_WS_S_rad_s.y(), -range);
  EXPECT_NEAR(sample.w_WS_S_rad_s.z(), 1, 1e-12);
  EXPECT_DOUBLE_EQ(sample.increments->dtheta_S_rad.y(), -range * 0.0025);
}

TEST(Imu, IncrementsCarryTheErrorsOfTheRates) {
  // at rest the mean force and the velocity increment agree, so all errors must agree as well
  const ParamValues errors{{"increments", true},
                           {"gyro.noise_rad_s_sqrtHz", 1e-3},
                           {"gyro.bias_sd_rad_s", 0.1},
                           {"gyro.bias_instability_rad_s", 0.01},
                           {"accel.noise_m_s2_sqrtHz", 1e-2},
                           {"accel.bias_m_s2", std::vector<double>{0.1, 0.2, 0.3}},
                           {"accel.scale_error_sd", 0.01},
                           {"accel.rate_random_walk_m_s3_sqrtHz", 0.1},
                           {"accel.misalignment", std::vector<double>{0, .01, .02, 0, 0, .03, 0, 0, 0}}};
  const auto imu = MakeSensor("imu", errors);
  const auto window = TurningTruth(Vector3d::Zero(), ExpSO3({0.3, 0.2, 0.1}), 100);
  for (std::int64_t k = 0; k < 40; ++k) {
    const auto s = SampleAt<ImuSample>(*imu, k, window);
    EXPECT_LT((s.increments->dtheta_S_rad - 0.0025 * s.w_WS_S_rad_s).norm(), 1e-16);
    EXPECT_LT((s.increments->dv_S_m_s - 0.0025 * s.f_WS_S_m_s2).norm(), 1e-16);
    EXPECT_GT(s.w_WS_S_rad_s.norm(), 1e-4);
  }
}

TEST(Imu, GyroAndAccelerometerErrorsArriveAtTheirAxes) {
  const auto imu = MakeSensor("imu", {{"gyro.bias_rad_s", std::vector<double>{0.1, 0.2, 0.3}},
                                      {"accel.bias_m_s2", std::vector<double>{1, 2, 3}},
                                      {"accel.scale_error", std::vector<double>{0, 0, 0.1}}});
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 4);
  const auto s = SampleAt<ImuSample>(*imu, 0, window);
  EXPECT_LT((s.w_WS_S_rad_s - Vector3d(0.1, 0.2, 0.3)).norm(), 1e-15);
  EXPECT_LT((s.f_WS_S_m_s2 - Vector3d(1, 2, 3 + 1.1 * 9.80665)).norm(), 1e-14);
}

TEST(Imu, ReadsTheSameBitsTwiceAndOthersInAnotherRunOrChannel) {
  const ParamValues noisy{{"gyro.noise_rad_s_sqrtHz", 1e-3}, {"gyro.bias_instability_rad_s", 0.01}};
  const auto window = TurningTruth({1, 2, 3}, Quaterniond::Identity(), 100);
  const auto a = MakeSensor("imu", noisy), b = MakeSensor("imu", noisy);
  const auto other_run = MakeSensor("imu", noisy, MakeContext("sensor0", 1));
  const auto other_channel = MakeSensor("imu", noisy, MakeContext("sensor1"));
  for (std::int64_t k = 0; k < 40; ++k) {
    const Vector3d w = SampleAt<ImuSample>(*a, k, window).w_WS_S_rad_s;
    EXPECT_EQ(SampleAt<ImuSample>(*b, k, window).w_WS_S_rad_s, w);
    EXPECT_NE(SampleAt<ImuSample>(*other_run, k, window).w_WS_S_rad_s, w);
    EXPECT_NE(SampleAt<ImuSample>(*other_channel, k, window).w_WS_S_rad_s, w);
  }
}

TEST(Imu, NeedsNoTruthBeyondTheStepAfterItsDueTime) {
  for (const double hertz : {1000.0, 400.0, 333.0, 997.0}) {
    const auto imu = MakeSensor("imu", {{"rate_Hz", hertz}, {"increments", true}});
    const auto all = TurningTruth({0, 30, 0}, Quaterniond::Identity(), 200);
    TruthWindow window(Rate(1000), 8);
    std::int64_t next = 0;
    for (std::int64_t k = 0; k < 30; ++k) {
      while (window.latest_time() < imu->DueTime(k) + Duration(1'000'000) || next == 0)
        window.Push(all.at(next++));
      EXPECT_LT((SampleAt<ImuSample>(*imu, k, window).w_WS_S_rad_s - Vector3d(0, 30, 0)).norm(), 1e-11);
    }
  }
}

TEST(Imu, RefusesARateAboveThePhysicsRate) {
  try {
    MakeSensor("imu", {{"rate_Hz", 1500.0}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), "rate_Hz");
    EXPECT_NE(e.problem().find("1500"), std::string::npos);
    EXPECT_NE(e.problem().find("1000"), std::string::npos);
  }
}

TEST(Magnetometer, TurnsTheFieldIntoTheBall) {
  // x of B points north: it sees the north part; y of B points west: minus the east part
  const auto mag = MakeSensor("magnetometer", {{"field_W_T", std::vector<double>{2e-6, 25e-6, -40e-6}}});
  const auto window = TurningTruth(Vector3d::Zero(), ExpSO3({0, 0, M_PI / 2}), 4);
  const auto s = SampleAt<MagSample>(*mag, 0, window);
  EXPECT_LT((s.m_S_T - Vector3d(25e-6, -2e-6, -40e-6)).norm(), 1e-20);
  EXPECT_EQ(s.stamp, RobotTime(Duration(0)));
}

TEST(Magnetometer, AppliesMountingThenSoftIronThenHardIron) {
  // S turned by 90 degrees about x of B: R_SB (x, y, z) = (x, z, -y)
  const auto mag =
      MakeSensor("magnetometer", {{"field_W_T", std::vector<double>{1e-5, 2e-5, 3e-5}},
                                  {"mounting_rad", std::vector<double>{M_PI / 2, 0, 0}},
                                  {"soft_iron", std::vector<double>{1.1, 0.2, 0, 0, 1, 0, 0, 0, 0.9}},
                                  {"hard_iron_T", std::vector<double>{1e-6, 2e-6, 3e-6}}});
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 4);
  const auto m = SampleAt<MagSample>(*mag, 0, window).m_S_T;
  EXPECT_LT((m - Vector3d(1.1e-5 + 0.2 * 3e-5 + 1e-6, 3e-5 + 2e-6, -0.9 * 2e-5 + 3e-6)).norm(), 1e-19);
}

TEST(Magnetometer, SamplesAnInstantBetweenTwoSteps) {
  const auto mag =
      MakeSensor("magnetometer", {{"field_W_T", std::vector<double>{1, 0, 0}}, {"rate_Hz", 400.0}});
  const auto window = TurningTruth({0, 0, 20}, Quaterniond::Identity(), 8);
  const auto m = SampleAt<MagSample>(*mag, 1, window).m_S_T;  // at 2.5 ms
  EXPECT_NEAR(std::atan2(-m.y(), m.x()), 20 * 0.0025, 1e-13);
}

TEST(Magnetometer, HasTheNoiseItIsGivenAndRoundsAndClips) {
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 20'001);
  const auto mag =
      MakeSensor("magnetometer",
                 {{"field_W_T", std::vector<double>{0, 0, 0}}, {"rate_Hz", 1000.0}, {"noise_sd_T", 3e-7}});
  Vector3d squares = Vector3d::Zero();
  for (std::int64_t k = 0; k < 20'000; ++k) {
    squares += SampleAt<MagSample>(*mag, k, window).m_S_T.cwiseAbs2() / 20'000;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(squares[i] / 9e-14, 1, kSigmas * std::sqrt(2.0 / 20'000));

  const auto coarse = MakeSensor(
      "magnetometer",
      {{"field_W_T", std::vector<double>{1.7e-6, -9e-6, 2.2e-6}}, {"resolution_T", 1e-6}, {"range_T", 4e-6}});
  EXPECT_LT((SampleAt<MagSample>(*coarse, 0, window).m_S_T - Vector3d(2e-6, -4e-6, 2e-6)).norm(), 1e-20);
}

TEST(Pressure, ReadsTheGaugePressureAtAnInstant) {
  const auto sensor = MakeSensor("pressure", {{"rate_Hz", 400.0}, {"offset_Pa", 30.0}});
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 8);
  EXPECT_NEAR(SampleAt<PressureSample>(*sensor, 1, window).pressure_Pa, 2e5 + 2.5 + 30, 1e-9);
  EXPECT_EQ(SampleAt<PressureSample>(*sensor, 2, window).stamp, RobotTime(Duration(5'000'000)));
}

TEST(Pressure, DrawsItsOffsetOncePerRunAndItsNoisePerSample) {
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 4);
  const int runs = 2000;
  double offsets = 0, noise = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto quiet =
        MakeSensor("pressure", {{"rate_Hz", 1000.0}, {"offset_sd_Pa", 200.0}}, MakeContext("p", run));
    const double first = SampleAt<PressureSample>(*quiet, 0, window).pressure_Pa - 2e5;
    EXPECT_NEAR(SampleAt<PressureSample>(*quiet, 1, window).pressure_Pa - 2e5 - 1, first, 1e-9);
    offsets += first * first / runs;
    const auto noisy = MakeSensor("pressure", {{"noise_sd_Pa", 50.0}}, MakeContext("p", run));
    const double n = SampleAt<PressureSample>(*noisy, 0, window).pressure_Pa - 2e5;
    noise += n * n / runs;
  }
  EXPECT_NEAR(offsets / 4e4, 1, kSigmas * std::sqrt(2.0 / runs));
  EXPECT_NEAR(noise / 2500, 1, kSigmas * std::sqrt(2.0 / runs));
}

TEST(Pressure, RoundsAndClips) {
  const auto window = TurningTruth(Vector3d::Zero(), Quaterniond::Identity(), 4);
  const auto coarse = MakeSensor("pressure", {{"offset_Pa", 44.0}, {"resolution_Pa", 100.0}});
  EXPECT_DOUBLE_EQ(SampleAt<PressureSample>(*coarse, 0, window).pressure_Pa, 2e5);
  const auto small = MakeSensor("pressure", {{"range_Pa", 1e5}});
  EXPECT_EQ(SampleAt<PressureSample>(*small, 0, window).pressure_Pa, 1e5);
}

}  // namespace
}  // namespace piperun::sim
