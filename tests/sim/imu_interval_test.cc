#include "sim/imu_interval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/function_script.h"

namespace piperun::sim {
namespace {

using testing::FunctionScript;
using testing::MakeTruth;

const Vector3d kGravity_W(0, 0, -9.80665);
const Vector3d kNoLever = Vector3d::Zero();

ImuInterval Interval(const TruthWindow& window, std::int64_t k, Rate rate, const Vector3d& p_BP) {
  return CalcImuInterval(window, SampleTime(k, rate), SampleTime(k + 1, rate), p_BP);
}

ImuIntervalIncrements Increments(const TruthWindow& window, std::int64_t k, Rate rate, const Vector3d& p_BP) {
  return CalcImuIncrements(window, SampleTime(k, rate), SampleTime(k + 1, rate), p_BP, kGravity_W);
}

/// Constant velocity far from the origin, turning about its own y axis.
FunctionScript UniformMotion(double spin_rad_s) {
  return FunctionScript([=](double t) {
    ScriptPoint s;
    s.v_WB_W = {0.9, -0.4, 0.2};
    s.X_WB = {Vector3d(100, -100, 100) + t * s.v_WB_W, ExpSO3({0, spin_rad_s * t, 0})};
    s.w_WB_B = {0, spin_rad_s, 0};
    return s;
  });
}

/// A ball on a circle: rolls at `spin` about its left while its heading turns at `turn`. No translation.
FunctionScript RollingInABend(double spin_rad_s, double turn_rad_s) {
  return FunctionScript([=](double t) {
    ScriptPoint s;
    s.X_WB.q = ExpSO3({0, 0, turn_rad_s * t}) * ExpSO3({0, spin_rad_s * t, -turn_rad_s * t});
    s.w_WB_B = s.X_WB.q.conjugate() * (ExpSO3({0, 0, turn_rad_s * t}) * Vector3d(0, spin_rad_s, 0));
    return s;
  });
}

TEST(ImuInterval, RestReadsMinusGravity) {
  const Quaterniond q = ExpSO3({0.4, -1.1, 2.0});
  const auto window = MakeTruth(FunctionScript([&](double) {
                                  ScriptPoint s;
                                  s.X_WB = {{100, 50, -30}, q};
                                  return s;
                                }),
                                Rate(1000), 10, kGravity_W);
  const ImuInterval mean = Interval(window, 1, Rate(400), {0.01, 0.02, 0.03});
  const Vector3d expected = q.conjugate() * -kGravity_W;
  EXPECT_EQ(mean.w_mean_rad_s, Vector3d(0, 0, 0));
  EXPECT_LT((mean.f_mean_m_s2 - expected).norm(), 5e-15);
  const ImuIntervalIncrements whole = Increments(window, 1, Rate(400), {0.01, 0.02, 0.03});
  EXPECT_EQ(whole.dtheta_rad, Vector3d(0, 0, 0));
  EXPECT_LT((whole.dv_m_s / whole.duration_s - expected).norm(), 5e-15);
}

TEST(ImuInterval, ConstantVelocityFarFromTheOriginHasNoSpuriousForce) {
  for (const double hertz : {1000.0, 4000.0, 10000.0}) {
    const Rate rate(hertz);
    const auto window = MakeTruth(UniformMotion(0), rate, 1000, kGravity_W);
    double rates = 0, increments = 0;
    for (std::int64_t k = 0; k < 1000; ++k) {
      const ImuInterval mean = Interval(window, k, rate, {0.005, 0, 0});
      rates += (mean.f_mean_m_s2 + kGravity_W).squaredNorm();
      const ImuIntervalIncrements whole = Increments(window, k, rate, {0.005, 0, 0});
      increments += (whole.dv_m_s / whole.duration_s + kGravity_W).squaredNorm();
    }
    EXPECT_LE(std::sqrt(rates / 1000), 1e-8) << hertz;
    EXPECT_LE(std::sqrt(increments / 1000), 1e-8) << hertz;
  }
}

TEST(ImuInterval, SpinningFarFromTheOriginKeepsTheSizeOfGravity) {
  const Rate rate(1000);
  const auto window = MakeTruth(UniformMotion(33), rate, 1000, kGravity_W);
  double squares = 0;
  for (std::int64_t k = 0; k < 1000; ++k) {
    const double f = Increments(window, k, rate, kNoLever).dv_m_s.norm() / rate.Period_s();
    squares += (f - 9.80665) * (f - 9.80665);
  }
  EXPECT_LE(std::sqrt(squares / 1000), 1e-8);
}

TEST(ImuInterval, LeverArmAtConstantSpinReadsTheCentripetalAcceleration) {
  const auto window = MakeTruth(UniformMotion(33), Rate(1000), 20, kGravity_W);
  const Vector3d l(0.004, 0.002, -0.003);
  for (const double hertz : {100.0, 333.0, 400.0, 1000.0}) {
    const Rate rate(hertz);
    const Vector3d lever =
        Interval(window, 1, rate, l).f_mean_m_s2 - Interval(window, 1, rate, kNoLever).f_mean_m_s2;
    EXPECT_LT((lever - Vector3d(-33 * 33 * 0.004, 0, 33 * 33 * 0.003)).norm(), 1e-11) << hertz;
  }
}

TEST(ImuInterval, LeverArmReadsTheTangentialAcceleration) {
  // angle = 3 t^2 about z: w = 6 t, w' = 6; the point at (l, 0, 0) feels (-w^2 l, 6 l, 0)
  const auto window = MakeTruth(FunctionScript([](double t) {
                                  ScriptPoint s;
                                  s.X_WB.q = ExpSO3({0, 0, 3 * t * t});
                                  s.w_WB_B = {0, 0, 6 * t};
                                  return s;
                                }),
                                Rate(1000), 1000, kGravity_W);
  const ImuInterval mean = Interval(window, 500, Rate(1000), {0.01, 0, 0});
  EXPECT_NEAR(mean.f_mean_m_s2.y(), 0.06, 1e-9);
  EXPECT_NEAR(mean.f_mean_m_s2.x(), -(6 * 0.5005) * (6 * 0.5005) * 0.01, 1e-9);
}

TEST(ImuInterval, AveragesGravityOverTheTurnOfASpinningBall) {
  // about y: R^T (0, 0, g) = g (-sin wt, 0, cos wt); its mean over [a, b] in closed form
  const double w = 33, g = 9.80665;
  const auto window = MakeTruth(UniformMotion(w), Rate(1000), 50, kGravity_W);
  for (const double hertz : {100.0, 333.0, 400.0, 1000.0}) {
    const Rate rate(hertz);
    const double a = Seconds(SampleTime(2, rate)), b = Seconds(SampleTime(3, rate));
    const Vector3d expected =
        g / (w * (b - a)) * Vector3d(std::cos(w * b) - std::cos(w * a), 0, std::sin(w * b) - std::sin(w * a));
    // the error of one half box is g (w dt / 2)^4 / 1920 = 4e-10
    EXPECT_LT((Interval(window, 2, rate, kNoLever).f_mean_m_s2 - expected).norm(), 1e-9) << hertz;
  }
}

TEST(ImuInterval, TimeTagsTheSpecificForceToSecondOrder) {
  // a = A sin(t) along x; the mean over an interval is A (cos a - cos b) / (b - a)
  const auto script = FunctionScript([](double t) {
    ScriptPoint s;
    s.X_WB.p = {-std::sin(4 * t), 0, 0};
    s.v_WB_W = {-4 * std::cos(4 * t), 0, 0};
    s.a_WB_W = {16 * std::sin(4 * t), 0, 0};
    return s;
  });
  const auto error = [&](double physics_Hz) {
    const auto window =
        MakeTruth(script, Rate(physics_Hz), static_cast<std::int64_t>(physics_Hz), kGravity_W);
    const Rate rate(25);
    const double a = 0.4, b = 0.44;  // sample 10
    const double expected = 4 * (std::cos(4 * a) - std::cos(4 * b)) / (b - a);
    return std::abs(Interval(window, 10, rate, kNoLever).f_mean_m_s2.x() - expected);
  };
  // boxes are a trapezoid here: error dt^2/12 (a'(b) - a'(a))/(b - a)
  const double expected = 1e-4 / 12 * 64 * std::abs(std::cos(1.76) - std::cos(1.6)) / 0.04;
  EXPECT_NEAR(error(100), expected, 0.02 * expected);
  EXPECT_NEAR(error(100) / error(200), 4, 0.02);
}

TEST(ImuInterval, ARateThatDoesNotDivideThePhysicsRateConservesTheIntegrals) {
  // angle about x: 5 t + sin(9 t); velocity along y: sin(4 t) / 4
  const auto window =
      MakeTruth(FunctionScript([](double t) {
                  ScriptPoint s;
                  s.X_WB = {{0, -std::cos(4 * t) / 16, 0}, ExpSO3({5 * t + std::sin(9 * t), 0, 0})};
                  s.v_WB_W = {0, std::sin(4 * t) / 4, 0};
                  s.a_WB_W = {0, std::cos(4 * t), 0};
                  s.w_WB_B = {5 + 9 * std::cos(9 * t), 0, 0};
                  return s;
                }),
                Rate(1000), 1000, kGravity_W);
  for (const double hertz : {333.0, 997.0, 400.0, 17.0}) {
    const Rate rate(hertz);
    double angle = 0, time = 0;
    Vector3d v = window.at(0).v_WB_W;
    Quaterniond q = window.at(0).X_WB.q;
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(hertz); ++k) {
      const ImuInterval mean = Interval(window, k, rate, kNoLever);
      angle += mean.w_mean_rad_s.x() * mean.duration_s;
      time += mean.duration_s;
      const ImuIntervalIncrements whole = Increments(window, k, rate, kNoLever);
      v += q * whole.dv_m_s + whole.duration_s * kGravity_W;
      q = q * ExpSO3(whole.dtheta_rad);
    }
    EXPECT_NEAR(time, 1, 1e-12);
    EXPECT_NEAR(angle, 5 + std::sin(9), 1e-11) << hertz;
    EXPECT_LT((v - window.at(1000).v_step_W).norm(), 1e-11) << hertz;
    EXPECT_LT(LogSO3(q.conjugate() * window.at(1000).X_WB.q).norm(), 1e-11) << hertz;
  }
}

/// Heading error per turned angle of a plain integration of sample means, with or without the coning term.
double RelativeTurnError(double w_rad_s, bool compensated) {
  const double turn_rad_s = 0.5;
  const Rate rate(100);
  const auto window = MakeTruth(RollingInABend(w_rad_s, turn_rad_s), Rate(2000), 20 * 400, kGravity_W);
  Quaterniond q = Quaterniond::Identity();
  Vector3d before = Vector3d::Zero();
  for (std::int64_t k = 0; k < 400; ++k) {
    const ImuInterval mean = Interval(window, k, rate, kNoLever);
    const Vector3d dtheta = mean.w_mean_rad_s * mean.duration_s;
    q = q * ExpSO3(compensated ? Vector3d(dtheta + before.cross(dtheta) / 12) : dtheta);
    before = dtheta;
  }
  const Vector3d error_W = LogSO3(q * window.at(8000).X_WB.q.conjugate());
  return error_W.z() / (turn_rad_s * 4);
}

TEST(ImuInterval, AveragedRatesUnderestimateATurnByTheConingTerm) {
  for (const double w : {5.0, 10.0, 20.0}) {
    const double x = w * 0.01;
    // next order of the series is x^2 / 20 of it, and of the order of the turn per sample
    EXPECT_NEAR(std::abs(RelativeTurnError(w, false)) / (x * x / 12), 1, 0.05) << w;
    EXPECT_LT(std::abs(RelativeTurnError(w, true)), 0.1 * std::abs(RelativeTurnError(w, false))) << w;
  }
}

TEST(ImuInterval, IncrementsAtThePhysicsRateReturnTheTrajectoryOfThePoint) {
  const Vector3d l(0.01, -0.004, 0.006);
  const auto script = FunctionScript([](double t) {
    ScriptPoint s;
    s.X_WB = {{80 + std::sin(t), std::cos(2 * t), 0.3 * t * t},
              ExpSO3({0, 20 * t, 0}) * ExpSO3({0.3 * t, 0, 0})};
    s.v_WB_W = {std::cos(t), -2 * std::sin(2 * t), 0.6 * t};
    s.a_WB_W = {-std::sin(t), -4 * std::cos(2 * t), 0.6};
    const Vector3d spin(0, 20, 0);
    s.w_WB_B = ExpSO3({-0.3 * t, 0, 0}) * spin + Vector3d(0.3, 0, 0);
    return s;
  });
  const Rate rate(1000);
  const auto window = MakeTruth(script, rate, 10'000, kGravity_W);
  const double dt = rate.Period_s();

  const TruthState& start = window.at(0);
  Quaterniond q = start.X_WB.q;
  Vector3d p = start.X_WB * l;
  Vector3d v = start.v_WB_W + q * start.w_WB_B.cross(l);
  for (std::int64_t k = 0; k < 10'000; ++k) {
    const ImuIntervalIncrements whole = Increments(window, k, rate, l);
    v += q * whole.dv_m_s + dt * kGravity_W;
    p += dt * v;
    q = q * ExpSO3(whole.dtheta_rad);
  }
  EXPECT_LT((p - window.at(10'000).X_WB * l).norm(), 1e-9);
  EXPECT_LT(LogSO3(q.conjugate() * window.at(10'000).X_WB.q).norm(), 1e-11);
}

}  // namespace
}  // namespace piperun::sim
