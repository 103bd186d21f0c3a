#include "sim/truth.h"

#include <gtest/gtest.h>

#include "tests/support/function_script.h"

namespace piperun::sim {
namespace {

using testing::FunctionScript;
using testing::MakeTruth;

constexpr double kSpin_rad_s = 7;

/// p = (1 + t^2, t^3, -2 t), turning about z.
ScriptPoint CubicMotion(double t) {
  ScriptPoint s;
  s.X_WB = {{1 + t * t, t * t * t, -2 * t}, ExpSO3({0, 0, kSpin_rad_s * t})};
  s.v_WB_W = {2 * t, 3 * t * t, -2};
  s.a_WB_W = {2, 6 * t, 0};
  s.w_WB_B = {0, 0, kSpin_rad_s};
  return s;
}

TEST(TruthWindow, FindsTheStepOfAnyNanosecond) {
  for (const double hertz : {333.0, 400.0, 1000.0, 3000.0, 7919.0}) {
    const Rate rate(hertz);
    const TruthWindow window(rate, 2);
    for (std::int64_t k = 1; k < 40000; k += 37) {
      EXPECT_EQ(window.StepAt(SampleTime(k, rate)), k);
      EXPECT_EQ(window.StepAt(SampleTime(k, rate) - Duration(1)), k - 1);
    }
  }
}

TEST(TruthWindow, KeepsTheLatestSteps) {
  const Rate rate(1000);
  TruthWindow window(rate, 3);  // rounded up to a power of two
  TruthState state;
  for (std::int64_t k = 0; k < 7; ++k) {
    state.time = SampleTime(k, rate);
    state.chainage_m = static_cast<double>(k);
    window.Push(state);
  }
  EXPECT_EQ(window.first(), 3);
  EXPECT_EQ(window.last(), 6);
  EXPECT_EQ(window.at(3).chainage_m, 3);
  EXPECT_EQ(window.at(6).chainage_m, 6);
}

TEST(TruthWindowDeathTest, RefusesStepsItDoesNotHold) {
  const Rate rate(1000);
  TruthWindow window(rate, 2);
  TruthState state;
  for (std::int64_t k = 0; k < 4; ++k) {
    state.time = SampleTime(k, rate);
    window.Push(state);
  }
  EXPECT_DEATH(window.at(1), "not in the truth window");
  EXPECT_DEATH(window.at(4), "not in the truth window");
  EXPECT_DEATH(window.Push(state), "step by step");
}

TEST(Interpolate, IsExactAtWholeSteps) {
  const auto window = MakeTruth(FunctionScript(CubicMotion), Rate(333), 10, Vector3d::Zero());
  const TruthState s = Interpolate(window, window.at(7).time);
  EXPECT_EQ(s.X_WB.p, window.at(7).X_WB.p);
  EXPECT_EQ(s.X_WB.q.coeffs(), window.at(7).X_WB.q.coeffs());
  EXPECT_EQ(s.f_WB_B, window.at(7).f_WB_B);
}

TEST(Interpolate, FollowsACubicWithConstantSpinBetweenSteps) {
  const auto window = MakeTruth(FunctionScript(CubicMotion), Rate(100), 10, Vector3d::Zero());
  for (const int ns : {51'234'567, 55'000'000, 59'999'999}) {
    const TrueTime t{Duration(ns)};
    const TruthState s = Interpolate(window, t);
    const ScriptPoint exact = CubicMotion(Seconds(t));
    EXPECT_EQ(s.time, t);
    EXPECT_LT((s.X_WB.p - exact.X_WB.p).norm(), 1e-15);
    EXPECT_LT((s.v_WB_W - exact.v_WB_W).norm(), 2e-13);
    EXPECT_LT(LogSO3(s.X_WB.q.conjugate() * exact.X_WB.q).norm(), 1e-15);
  }
}

TEST(Interpolate, MixesScalarsLinearlyAndKeepsThePipeOfTheStepBefore) {
  TruthWindow window(Rate(1000), 2);
  TruthState a, b;
  b.time = SampleTime(1, Rate(1000));
  a.pipe = 3, b.pipe = 4;
  a.s_m = 9, b.s_m = 0.5;
  a.pressure_Pa = 100, b.pressure_Pa = 200;
  a.chainage_m = 1, b.chainage_m = 2;
  window.Push(a);
  window.Push(b);
  const TruthState s = Interpolate(window, TrueTime(Duration(250'000)));
  EXPECT_DOUBLE_EQ(s.pressure_Pa, 125);
  EXPECT_DOUBLE_EQ(s.chainage_m, 1.25);
  EXPECT_EQ(s.pipe, 3);
  EXPECT_EQ(s.s_m, 9);
}

}  // namespace
}  // namespace piperun::sim
