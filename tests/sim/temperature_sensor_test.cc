#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sensor_scene.h"

namespace piperun::sim {
namespace {

using testing::MakeSensor;
using testing::MakeSensorContext;

const auto kRest = [](TruthState&) {};

double Read_C(Sensor& sensor, std::int64_t k) {
  static const TruthWindow window = testing::MakeWindow(2, kRest);
  return std::get<TemperatureSample>(sensor.Sample(k, window)).temperature_C;
}

TEST(TemperatureSensor, FollowsTheHeatBalanceOfTheBall) {
  // C dT/dt = -G (T - T_w), integrated by Heun's method in steps of 10 ms
  SensorContext context = MakeSensorContext();
  context.water_temperature_C = 8;
  const auto sensor = MakeSensor(
      "temperature",
      {{"thermal.initial_C", 22.0}, {"thermal.heat_capacity_J_K", 90.0}, {"thermal.conductance_W_K", 0.3}},
      context);
  const auto rate_K_s = [](double T_C) { return -0.3 * (T_C - 8) / 90; };
  double T_C = 22;
  for (int second = 0; second < 900; ++second) {
    if (second % 90 == 0) {
      EXPECT_NEAR(Read_C(*sensor, second), T_C, 1e-7) << second << " s";
    }
    for (int i = 0; i < 100; ++i) {
      const double predicted_C = T_C + 0.01 * rate_K_s(T_C);
      T_C += 0.005 * (rate_K_s(T_C) + rate_K_s(predicted_C));
    }
  }
}

TEST(TemperatureSensor, StampsOnTheRobotClock) {
  SensorContext context = MakeSensorContext();
  context.clock.offset = Duration(5'000'000);
  context.clock.drift_ppm = 100;
  const auto sensor = MakeSensor("temperature", {{"rate_Hz", 4.0}}, context);
  const auto window = testing::MakeWindow(2, kRest);
  EXPECT_EQ(sensor->DueTime(6), TrueTime(Duration(1'500'000'000)));
  EXPECT_EQ(std::get<TemperatureSample>(sensor->Sample(6, window)).stamp,
            RobotTime(Duration(1'500'000'000 + 150'000 + 5'000'000)));
}

TEST(TemperatureSensor, DrawsItsOffsetOncePerRunAndItsNoisePerSample) {
  const int runs = 4000;
  double offsets = 0, noise = 0, both = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto sensor =
        MakeSensor("temperature", {{"thermal.initial_C", 10.0}, {"offset_sd_K", 0.5}, {"noise_sd_K", 0.1}},
                   MakeSensorContext(run));
    const double first = Read_C(*sensor, 0) - 10, second = Read_C(*sensor, 1) - 10;
    noise += (first - second) * (first - second) / 2 / runs;
    offsets += first * second / runs;
    both += first * first / runs;
  }
  const double sd = std::sqrt(2.0 / runs);
  EXPECT_NEAR(noise / 0.01, 1, 4.5 * sd);
  EXPECT_NEAR(both / 0.26, 1, 4.5 * sd);
  EXPECT_NEAR(offsets / 0.25, 1, 4.5 * std::sqrt((2 * 0.25 * 0.25 + 2 * 0.25 * 0.01 + 1e-4) / runs) / 0.25);
}

TEST(TemperatureSensor, RoundsToItsResolution) {
  const auto sensor =
      MakeSensor("temperature", {{"thermal.initial_C", 10.0}, {"offset_K", 0.03}, {"resolution_K", 0.0625}});
  EXPECT_DOUBLE_EQ(Read_C(*sensor, 0), 10);
  const auto other =
      MakeSensor("temperature", {{"thermal.initial_C", 10.0}, {"offset_K", 0.04}, {"resolution_K", 0.0625}});
  EXPECT_DOUBLE_EQ(Read_C(*other, 0), 10.0625);
}

}  // namespace
}  // namespace piperun::sim
