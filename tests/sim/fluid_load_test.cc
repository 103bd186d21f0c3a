#include "sim/fluid_load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/ball_world.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::MakePipeLine;
using testing::PipeLine;

const WaterProperties kWater{20, 1000, 1e-6, 1482};
constexpr double kGravity = 9.81;
const BallParams kBall{.radius_m = 0.03, .density_kg_m3 = 1100, .added_mass_coefficient = 0.5};

/// Without what a wall adds: the laws below are those of a free ball, or of one on the axis.
const ForceParams kFarFromWalls{.rolling_drag = false, .lift = false, .magnus = false};

FluidLoadCoefficients Coefficients(const BallParams& ball = kBall,
                                   const ForceParams& forces = kFarFromWalls) {
  return CalcFluidLoadCoefficients(ball, forces, kWater, {0, 0, -kGravity}, std::vector<double>{0.075});
}

/// Water at rest in a bore.
WaterAtBall Still(double bore_radius_m) {
  WaterAtBall water;
  water.bore_radius_m = bore_radius_m;
  return water;
}

/// Root of W = 1/2 rho A C_D(V d/nu) V^2, the correlation typed anew.
template <class DragCoefficient>
double SolveFreeTerminalVelocity(DragCoefficient drag_coefficient) {
  const double d = 0.06, weight = 100 * std::numbers::pi / 6 * d * d * d * kGravity;
  double low = 1e-3, high = 5;
  for (int i = 0; i < 200; ++i) {
    const double v = 0.5 * (low + high);
    const double drag = 500 * std::numbers::pi / 4 * d * d * drag_coefficient(v * d / 1e-6) * v * v;
    (drag < weight ? low : high) = v;
  }
  return low;
}

double BrownLawler(double re) { return 24 / re * (1 + 0.15 * std::pow(re, 0.681)) + 0.407 / (1 + 8710 / re); }

TEST(FluidLoad, DragBalancesWeightAtTheFreeTerminalVelocity) {
  const double v_t = SolveFreeTerminalVelocity(BrownLawler);
  const FluidLoad load = CalcFluidLoad(Coefficients(), {0, 0, -v_t}, Vector3d::Zero(), Still(1e4));
  EXPECT_NEAR(load.Force_W_N().z() / load.weight_W_N.z(), 0, 1e-9);
  // the published root with the Clift-Gauvin refit, which differs from Brown and Lawler by up to 0.6 % in C_D
  const double clift_gauvin = SolveFreeTerminalVelocity([](double re) {
    return 24 / re * (1 + 0.152 * std::pow(re, 0.677)) + 0.417 / (1 + 5070 * std::pow(re, -0.94));
  });
  EXPECT_NEAR(clift_gauvin, 0.420595, 5e-6);
  EXPECT_NEAR(v_t / clift_gauvin, 1, 0.003);
}

TEST(FluidLoad, SphereInATubeSettlesBetweenTheIndependentCorrelations) {
  const double v_t = SolveFreeTerminalVelocity(BrownLawler);
  for (const double l : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}) {
    const double newton = (1 - l * l) * std::sqrt(1 - 0.5 * l * l), munroe = 1 - std::pow(l, 1.5);
    const double di_felice = std::pow((1 - l) / (1 - 0.33 * l), 0.85);
    const auto excess = [&](double f) {
      return CalcFluidLoad(Coefficients(), {0, 0, -f * v_t}, Vector3d::Zero(), Still(0.03 / l))
          .Force_W_N()
          .z();
    };
    EXPECT_LT(excess(std::min(munroe, di_felice)), 0) << l;  // still gaining speed
    EXPECT_GT(excess(1.015 * newton), 0) << l;  // Kehlenbeck and Di Felice equal Newton within 1.5 %
  }
}

TEST(FluidLoad, IsStokesDragWhenSlowAndFinite) {
  const Vector3d v(1e-12, 0, 0);
  const FluidLoad load = CalcFluidLoad(Coefficients(), v, Vector3d::Zero(), Still(1e4));
  EXPECT_NEAR(load.drag_W_N.x() / (-3 * std::numbers::pi * 1e-3 * 0.06 * 1e-12), 1, 1e-3);
  EXPECT_EQ(CalcFluidLoad(Coefficients(), Vector3d::Zero(), Vector3d::Zero(), Still(0.075)).drag_W_N.norm(),
            0);
}

