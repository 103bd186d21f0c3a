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

/// A ball that touches the floor of a bore along x.
WaterAtBall OnTheFloor(double bore_radius_m) {
  WaterAtBall water = Still(bore_radius_m);
  water.from_wall_W = Vector3d::UnitZ();
  return water;
}

TEST(FluidLoad, LiftPushesOffTheWallAndIsThatOfTheSlipAlongThePipe) {
  WaterAtBall water = OnTheFloor(1e4);
  water.velocity_W = {0.5, 0.3, -0.2};
  const FluidLoad load = CalcFluidLoad(Coefficients(kBall, {}), {-0.1, 0, 0}, Vector3d::Zero(), water);
  // 500 pi 0.03^2 0.2 0.6^2 = 0.10179 N: lifts the ball, which weighs 0.111 N, at 0.63 m/s
  EXPECT_NEAR(load.lift_W_N.z(), 0.101788, 1e-6);
  EXPECT_EQ(load.lift_W_N.head<2>().norm(), 0);
}

TEST(FluidLoad, LiftFadesFromTheWallAndIsNilOnTheAxis) {
  WaterAtBall water = OnTheFloor(0.075);
  water.velocity_W = {1, 0, 0};
  const auto lift = [&](double gap_m) {
    water.wall_gap_m = gap_m;
    return CalcFluidLoad(Coefficients(kBall, {}), Vector3d::Zero(), Vector3d::Zero(), water).lift_W_N.z();
  };
  const double full = 500 * std::numbers::pi * 0.03 * 0.03 * 0.2;
  EXPECT_NEAR(lift(0) / full, 1 - 1.0 / 64, 1e-12);                     // (3/12)^3 of the wall across
  EXPECT_NEAR(lift(0.03) / full, 0.125 - std::pow(1 / 3.0, 3), 1e-12);  // (3/6)^3 - (3/9)^3
  EXPECT_NEAR(lift(0.045), 0, 1e-15);
}

TEST(FluidLoad, MagnusForceOfATopspinPointsDown) {
  // along x with the top going forward (w along y), far from walls: as a tennis ball with topspin, it dives.
  // S = 0.03 2/0.5 = 0.12, F = 500 pi 0.03^2 0.2 0.12 0.5^2 / sqrt(1 + (0.024/0.5)^2) = 8.472e-3 N
  const FluidLoad load = CalcFluidLoad(Coefficients(kBall, {}), {0.5, 0, 0}, {0, 2, 0}, Still(1e4));
  EXPECT_NEAR(load.magnus_W_N.z(), -8.4725e-3, 1e-6);
  EXPECT_EQ(load.magnus_W_N.head<2>().norm(), 0);
}

TEST(FluidLoad, MagnusForceIsOfTheMotionAgainstTheWaterAndSaturates) {
  // carried with the water and turning with it there is none; at most 0.5 of the slip's dynamic pressure
  WaterAtBall water = Still(0.075);
  water.velocity_W = {1, 0, 0};
  water.spin_W = {0, -5, 0};
  const FluidLoadCoefficients c = Coefficients(kBall, {});
  EXPECT_EQ(CalcFluidLoad(c, {0.9, 0, 0}, {0, -5, 0}, water).magnus_W_N.norm(), 0);
  EXPECT_EQ(CalcFluidLoad(c, {1, 0, 0}, {0, 30, 0}, water).magnus_W_N.norm(), 0);
  const double pressure_N = 500 * std::numbers::pi * 0.03 * 0.03 * 0.01;
  const double lift = CalcFluidLoad(c, {0.9, 0, 0}, {0, 1e4, 0}, water).magnus_W_N.z();
  EXPECT_NEAR(lift / pressure_N, 0.5, 1e-4) << "slower than the water, topspin lifts";
}

TEST(FluidLoad, RollingDownAPlaneIsJanAndChens) {
  // C_D = (4/3) (SG - 1) g d sin(slope) / V^2 holds all the water's resistance: drag, and torque over radius,
  // to be overcome by the weight's part down the plane. Expected speed from the printed law.
  for (const double sg : {1.02, 1.1, 1.5}) {
    for (const double k_spin : {0.0, 0.6, 1.0}) {
      BallParams ball = kBall;
      ball.density_kg_m3 = 1000 * sg;
      ball.spin_drag_factor = k_spin;
      const double d = 0.06, slope = 0.05;
      double v = 0.1;
      for (int i = 0; i < 200; ++i) {
        const double x = std::log10(v * d / 1e-6);
        const double c_d = std::max(0.74, std::pow(10, 3.02 - 1.89 * x + 0.411 * x * x - 0.033 * x * x * x));
        v = std::sqrt(4.0 / 3 * (sg - 1) * kGravity * d * std::sin(slope) / c_d);
      }
      const FluidLoad load =
          CalcFluidLoad(Coefficients(ball, {}), {v, 0, 0}, {0, v / 0.03, 0}, OnTheFloor(1e5));
      const double resistance = -load.drag_W_N.x() - load.spin_torque_W_N_m.y() / 0.03;
      EXPECT_NEAR(resistance / (load.weight_W_N.norm() * std::sin(slope)), 1, 1e-9) << sg << " " << k_spin;
    }
  }
}

