// Each term of the IMU's error chain by itself, against its law.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/imu_error.h"
#include "sim/thermal.h"
#include "tests/support/allan.h"
#include "tests/support/imu_scene.h"

namespace piperun::sim {
namespace {

using testing::CalcAllanVariance;
using testing::MakeImu;
using testing::MakeImuContext;
using testing::Play;
using testing::Spinning;

constexpr double kSigmas = 4.5;
constexpr double kG = 9.80665;

/// Errors of the x axis over n samples at 100 Hz.
std::vector<double> Record(const TriadErrorParams& params, std::int64_t n, std::uint64_t run) {
  const TriadStream stream{RandomStream(20, "imu0", run), 0};
  const TriadErrorCoefficients c = MakeCoefficients(params, Rate(100), stream);
  TriadErrorState state = MakeState(c, stream);
  std::vector<double> x;
  for (std::int64_t k = 0; k < n; ++k) x.push_back(StepError(state, k, stream, c).x());
  return x;
}

/// First sample of a ball spinning at w_B.
ImuSample FirstSample(const testing::ParamValues& values, const Vector3d& w_B,
                      const SensorContext& context = MakeImuContext()) {
  const auto imu = MakeImu(values, context);
  ImuSample first;
  Play(Spinning(w_B), *imu, context.truth_rate, 1,
       [&](auto, const auto& value, auto&) { first = std::get<ImuSample>(value); });
  return first;
}

TEST(ImuTerms, FlickerModelIsFlatWithinTwoPercentFrom200MillisecondsTo20000Seconds) {
  // continuous Gauss-Markov Allan variance (facts: 2 s^2 T/tau [1 - T/2tau (3 - 4 e^-x + e^-2x)], x = tau/T)
  const double sigma2 = std::numbers::ln10 / std::numbers::pi,
               flicker = 2 * std::numbers::ln2 / std::numbers::pi;
  double least = 2, most = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double tau = 0.2 * std::pow(1e5, i / 1000.0);
    double sum = 0;
    for (double T = 1e-2; T < 2e5; T *= 10) {
      const double x = tau / T;
      const double small = 2.0 / 3 * x - x * x / 2;  // of the bracket, where it would cancel
      const double bracket = 1 - (3 - 4 * std::exp(-x) + std::exp(-2 * x)) / (2 * x);
      sum += sigma2 * (x < 1e-4 ? small : 2 / x * bracket);
    }
    least = std::min(least, std::sqrt(sum / flicker));
    most = std::max(most, std::sqrt(sum / flicker));
  }
  std::printf("eight poles, 0.2 s to 20,000 s: %.4f to %.4f of 0.664 B\n", least, most);
  EXPECT_GT(least, 0.98);
  EXPECT_LT(most, 1.02);
  const TriadErrorParams p = [] {
    TriadErrorParams q;
    q.bias_instability = 2;
    return q;
  }();
  const auto c = MakeCoefficients(p, Rate(100), {RandomStream(1, "a", 0), 0});
  EXPECT_NEAR(c.pole_sd * c.pole_sd, 4 * sigma2, 1e-12);
  double T = 1e-2;
  for (const GaussMarkov& pole : c.poles) {
    EXPECT_NEAR(std::log(pole.decay), -0.01 * static_cast<double>(pole.hold) / T, 1e-12);
    T *= 10;
  }
}

TEST(ImuTerms, QuantisationHasTheAllanVarianceOfIeee952) {
  TriadErrorParams p;
  p.quantisation = 3e-5;
  const std::int64_t n = 300'000;
  const auto x = Record(p, n, 0);
  for (const std::size_t m : {1, 10, 100}) {
    const double tau = 0.01 * static_cast<double>(m);
    const double expected = 3 * p.quantisation * p.quantisation / (tau * tau);
    // n independent roundings enter, each in at most three differences: edf about n / 3 or more
    const double bound = kSigmas * std::sqrt(2.0 * 3 / static_cast<double>(n));
    EXPECT_NEAR(CalcAllanVariance(x, m) / expected, 1, bound) << m;
  }
  double angle = 0;  // the integral never strays by more than one count
  for (const double e : x) {
    angle += 0.01 * e;
    ASSERT_LE(std::abs(angle), std::sqrt(12.0) * p.quantisation);
  }
}

TEST(ImuTerms, GaussMarkovBiasHasItsSdAndItsCorrelation) {
  TriadErrorParams p;
  p.gauss_markov_sd = 0.02;
  p.gauss_markov_time_s = 0.5;
  const std::int64_t n = 20'000;
  const int runs = 20;
  double variance = 0, lagged = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto x = Record(p, n, run);
    for (std::size_t k = 50; k < x.size(); ++k) variance += x[k] * x[k], lagged += x[k] * x[k - 50];
  }
  const double count = runs * (n - 50.0), decay = std::exp(-0.01 / 0.5);
  // independent pairs: count (1 - a^2) / (1 + a^2), for the square of a first-order sequence
  const double independent = count * (1 - decay * decay) / (1 + decay * decay);
  const double bound = kSigmas * std::sqrt(2 / independent);
  EXPECT_NEAR(variance / count / 4e-4, 1, bound);
  EXPECT_NEAR(lagged / count / 4e-4, std::exp(-1), bound);
}