TEST(FluidLoad, DragOpposesTheSlipInEveryDirection) {
  WaterAtBall water = Still(0.075);
  water.velocity_W = {0.3, -0.2, 0.1};
  const FluidLoad load = CalcFluidLoad(Coefficients(), {0.1, 0.4, 0.2}, Vector3d::Zero(), water);
  const Vector3d slip = water.velocity_W - Vector3d(0.1, 0.4, 0.2);
  EXPECT_NEAR(load.drag_W_N.cross(slip).norm(), 0, 1e-15);
  EXPECT_GT(load.drag_W_N.dot(slip), 0);
}

TEST(FluidLoad, WeightAccelerationAndPressureFallAreTheirFormulas) {
  WaterAtBall water = Still(0.075);
  water.acceleration_W = {0, 2, 0};
  water.pressure_fall_W_Pa_m = {67, 0, 0};
  const FluidLoad load = CalcFluidLoad(Coefficients(), Vector3d::Zero(), Vector3d::Zero(), water);
  const double volume = 1.130973e-4;  // pi/6 0.06^3
  EXPECT_NEAR(load.weight_W_N.z(), -100 * volume * kGravity, 1e-7);
  EXPECT_NEAR(load.fluid_acceleration_W_N.y(), 1500 * volume * 2, 1e-6);  // rho V and half of it added
  EXPECT_NEAR(load.pressure_fall_W_N.x(), 67 * volume, 1e-8);
}

TEST(FluidLoad, SpinTorqueOfTheReferenceBall) {
  // 33.33 rad/s: Re_w = d^2 w/nu = 1.2e5, C_w = 12.9/sqrt(1.2e5) + 128.4/1.2e5 = 0.038309,
  // T = 500 * 0.03^5 * 0.038309 * 33.33^2 = 5.172e-4 N m; k_spin 0.6 of it
  BallParams ball = kBall;
  ball.spin_drag_factor = 0.6;
  const FluidLoad load = CalcFluidLoad(Coefficients(ball), Vector3d::Zero(), {0, 100.0 / 3, 0}, Still(0.075));
  EXPECT_NEAR(load.spin_torque_W_N_m.y(), -0.6 * 5.172e-4, 2e-7);
}

TEST(FluidLoad, SinkingBallReachesTerminalVelocity) {
  // in the Bullet world, on the axis of a riser, whatever the step; its speed makes the forces cancel
  const testing::BoreNetwork line = testing::MakeBoreLine({{0, 0, 100}, {0, 0, 0}});
  const FluidLoadCoefficients c = Coefficients();
  const auto sink = [&](double rate_Hz) {
    BallStart start;
    start.X_LB.p = {0, 0, 99};
    start.spot = testing::FindSpot(line.network, 0, start.X_LB.p);
    BallWorld world(line.bore, {0.03, kBall.mass_kg() + c.added_mass_kg, 4.5e-5, 0.4, 0}, Rate(rate_Hz),
                    start, [&](const BallInstant& ball) {
                      return BallLoad{CalcFluidLoad(c, ball.v_WB_W, ball.w_WB_W, Still(0.075)).Force_W_N(),
                                      Vector3d::Zero()};
                    });
    for (int i = 0; i < 20 * rate_Hz; ++i) world.Step();
    return -world.state().v_WB_W.z();
  };
  const double v = sink(1000);
  const FluidLoad load = CalcFluidLoad(c, {0, 0, -v}, Vector3d::Zero(), Still(0.075));
  EXPECT_NEAR(load.Force_W_N().z() / load.weight_W_N.z(), 0, 1e-9);
  EXPECT_NEAR(sink(100) / v, 1, 1e-9);
  EXPECT_NEAR(sink(4000) / v, 1, 1e-9);
  EXPECT_NEAR(v, 0.34, 0.005);  // 0.42 m/s free, times 0.80-0.81 at d/D = 0.4
}

}  // namespace
}  // namespace piperun::sim
