// When samples are taken, which of them arrive, and what they say of themselves.

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "sim/imu_sampling.h"
#include "tests/support/imu_scene.h"

namespace piperun::sim {
namespace {

using testing::MakeImu;
using testing::MakeImuContext;
using testing::Play;
using testing::Spinning;

constexpr double kSigmas = 4.5;

TEST(ImuSampling, JitteredIntervalsLeaveNothingOut) {
  // turning at w = 4 t: the angle up to an instant tells when it was
  const testing::FunctionScript script([](double t) {
    ScriptPoint s;
    s.X_WB.q = ExpSO3({0, 0, 2 * t * t});
    s.w_WB_B = {0, 0, 4 * t};
    return s;
  });
  const auto imu = MakeImu({{"rate_Hz", 100.0}, {"increments", true}, {"sampling.jitter_s", 0.003}});
  double angle = 0, squares = 0;
  const int n = 400;
  Play(script, *imu, Rate(1000), n, [&](std::int64_t k, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    angle += s.increments->dtheta_S_rad.z();
    const double stamp_s = Seconds(s.stamp);
    // the truth turns evenly within a step of 1 ms: at most 4 dt^2 / 8 beside the parabola
    EXPECT_NEAR(angle, 2 * stamp_s * stamp_s, 5.1e-7) << k;
    const double jitter = stamp_s - static_cast<double>(k + 1) / 100;
    EXPECT_LE(std::abs(jitter), 0.003);
    squares += jitter * jitter / n;
  });
  // even on +-h: variance h^2/3, of its square 4 h^4/45
  EXPECT_NEAR(squares / (0.003 * 0.003 / 3), 1, kSigmas * std::sqrt(0.8 / n));
}

TEST(ImuSampling, UnstampedJitterShowsInTheDataOnly) {
  const auto imu = MakeImu({{"rate_Hz", 100.0},
                            {"increments", true},
                            {"sampling.jitter_s", 0.003},
                            {"sampling.jitter_stamped", false}});
  double spread = 0;
  Play(Spinning({0, 0, 2}), *imu, Rate(1000), 100, [&](std::int64_t k, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    EXPECT_EQ(s.stamp, RobotTime(SampleOffset(k + 1, Rate(100))));
    EXPECT_NEAR(s.w_WS_S_rad_s.z(), 2, 1e-12);
    spread = std::max(spread, std::abs(s.increments->dtheta_S_rad.z() - 0.02));
  });
  EXPECT_GT(spread, 0.002);
  EXPECT_LE(spread, 2 * 2 * 0.003);
}

TEST(ImuSampling, StampJitterShowsInTheStampsOnly) {
  const auto imu = MakeImu({{"rate_Hz", 100.0}, {"increments", true}, {"sampling.stamp_jitter_s", 0.004}});
  RobotTime before{};
  double spread = 0;
  Play(Spinning({0, 0, 2}), *imu, Rate(1000), 200, [&](std::int64_t k, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    EXPECT_NEAR(s.increments->dtheta_S_rad.z(), 0.02, 1e-12);
    EXPECT_GT(s.stamp, before);
    EXPECT_EQ(Seconds(s.stamp), Seconds(imu->DueTime(k)));
    before = s.stamp;
    spread = std::max(spread, std::abs(Seconds(s.stamp) - static_cast<double>(k + 1) / 100));
  });
  EXPECT_GT(spread, 0.003);
  EXPECT_LE(spread, 0.004);
}

TEST(ImuSampling, RefusesJitterThatWouldTurnStampsRound) {
  try {
    MakeImu({{"rate_Hz", 100.0}, {"sampling.jitter_s", 0.003}, {"sampling.stamp_jitter_s", 0.002}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), "sampling.jitter_s");
    EXPECT_NE(e.problem().find("0.005"), std::string::npos);
  }
}

TEST(ImuSampling, SamplesAreLostInBursts) {
  const double p = 0.02;
  const std::int64_t n = 40'000, length = 3;
  const auto imu = MakeImu({{"rate_Hz", 1000.0},
                            {"sampling.loss_probability", p},
                            {"sampling.loss_length", static_cast<double>(length)}});
  std::int64_t lost = 0, run = 0, shortest = n;
  Play(Spinning(Vector3d::Zero()), *imu, Rate(1000), n, [&](auto, const auto& value, auto&) {
    if (std::holds_alternative<LostSample>(value)) {
      ++lost, ++run;
    } else {
      if (run > 0) shortest = std::min(shortest, run);
      run = 0;
    }
  });
  EXPECT_EQ(shortest, length);
  // lost when a burst began at this sample or one of the two before: 1 - (1 - p)^3; neighbours share draws
  const double q = 1 - std::pow(1 - p, 3);
  EXPECT_NEAR(static_cast<double>(lost) / n, q, kSigmas * std::sqrt(5 * q * (1 - q) / n));
}

TEST(ImuSampling, ALostSampleChangesNoOther) {
  const testing::ParamValues noisy{{"gyro.noise_rad_s_sqrtHz", 1e-3}, {"gyro.bias_instability_rad_s", 1e-3}};
  testing::ParamValues lossy = noisy;
  lossy["sampling.loss_probability"] = 0.2;
  const auto all = MakeImu(noisy), some = MakeImu(lossy);
  std::vector<Vector3d> w;
  Play(Spinning({1, 2, 3}), *all, Rate(1000), 200,
       [&](auto, const auto& value, auto&) { w.push_back(std::get<ImuSample>(value).w_WS_S_rad_s); });
  std::size_t arrived = 0;
  Play(Spinning({1, 2, 3}), *some, Rate(1000), 200, [&](std::int64_t k, const auto& value, auto&) {
    if (const auto* s = std::get_if<ImuSample>(&value)) {
      EXPECT_EQ(s->w_WS_S_rad_s, w[static_cast<std::size_t>(k)]);
      ++arrived;
    }
  });
  EXPECT_GT(arrived, 100U);
  EXPECT_LT(arrived, 200U);
}

TEST(ImuSampling, ADuplicateHasTheLastValuesANewStampAndAFlag) {
  const auto imu = MakeImu(
      {{"rate_Hz", 1000.0}, {"gyro.noise_rad_s_sqrtHz", 1e-3}, {"sampling.duplicate_probability", 0.1}});
  Vector3d before = Vector3d::Zero();
  int duplicates = 0;
  const int n = 20'000;
  Play(Spinning(Vector3d::Zero()), *imu, Rate(1000), n, [&](std::int64_t k, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    EXPECT_EQ(s.w_WS_S_rad_s == before, s.flags.duplicated);
    EXPECT_EQ(s.stamp, RobotTime(SampleOffset(k + 1, Rate(1000))));
    duplicates += s.flags.duplicated;
    before = s.w_WS_S_rad_s;
  });
  EXPECT_NEAR(duplicates, 0.1 * n, kSigmas * std::sqrt(0.09 * n));
}

TEST(ImuSampling, AStuckAxisStaysAtItsLastReading) {
  const auto imu = MakeImu({{"rate_Hz", 100.0},
                            {"increments", true},
                            {"gyro.noise_rad_s_sqrtHz", 1e-3},
                            {"gyro.stuck_axis", std::string("y")},
                            {"gyro.stuck_from_s", 0.5}});
  double last = 0;
  Play(Spinning({1, 2, 3}), *imu, Rate(1000), 100, [&](std::int64_t k, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    if (k < 49) last = s.w_WS_S_rad_s.y();
    if (k == 20) {
      EXPECT_NE(s.w_WS_S_rad_s.y(), 2);
    }
    if (k > 49) {
      EXPECT_EQ(s.w_WS_S_rad_s.y(), last);
      EXPECT_DOUBLE_EQ(s.increments->dtheta_S_rad.y(), 0.01 * last);
      EXPECT_NE(s.w_WS_S_rad_s.x(), 1);
    }
  });
}

/// About y, which itself turns about x: the mean of a coning motion's rate is not its turn.
testing::FunctionScript Tumbling() {
  return testing::FunctionScript([](double t) {
    ScriptPoint s;
    s.X_WB.q = ExpSO3({8 * t, 0, 0}) * ExpSO3({0, 20 * t, 0});
    s.w_WB_B = ExpSO3({0, -20 * t, 0}) * Vector3d(8, 0, 0) + Vector3d(0, 20, 0);
    return s;
  });
}

TEST(ImuSampling, AnAxisThatSticksLaterIsAsAnyOtherBefore) {
  const testing::ParamValues sound{{"rate_Hz", 100.0}, {"increments", true}};
  testing::ParamValues failing = sound;
  failing["gyro.stuck_axis"] = failing["accel.stuck_axis"] = std::string("z");
  failing["gyro.stuck_from_s"] = failing["accel.stuck_from_s"] = 0.5;
  std::vector<ImuSample> samples;
  Play(Tumbling(), *MakeImu(sound), Rate(1000), 80,
       [&](auto, const auto& value, auto&) { samples.push_back(std::get<ImuSample>(value)); });
  Play(Tumbling(), *MakeImu(failing), Rate(1000), 80, [&](std::int64_t k, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    const ImuSample& expected = samples[static_cast<std::size_t>(std::min<std::int64_t>(k, 48))];
    EXPECT_EQ(s.w_WS_S_rad_s.z(), expected.w_WS_S_rad_s.z()) << k;
    EXPECT_NEAR(s.increments->dtheta_S_rad.z(), expected.increments->dtheta_S_rad.z(), 1e-17) << k;
    EXPECT_NEAR(s.increments->dv_S_m_s.z(), expected.increments->dv_S_m_s.z(), 1e-16) << k;
    EXPECT_EQ(s.increments->dtheta_S_rad.x(),
              samples[static_cast<std::size_t>(k)].increments->dtheta_S_rad.x());
  });
  const ImuSample& first = samples.front();
  EXPECT_GT(std::abs(first.increments->dtheta_S_rad.z() - 0.01 * first.w_WS_S_rad_s.z()), 1e-6)
      << "no coning";
}

TEST(ImuSampling, FlagsTheAxesThatMetTheirRange) {
  for (const bool steps : {false, true}) {
    testing::ParamValues values{{"gyro.range_rad_s", 30.0}, {"accel.range_m_s2", 5.0}};
    if (steps)
      values["gyro.filter.digital"] = std::string("boxcar"), values["gyro.filter.digital_taps"] = 1.0;
    const auto imu = MakeImu(values);
    Play(Spinning({0, -40, 29}), *imu, Rate(1000), 1, [&](auto, const auto& value, auto&) {
      const auto& s = std::get<ImuSample>(value);
      EXPECT_EQ(s.flags.saturated, 0b100010) << steps;  // gyroscope y; accelerometer z holds gravity
      EXPECT_EQ(s.w_WS_S_rad_s.y(), -30);
      EXPECT_EQ(s.f_WS_S_m_s2.z(), 5);
    });
  }
}

TEST(ImuSampling, TheConverterClipsInFrontOfTheDigitalFilter) {
  // one step in ten is beyond the range: the mean of what the converter sees is below that of the truth
  const testing::FunctionScript knocked([](double t) {
    ScriptPoint s;
    const bool knock = std::llround(t * 1000) % 10 == 5;
    s.a_WB_W.x() = knock ? 100 : 0;
    return s;
  });
  const auto imu = MakeImu({{"rate_Hz", 100.0},
                            {"accel.range_m_s2", 20.0},
                            {"accel.filter.digital", std::string("boxcar")},
                            {"accel.filter.digital_taps", 1.0}});
  Play(knocked, *imu, Rate(1000), 5, [&](auto, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    // the knock's force spreads over the two half steps beside its instant: twice 50, clipped to 20
    EXPECT_NEAR(s.f_WS_S_m_s2.x(), 2 * 20 / 10.0, 1e-12);
    EXPECT_EQ(s.flags.saturated, 0b001000);
  });
}

TEST(ImuSampling, ClockOffsetAndDriftMoveTheStamps) {
  SensorContext context = MakeImuContext();
  context.clock.offset = Duration(2'000'000);
  context.clock.drift_ppm = -50;
  const auto imu = MakeImu({{"rate_Hz", 100.0}}, context);
  Play(Spinning(Vector3d::Zero()), *imu, Rate(1000), 100, [&](std::int64_t k, const auto& value, auto&) {
    EXPECT_EQ(std::get<ImuSample>(value).stamp,
              RobotTime(Duration((k + 1) * 10'000'000 + 2'000'000 - (k + 1) * 500)));
  });
}

}  // namespace
}  // namespace piperun::sim