TEST(FluidLoad, WallsDragFadesToTheTubesOnTheAxis) {
  WaterAtBall water = OnTheFloor(0.075);
  water.velocity_W = {0.3, 0, 0};
  const auto drag = [&](const ForceParams& forces, double gap_m) {
    water.wall_gap_m = gap_m;
    return CalcFluidLoad(Coefficients(kBall, forces), Vector3d::Zero(), Vector3d::Zero(), water).drag_W_N.x();
  };
  EXPECT_GT(drag({}, 0), drag({}, 0.01));
  EXPECT_GT(drag({}, 0.01), drag({}, 0.045));
  EXPECT_DOUBLE_EQ(drag({}, 0.045), drag(kFarFromWalls, 0.045));
}

TEST(FluidLoad, EverySwitchTakesItsOwnLoadAwayAndNoOther) {
  WaterAtBall water = OnTheFloor(0.075);
  water.velocity_W = {0.4, 0.1, 0};
  water.acceleration_W = {0, 2, 0};
  water.spin_W = {0, 3, 0};
  water.pressure_fall_W_Pa_m = {67, 0, 0};
  const auto calc = [&](const ForceParams& forces) {
    return CalcFluidLoad(Coefficients(kBall, forces), {0.1, 0, 0}, {0, 10, 0}, water);
  };
  const FluidLoad all = calc({});
  const auto expect_without = [&](const ForceParams& forces, Vector3d FluidLoad::*gone) {
    FluidLoad expected = all;
    EXPECT_GT((expected.*gone).norm(), 0);
    expected.*gone = Vector3d::Zero();
    EXPECT_EQ(calc(forces).*gone, Vector3d::Zero());
    EXPECT_EQ(calc(forces).Force_W_N(), expected.Force_W_N());
  };
  expect_without({.lift = false}, &FluidLoad::lift_W_N);
  expect_without({.magnus = false}, &FluidLoad::magnus_W_N);
  expect_without({.fluid_acceleration = false}, &FluidLoad::fluid_acceleration_W_N);
  expect_without({.pressure_fall = false}, &FluidLoad::pressure_fall_W_N);
  EXPECT_EQ(calc({.spin_torque = false}).spin_torque_W_N_m, Vector3d::Zero());
  EXPECT_LT(calc({.rolling_drag = false}).drag_W_N.norm(), all.drag_W_N.norm());
  EXPECT_LT(calc({.wall_factor = "none"}).drag_W_N.norm(), all.drag_W_N.norm());
  EXPECT_NE(calc({.drag = "morrison"}).drag_W_N, all.drag_W_N);
}

TEST(FluidLoad, WallFactorIsTheSameFromItsTableAndSolved) {
  WaterAtBall water = Still(0.075);
  const FluidLoadCoefficients with_table = Coefficients();
  FluidLoadCoefficients without = with_table;
  without.wall_factors.clear();
  for (double v = 1e-6; v < 20; v *= 3) {
    const Vector3d v_WB_W(v, 0, 0);
    const double table = CalcFluidLoad(with_table, v_WB_W, Vector3d::Zero(), water).drag_W_N.x();
    EXPECT_NEAR(table / CalcFluidLoad(without, v_WB_W, Vector3d::Zero(), water).drag_W_N.x(), 1, 1e-6) << v;
  }
}

TEST(FluidLoad, RoughOrFoamCoveredBallHasNoDragCrisis) {
  // at Re = 4e5 Morrison's smooth sphere has C_D = 0.0874; before its crisis 0.435
  const auto drag_coefficient = [](const BallParams& ball) {
    const FluidLoadCoefficients c = Coefficients(
        ball,
        {.drag = "morrison", .wall_factor = "none", .rolling_drag = false, .lift = false, .magnus = false});
    const double v = 4e5 * 1e-6 / 0.06;
    return -CalcFluidLoad(c, {v, 0, 0}, Vector3d::Zero(), Still(1e4)).drag_W_N.x() /
           (500 * std::numbers::pi * 0.03 * 0.03 * v * v);
  };
  BallParams smooth = kBall, rough = kBall, foam = kBall;
  smooth.roughness_m = 0.9e-3 * 0.06;
  rough.roughness_m = 1e-3 * 0.06;
  foam.foam_thickness_m = 0.01;
  EXPECT_NEAR(drag_coefficient(smooth), 0.0874, 1e-4);
  EXPECT_NEAR(drag_coefficient(rough), 0.4354, 1e-4);
  EXPECT_NEAR(drag_coefficient(foam), 0.4354, 1e-4);
}

TEST(FluidLoad, AddedMassIsThatOfTheFirstBoreUnlessGiven) {
  const double displaced_kg = 1000 * kBall.volume_m3();
  EXPECT_DOUBLE_EQ(Coefficients().added_mass_kg, 0.5 * displaced_kg);
  BallParams ball = kBall;
  ball.added_mass_coefficient.reset();
  EXPECT_DOUBLE_EQ(Coefficients(ball).added_mass_kg, 0.621 * displaced_kg);  // d/D = 0.4: as along a plane
  const std::vector<double> bores{0.0375, 0.075};
  EXPECT_NEAR(
      CalcFluidLoadCoefficients(ball, {}, kWater, Vector3d::Zero(), bores).added_mass_kg / displaced_kg,
      1.565, 0.01);  // d/D = 0.8
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
