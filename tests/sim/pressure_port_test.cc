#include "sim/pressure_port.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/sensor_scene.h"

namespace piperun::sim {
namespace {

using testing::FindRefusedKey;
using testing::MakeSensor;
using testing::MakeSensorContext;

constexpr double kPi = std::numbers::pi;
constexpr double kDensity = 999.7, kGravity = 9.80665;
const Vector3d kGravity_W(0, 0, -kGravity);

TEST(SpherePressure, FollowsBernoulliOfThePotentialFlow) {
  // phi = U (r + a^3 / (2 r^2)) cos theta with U = a = 1; the speed along the surface by differences
  const auto phi = [](double r, double theta) { return (r + 0.5 / (r * r)) * std::cos(theta); };
  for (double theta = 0.02; theta < 0.5 * kPi; theta += 0.05) {
    const double u = (phi(1, theta + 1e-5) - phi(1, theta - 1e-5)) / 2e-5;
    EXPECT_NEAR(CalcSpherePressureCoefficient(std::cos(theta), -1.25), 1 - u * u, 1e-8) << theta;
  }
}

TEST(SpherePressure, IsThatOfTheStagnationPointInFrontAndOfTheWakeBehind) {
  EXPECT_EQ(CalcSpherePressureCoefficient(1, -0.4), 1);
  // potential flow falls to -0.4 where sin^2 theta = 1.4 * 4 / 9: at 52.07 degrees
  const double meets = std::asin(std::sqrt(5.6 / 9));
  EXPECT_NEAR(CalcSpherePressureCoefficient(std::cos(meets - 1e-6), -0.4), -0.4, 1e-5);
  EXPECT_GT(CalcSpherePressureCoefficient(std::cos(meets - 0.01), -0.4), -0.4);
  for (const double theta : {1.0, 0.5 * kPi, 2.0, kPi}) {
    EXPECT_EQ(CalcSpherePressureCoefficient(std::cos(theta), -0.4), -0.4) << theta;
  }
}

TEST(SpherePressure, AddsUpToTheDragOfASphere) {
  // C_D = 2 int C_p cos theta sin theta dtheta; by hand 9/8 (5.6/9)^2 = 0.4356, and spheres have 0.44 +- 0.04
  // between Re = 1e3 and 2e5 (Clift, Grace & Weber, Bubbles, Drops and Particles, ch. 5)
  const int n = 20'000;
  double drag = 0;
  for (int i = 0; i < n; ++i) {
    const double theta = kPi * (i + 0.5) / n;
    drag += 2 * CalcSpherePressureCoefficient(std::cos(theta), -0.4) * std::cos(theta) * std::sin(theta) *
            kPi / n;
  }
  EXPECT_NEAR(drag, 9.0 / 8 * (5.6 / 9) * (5.6 / 9), 1e-6);
  EXPECT_NEAR(drag, 0.44, 0.04);
}

PressurePortParams SpherePort(const Vector3d& port_m) {
  PressurePortParams port;
  port.port_m = port_m;
  port.dynamic = "sphere";
  return port;
}

TEST(PressurePort, FeelsTheStagnationPressureWhereTheWaterComesFrom) {
  TruthState truth;
  truth.pressure_Pa = 3e5;
  truth.v_slip_W = {0.4, 0, 0};  // the water overtakes the ball: it comes from -x
  const double full_Pa = 0.5 * kDensity * 0.16;
  EXPECT_NEAR(CalcPortPressure_Pa(SpherePort({-0.03, 0, 0}), truth, kGravity_W, kDensity), 3e5 + full_Pa,
              1e-9);
  EXPECT_NEAR(CalcPortPressure_Pa(SpherePort({0.03, 0, 0}), truth, kGravity_W, kDensity), 3e5 - 0.4 * full_Pa,
              1e-9);
  // turned half round about z, the port at the back looks into the stream
  truth.X_WB.q = ExpSO3({0, 0, kPi});
  EXPECT_NEAR(CalcPortPressure_Pa(SpherePort({0.03, 0, 0}), truth, kGravity_W, kDensity), 3e5 + full_Pa,
              1e-9);
  truth.X_WB.q = ExpSO3({0, 0, kPi / 6});  // 30 degrees off: 1 - 9/16
  EXPECT_NEAR(CalcPortPressure_Pa(SpherePort({-0.03, 0, 0}), truth, kGravity_W, kDensity),
              3e5 + 7.0 / 16 * full_Pa, 1e-9);
}

TEST(PressurePort, CarriesTheWeightOfTheWaterAboveIt) {
  TruthState truth;
  PressurePortParams port;
  port.port_m = {0, 0, 0.03};
  const double top_Pa = CalcPortPressure_Pa(port, truth, kGravity_W, kDensity);
  truth.X_WB.q = ExpSO3({kPi, 0, 0});
  const double bottom_Pa = CalcPortPressure_Pa(port, truth, kGravity_W, kDensity);
  EXPECT_NEAR(bottom_Pa - top_Pa, kDensity * kGravity * 0.06, 1e-9);
  EXPECT_NEAR(bottom_Pa, 294.1, 0.1);
}

TEST(PressurePort, LeavesTheStreamOutOrTakesAConstant) {
  TruthState truth;
  truth.v_slip_W = {0, 0.2, 0};
  PressurePortParams port;
  EXPECT_EQ(CalcPortPressure_Pa(port, truth, kGravity_W, kDensity), 0);
  port.dynamic = "constant";
  port.pressure_coefficient = -0.3;
  EXPECT_NEAR(CalcPortPressure_Pa(port, truth, kGravity_W, kDensity), -0.3 * 0.5 * kDensity * 0.04, 1e-12);
}

TEST(PressurePort, WithoutSlipFeelsNoStream) {
  EXPECT_EQ(CalcPortPressure_Pa(SpherePort({0.03, 0, 0}), TruthState{}, kGravity_W, kDensity), 0);
}

double Read_Pa(Sensor& sensor, std::int64_t k, const TruthWindow& window) {
  return std::get<PressureSample>(sensor.Sample(k, window)).pressure_Pa;
}

TEST(Pressure, OfASpinningBallRisesAndFallsWithTheTurn) {
  // two turns a second about y, port on the rim: rho g r in amplitude, downwards first
  SensorContext context = MakeSensorContext();
  context.water_density_kg_m3 = kDensity;
  const auto sensor =
      MakeSensor("pressure", {{"rate_Hz", 100.0}, {"port_m", std::vector<double>{0.03, 0, 0}}}, context);
  const auto window = testing::MakeWindow(1000, [](TruthState& s) {
    s.pressure_Pa = 2e5;
    s.X_WB.q = ExpSO3({0, 4 * kPi * Seconds(s.time), 0});
  });
  EXPECT_EQ(sensor->X_BS().p, Vector3d(0.03, 0, 0));
  for (std::int64_t k = 0; k < 100; ++k) {
    const double expected_Pa =
        2e5 + kDensity * kGravity * 0.03 * std::sin(4 * kPi * 0.01 * static_cast<double>(k));
    EXPECT_NEAR(Read_Pa(*sensor, k, window), expected_Pa, 1e-8) << k;
  }
}

TEST(Pressure, DriftsAsARandomWalkThatBeginsAtZero) {
  const auto window = testing::MakeWindow(501, [](TruthState&) {});
  const int runs = 2000, samples = 50;  // at 100 Hz: 0.5 s
  double squares = 0, overlap = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto sensor = MakeSensor("pressure", {{"rate_Hz", 100.0}, {"random_walk_Pa_s_sqrtHz", 30.0}},
                                   MakeSensorContext(run));
    EXPECT_EQ(Read_Pa(*sensor, 0, window), 0);
    double half = 0, last = 0;
    for (int k = 1; k <= samples; ++k) {
      last = Read_Pa(*sensor, k, window);
      if (k == samples / 2) half = last;
    }
    squares += last * last / runs;
    overlap += half * (last - half) / runs;  // increments are independent
  }
  EXPECT_NEAR(squares / (900 * 0.5), 1, 4.5 * std::sqrt(2.0 / runs));
  EXPECT_NEAR(overlap / (900 * 0.25), 0, 4.5 * std::sqrt(1.0 / runs));
}

TEST(Pressure, ReadsInCountsOfItsConverterUpToItsRange) {
  const auto window =
      testing::MakeWindow(1000, [](TruthState& s) { s.pressure_Pa = 777.7 * Seconds(s.time); });
  const auto sensor = MakeSensor("pressure", {{"rate_Hz", 1000.0}, {"range_Pa", 500.0}, {"bits", 12.0}});
  const double count_Pa = 1000.0 / 4096;
  for (std::int64_t k = 0; k < 640; ++k) {
    const double reading_Pa = Read_Pa(*sensor, k, window), truth_Pa = 0.7777 * static_cast<double>(k);
    EXPECT_LE(std::abs(reading_Pa - truth_Pa), 0.5 * count_Pa * (1 + 1e-9));
    EXPECT_NEAR(std::remainder(reading_Pa, count_Pa), 0, 1e-12);
  }
  EXPECT_EQ(Read_Pa(*sensor, 999, window), 500);
}

TEST(Pressure, OffsetFollowsTheTemperatureOfTheBall) {
  SensorContext context = MakeSensorContext();
  context.water_temperature_C = 5;
  const auto window = testing::MakeWindow(1000, [](TruthState&) {});
  const auto sensor = MakeSensor("pressure",
                                 {{"rate_Hz", 10.0},
                                  {"temperature_offset_Pa_per_K", 20.0},
                                  {"reference_C", 25.0},
                                  {"thermal.initial_C", 25.0},
                                  {"thermal.time_constant_s", 0.5}},
                                 context);
  EXPECT_EQ(Read_Pa(*sensor, 0, window), 0);
  EXPECT_NEAR(Read_Pa(*sensor, 5, window), -20 * 20 * (1 - std::exp(-1)), 1e-9);
}

TEST(Pressure, RefusesWhatContradictsItself) {
  const auto refused = [](const testing::ParamValues& values) {
    return FindRefusedKey([&] { MakeSensor("pressure", values); });
  };
  EXPECT_EQ(refused({{"dynamic", std::string("sphere")}}), "port_m");
  EXPECT_EQ(refused({{"bits", 24.0}}), "bits");
  EXPECT_EQ(refused({{"bits", 24.0}, {"range_Pa", 1e6}, {"resolution_Pa", 1.0}}), "bits");
  EXPECT_EQ(refused({{"bits", 24.0}, {"range_Pa", 1e6}}), "nothing");
}

}  // namespace
}  // namespace piperun::sim