TEST(ImuTerms, RampGrowsWithTime) {
  const auto imu =
      MakeImu({{"rate_Hz", 100.0}, {"gyro.rate_ramp_rad_s2", std::vector<double>{1e-3, 0, -2e-3}}});
  Play(Spinning(Vector3d::Zero()), *imu, Rate(1000), 201, [&](std::int64_t k, const auto& value, auto&) {
    const auto& w = std::get<ImuSample>(value).w_WS_S_rad_s;
    const double t = static_cast<double>(k) / 100;
    EXPECT_LT((w - Vector3d(1e-3 * t, 0, -2e-3 * t)).norm(), 1e-15);
  });
}

TEST(ImuTerms, TemperatureApproachesTheWatersWithItsTimeConstant) {
  ThermalParams p;
  p.initial_C = 30;
  p.heat_capacity_J_K = 120;
  p.conductance_W_K = 0.4;
  EXPECT_DOUBLE_EQ(CalcTimeConstant_s(p), 300);
  EXPECT_DOUBLE_EQ(CalcTemperature_C(p, 8, 0), 30);
  EXPECT_NEAR(CalcTemperature_C(p, 8, 300), 8 + 22 / std::numbers::e, 1e-12);
  p.time_constant_s = 60;
  EXPECT_NEAR(CalcTemperature_C(p, 8, 120), 8 + 22 * std::exp(-2), 1e-12);
}

TEST(ImuTerms, TemperatureMovesBiasAndScale) {
  SensorContext context = MakeImuContext();
  context.water_temperature_C = 5;
  const auto s = FirstSample({{"rate_Hz", 100.0},
                              {"thermal.initial_C", 5.0},  // at the water's temperature from the start
                              {"reference_C", 25.0},
                              {"gyro.temperature_bias_rad_s_per_K", std::vector<double>{1e-3, 0, 0}},
                              {"gyro.temperature_scale_per_K", std::vector<double>{0, 1e-4, 0}},
                              {"accel.temperature_scale_per_K", std::vector<double>{0, 0, 2e-4}}},
                             {0, 10, 0}, context);
  EXPECT_NEAR(s.w_WS_S_rad_s.x(), -20 * 1e-3, 1e-12);
  EXPECT_NEAR(s.w_WS_S_rad_s.y(), 10 * (1 - 20 * 1e-4), 1e-12);
  // gravity's mean along z over the 0.1 rad that the ball turns meanwhile
  EXPECT_NEAR(s.f_WS_S_m_s2.z(), kG * std::sin(0.1) / 0.1 * (1 - 20 * 2e-4), 1e-7);
}

TEST(ImuTerms, SecondOrderAndAsymmetryBendTheScale) {
  const testing::ParamValues bent{{"gyro.scale_second_order_per_rad_s", std::vector<double>{1e-4, 1e-4, 0}},
                                  {"gyro.scale_asymmetry", std::vector<double>{0, 2e-3, 2e-3}}};
  const auto plus = FirstSample(bent, {20, 0, 0}), minus = FirstSample(bent, {-20, 0, 0});
  EXPECT_NEAR(plus.w_WS_S_rad_s.x(), 20 * (1 + 20e-4), 1e-10);
  EXPECT_NEAR(minus.w_WS_S_rad_s.x(), -20 * (1 + 20e-4), 1e-10);
  EXPECT_NEAR(FirstSample(bent, {0, 0, 10}).w_WS_S_rad_s.z(), 10 * (1 + 1e-3), 1e-10);
  EXPECT_NEAR(FirstSample(bent, {0, 0, -10}).w_WS_S_rad_s.z(), -10 * (1 - 1e-3), 1e-10);
  EXPECT_NEAR(FirstSample(bent, {0, 10, 0}).w_WS_S_rad_s.y(), 10 * (1 + 1e-3 + 1e-3), 1e-10);
}

TEST(ImuTerms, ScaleInstabilityScalesAndNothingElse) {
  const testing::ParamValues values{{"gyro.scale_instability", 0.01},
                                    {"gyro.scale_instability_time_s", 10.0}};
  const int runs = 2000;
  double squares = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto s = FirstSample(values, {0, 20, 0}, MakeImuContext(Rate(1000), run));
    EXPECT_NEAR(s.w_WS_S_rad_s.x(), 0, 1e-14);
    squares += std::pow(s.w_WS_S_rad_s.y() / 20 - 1, 2) / runs;
  }
  EXPECT_NEAR(squares / 1e-4, 1, kSigmas * std::sqrt(2.0 / runs));
}

TEST(ImuTerms, MisalignmentIsDrawnPerElementAndRun) {
  TriadErrorParams p;
  p.misalignment_sd = 2e-3;
  const int runs = 2000;
  Matrix3d squares = Matrix3d::Zero();
  double product = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto c = MakeCoefficients(p, Rate(100), {RandomStream(3, "imu0", run), 0});
    const Matrix3d m = c.sensitivity - Matrix3d::Identity();
    squares += m.cwiseAbs2() / (runs * 4e-6);
    product += m(0, 1) * m(1, 0) / (runs * 4e-6);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(squares(i, j), i == j ? 0 : 1, kSigmas * std::sqrt(2.0 / runs));
  }
  EXPECT_NEAR(product, 0, kSigmas / std::sqrt(1.0 * runs));
}

TEST(ImuTerms, AMountingErrorTurnsBothTriadsButNotWhatTheCrewKnows) {
  const auto s =
      FirstSample({{"rate_Hz", 1000.0}, {"mounting_error_rad", std::vector<double>{0, 0, 0.01}}}, {5, 0, 0});
  EXPECT_LT((s.w_WS_S_rad_s - 5 * Vector3d(std::cos(0.01), -std::sin(0.01), 0)).norm(), 1e-12);
  const auto imu = MakeImu({{"mounting_error_sd_rad", 0.05}});
  EXPECT_EQ(imu->X_BS().q.angularDistance(Quaterniond::Identity()), 0);
}

TEST(ImuTerms, EveryAccelerometerFeelsTheSpinAtItsOwnPlace) {
  // about y at 33 rad/s: a = -w^2 (x, 0, z); row i is where accelerometer i sits
  const testing::ParamValues places{
      {"rate_Hz", 200.0},
      {"accel_positions_m", std::vector<double>{2e-3, 0, 1e-3, 5e-3, 0, 5e-3, -1e-3, 0, 3e-3}}};
  for (const char* output : {"mean", "point"}) {
    testing::ParamValues with = places, without{{"rate_Hz", 200.0}};
    with["output"] = without["output"] = std::string(output);
    const Vector3d size_effect =
        FirstSample(with, {0, 33, 0}).f_WS_S_m_s2 - FirstSample(without, {0, 33, 0}).f_WS_S_m_s2;
    EXPECT_LT((size_effect - Vector3d(-33 * 33 * 2e-3, 0, -33 * 33 * 3e-3)).norm(), 1e-10) << output;
  }
}

TEST(ImuTerms, AccelerometersFeelTheAngularAccelerationAtTheirOwnPlaces) {
  // about z, w = 6 t: a at (x, y) is (-w^2 x - 6 y, -w^2 y + 6 x)
  const testing::FunctionScript script([](double t) {
    ScriptPoint s;
    s.X_WB.q = ExpSO3({0, 0, 3 * t * t});
    s.w_WB_B = {0, 0, 6 * t};
    return s;
  });
  const auto imu = MakeImu({{"rate_Hz", 1000.0},
                            {"gyro.scale_asymmetry", std::vector<double>{1e-12, 0, 0}},  // step by step
                            {"accel_positions_m", std::vector<double>{0, 2e-3, 0, 1e-3, 0, 0, 0, 0, 0}}});
  Play(script, *imu, Rate(1000), 1, [&](auto, const auto& value, auto&) {
    const Vector3d f = std::get<ImuSample>(value).f_WS_S_m_s2;
    EXPECT_NEAR(f.x(), -6 * 2e-3, 1e-9);
    EXPECT_NEAR(f.y(), 6 * 1e-3, 1e-9);
  });
}

TEST(ImuTerms, VibrationRectifiesTheSquareOfItsForce) {
  // 50 Hz along x with an acceleration amplitude of 4 m/s^2, at rest otherwise: mean square 8
  const double a = 4, omega = 2 * std::numbers::pi * 50;
  const testing::FunctionScript shaken([=](double t) {
    ScriptPoint s;
    s.X_WB.p.x() = -a / (omega * omega) * std::sin(omega * t);
    s.v_WB_W.x() = -a / omega * std::cos(omega * t);
    s.a_WB_W.x() = a * std::sin(omega * t);
    return s;
  });
  const double k_accel = 1e-4, k_gyro = 1e-5;
  const auto imu =
      MakeImu({{"rate_Hz", 10.0},
               {"accel.vibration_rectification_m_s2_per_m2_s4", std::vector<double>{k_accel, 0, 0}},
               {"gyro.vibration_rectification_rad_s_per_m2_s4", std::vector<double>{0, k_gyro, 0}}},
              MakeImuContext(Rate(2000)));
  Play(shaken, *imu, Rate(2000), 5, [&](auto, const auto& value, auto&) {
    const auto& s = std::get<ImuSample>(value);
    EXPECT_NEAR(s.f_WS_S_m_s2.x(), k_accel * a * a / 2, 0.01 * k_accel * a * a / 2);
    EXPECT_NEAR(s.w_WS_S_rad_s.y(), k_gyro * (kG * kG + a * a / 2), 1e-3 * k_gyro * kG * kG);
    EXPECT_NEAR(s.w_WS_S_rad_s.x(), 0, 1e-15);
  });
}

TEST(ImuTerms, WhiteNoiseKeepsItsDensityBehindAFilter) {
  const double N = 1e-3;
  const auto imu = MakeImu(
      {{"rate_Hz", 100.0}, {"gyro.noise_rad_s_sqrtHz", N}, {"gyro.filter.analogue_bandwidth_Hz", 20.0}});
  std::vector<double> x;
  const std::int64_t n = 60'000;
  Play(Spinning(Vector3d::Zero()), *imu, Rate(1000), n,
       [&](auto, const auto& value, auto&) { x.push_back(std::get<ImuSample>(value).w_WS_S_rad_s.x()); });
  // far above the filter's 8 ms the density is N; sd at 100 Hz: noise bandwidth pi/2 20 Hz of both sides,
  // thinned by the mean over 10 ms: int |H|^2 sinc^2 = 1/T - (1 - e^-a)/(a T), a = w_c T
  const double bound = kSigmas * std::sqrt(2 / testing::CalcEdfWhite(static_cast<std::size_t>(n), 100));
  EXPECT_NEAR(CalcAllanVariance(x, 100) / (N * N / 1), 1, bound + 0.02);
  const double a = 2 * std::numbers::pi * 20 * 0.01;
  const double variance = N * N / 0.01 * (1 - (1 - std::exp(-a)) / a);
  double squares = 0;
  for (const double e : x) squares += e * e / static_cast<double>(n);
  EXPECT_NEAR(squares / variance, 1, 0.03);
}

TEST(ImuTerms, PointOutputIsTheStateAtTheStamp) {
  // about z, w = 6 t
  const testing::FunctionScript script([](double t) {
    ScriptPoint s;
    s.X_WB.q = ExpSO3({0, 0, 3 * t * t});
    s.w_WB_B = {0, 0, 6 * t};
    return s;
  });
  for (const bool filtered : {false, true}) {
    testing::ParamValues values{{"rate_Hz", 50.0}, {"output", std::string("point")}};
    if (filtered)
      values["gyro.filter.digital"] = std::string("boxcar"), values["gyro.filter.digital_taps"] = 1.0;
    const auto imu = MakeImu(values);
    Play(script, *imu, Rate(1000), 10, [&](std::int64_t k, const auto& value, auto&) {
      const double t = static_cast<double>(k + 1) / 50;
      // step by step the internal samples are means over a step: half a step old
      const double expected = 6 * (filtered ? t - 0.0005 : t);
      EXPECT_NEAR(std::get<ImuSample>(value).w_WS_S_rad_s.z(), expected, 1e-9);
    });
  }
}

}  // namespace
}  // namespace piperun::sim
