#include "sim/flow_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "sim/hydraulics.h"
#include "tests/support/pipes.h"
#include "tests/support/star.h"

namespace piperun::sim {
namespace {

using testing::MakePipeLine;
using testing::MakeStar;
using testing::PipeLine;
using testing::SpotIn;

const WaterProperties kWater{20, 1000, 1e-6, 1482};
constexpr double kGravity = 9.81;

SteadyFlow Solve(const PipeLine& line, double speed_m_s) {
  const double flow = speed_m_s * line.network.pipe(0).area_m2();
  return SolveSteadyFlow(line.network, line.route, {flow, 2e5}, {}, kWater, kGravity);
}

WaterAtBall EvalAt(const PipeLine& line, const SteadyFlow& flow, const Vector3d& p_W) {
  const Bore bore(line.network);
  StreamParams along;
  along.secondary_flow = false;
  const FlowField field(bore, flow.timeline, kWater, kGravity, 0.03, along);
  return field.Eval(SpotIn(line.network, 0, p_W), p_W, {});
}

TEST(FlowField, OnTheInvertOfAStraightPipe) {
  const PipeLine line = MakePipeLine({{0, 0, 5}, {100, 0, 5}}, {.roughness_m = 1e-4});
  const SteadyFlow flow = Solve(line, 1);
  const WaterAtBall water = EvalAt(line, flow, {10, 0, 5 - 0.045});
  // f = 0.02011: n = 7.05, u_eff/U between 1.035 (n = 7) and 1.031 (n = 8)
  EXPECT_NEAR(water.velocity_W.x(), 1.0348, 5e-4);
  EXPECT_EQ(water.velocity_W.tail<2>().norm(), 0);
  EXPECT_EQ(water.acceleration_W.norm(), 0);
  // slower towards the wall, that is downwards: the shear turns things about +y, like rolling
  EXPECT_GT(water.spin_W.y(), 1);
  EXPECT_NEAR(water.spin_W.x(), 0, 1e-15);
  // -dp/ds = f/D rho U^2/2 = 0.02011/0.15 * 500 = 67.0 Pa/m; REF: 7.6 mN on the ball
  EXPECT_NEAR(water.pressure_fall_W_Pa_m.x(), 67.03, 0.02);
  EXPECT_NEAR(water.pressure_Pa, 2e5 - 67.03 * 10 + 1000 * kGravity * 0.045, 0.3);
  EXPECT_DOUBLE_EQ(water.bulk_speed_m_s, 1);
}

TEST(FlowField, TurnsAsAFreeVortexInABend) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, {.bend_radius_m = 0.5});
  const SteadyFlow flow = Solve(line, 1);
  // middle of the bend; its centre is (9.5, 0.5); outward is (1, -1)/sqrt(2)
  const Vector3d outward = Vector3d(1, -1, 0).normalized(), centre(9.5, 0.5, 0);
  const WaterAtBall outer = EvalAt(line, flow, centre + 0.54 * outward);
  const WaterAtBall inner = EvalAt(line, flow, centre + 0.46 * outward);
  EXPECT_NEAR(outer.velocity_W.norm() * 0.54, inner.velocity_W.norm() * 0.46, 1e-12);
  EXPECT_NEAR((outer.acceleration_W + outer.velocity_W.squaredNorm() / 0.54 * outward).norm(), 0, 1e-12);
  EXPECT_NEAR((inner.acceleration_W + inner.velocity_W.squaredNorm() / 0.46 * outward).norm(), 0, 1e-12);
}

TEST(FlowField, RunsAgainstThePipeWhereTheFlowDoes) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {50, 0, 0}});
  const Route back = FindRoute(line.network, 1, 0);
  const SteadyFlow flow = SolveSteadyFlow(line.network, back, {0.01, 2e5}, {}, kWater, kGravity);
  const WaterAtBall water = EvalAt(line, flow, {30, 0, -0.045});
  EXPECT_LT(flow.timeline.Eval(0, 30, {}).flow_m3_s, 0);
  EXPECT_LT(water.bulk_speed_m_s, 0);
  EXPECT_LT(water.velocity_W.x(), 0);
  EXPECT_LT(water.pressure_fall_W_Pa_m.x(), 0);
}

TEST(FlowField, IsAtRestInStillWater) {
  const PipeLine line = MakePipeLine({{0, 0, 0}, {50, 0, 0}});
  const WaterAtBall water = EvalAt(line, Solve(line, 0), {20, 0.01, 0});
  EXPECT_EQ(water.velocity_W.norm(), 0);
  EXPECT_EQ(water.spin_W.norm(), 0);
  EXPECT_NEAR(water.pressure_Pa, 2e5, 1e-9);
}

/// Flows of a network's pipes that do not change, heads zero.
FlowTimeline MakeTimeline(const Network& network, const std::vector<double>& flows_m3_s) {
  std::vector<double> areas;
  FlowState state;
  for (std::size_t i = 0; i < flows_m3_s.size(); ++i) {
    const Pipe& pipe = network.pipes()[i];
    areas.push_back(pipe.area_m2());
    state.pipes.push_back({{0, pipe.length_m, flows_m3_s[i], 0, 0, 0.02}});
  }
  return FlowTimeline(areas, {TrueTime{}}, {state});
}

/// A bore with its flow, and what a ball of 3 cm sees.
struct Scene {
  Scene(Network n, const std::vector<double>& flows)
      : network(std::move(n)),
        bore(network),
        timeline(MakeTimeline(network, flows)),
        field(bore, timeline, kWater, kGravity, 0.03) {}
  WaterAtBall At(int pipe, const Vector3d& p) const { return field.Eval(SpotIn(network, pipe, p), p, {}); }

  Network network;
  Bore bore;
  FlowTimeline timeline;
  FlowField field;
};

using VelocityFunction = std::function<Vector3d(const Vector3d&)>;

/// Velocity gradient by central differences.
Matrix3d CalcSlope(const VelocityFunction& velocity, const Vector3d& p) {
  constexpr double kStep = 2e-6;
  Matrix3d slope;
  for (int j = 0; j < 3; ++j) {
    const Vector3d d = kStep * Vector3d::Unit(j);
    slope.col(j) = (velocity(p + d) - velocity(p - d)) / (2 * kStep);
  }
  return slope;
}

/// Divergence zero, Du/Dt = u . grad u, spin = 1/2 curl u, all against differences of the velocity itself.
/// `mean` is what separates the tabulated mean gradient from the slope of the tabulated mean velocity.
void ExpectConsistent(const Scene& scene, int pipe, const Vector3d& p, double speed, double mean) {
  const auto velocity = [&](const Vector3d& at) { return scene.At(pipe, at).velocity_W; };
  const double scale = speed / scene.network.pipe(pipe).radius_m();
  const WaterAtBall water = scene.At(pipe, p);
  const Matrix3d g = CalcSlope(velocity, p);
  EXPECT_NEAR(g.trace(), 0, 1e-6 * scale) << p.transpose();
  EXPECT_LT((g * water.velocity_W - water.acceleration_W).norm(), mean * scale * speed) << p.transpose();
  const Vector3d curl(g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1));
  EXPECT_LT((0.5 * curl - water.spin_W).norm(), mean * scale) << p.transpose();
}

/// 0.1 m that widens to 0.15 m over 0.2 m at its far end.
Network MakeReducer() {
  Network network = MakeStar({{Vector3d::UnitX(), 0.1, 2}});
  const_cast<Pipe&>(network.pipe(0)).cone_to = {0.2, 0.075};  // a network of the test's own
  return network;
}

TEST(FlowField, IsDivergenceFreeInAReducer) {
  const Scene scene(MakeReducer(), {0.008});
  for (const double s : {1.81, 1.85, 1.9, 1.95, 1.99}) {
    for (const double offset : {0.0, 0.004, 0.011, 0.0185}) {
      ExpectConsistent(scene, 0, {s, 0.6 * offset, 0.8 * offset}, 1, 5e-3);
    }
  }
}

TEST(FlowField, SlowsDownInAReducerAsItsAreaGrows) {
  const Scene scene(MakeReducer(), {0.008});
  for (const double s : {1.5, 1.85, 1.95}) {
    const double radius = s < 1.8 ? 0.05 : 0.05 + 0.025 * (s - 1.8) / 0.2;
    const WaterAtBall water = scene.At(0, {s, 0, 0});
    const double bulk = 0.008 / (std::numbers::pi * radius * radius);
    EXPECT_NEAR(water.bulk_speed_m_s, bulk, 1e-12);
    EXPECT_NEAR(water.bore_radius_m, radius, 1e-12);
    // the disc mean of a power law at that very d/D; what interpolation between the ends' tables costs
    const auto exact = [](double r) {
      return DiscMeanTable(0.03 / r).Eval(CalcVelocityProfile(2e5, 0.02), 0).velocity;
    };
    EXPECT_NEAR(water.velocity_W.x() / bulk, exact(radius), 0.006) << s;
    if (s < 1.8) continue;
    // u du/ds with u = U m: dU/ds = -2 U R'/R, and the mean m grows as the ball gets smaller beside the bore
    const double slope = (exact(radius + 1e-4) - exact(radius - 1e-4)) / 2e-4;
    const double du_ds = bulk * 0.125 * (slope - 2 * exact(radius) / radius);
    EXPECT_NEAR(water.acceleration_W.x() / (bulk * exact(radius) * du_ds), 1, 0.02);
  }
}

TEST(FlowField, ContinuesThroughTheWideEndOfAReducer) {
  const Scene scene(MakeReducer(), {0.008});
  // the table at the wide end is that of a bore of 0.15 m
  const double u = scene.At(0, {2 - 1e-9, 0.03, 0}).velocity_W.x();
  const double exact = DiscMeanTable(0.4).Eval(CalcVelocityProfile(1e5, 0.02), 0.4).velocity;
  EXPECT_NEAR(u / (0.008 / (std::numbers::pi * 0.075 * 0.075)), exact, 2e-3);
}

/// Two pipes in line through the origin; the second carries less.
Scene MakeWithdrawal(double before, double after) {
  return Scene(MakeStar({{-Vector3d::UnitX(), 0.15, 3}, {Vector3d::UnitX(), 0.15, 3}}), {-before, after});
}

TEST(FlowField, LetsWithdrawnWaterOutThroughTheWall) {
  const Scene scene = MakeWithdrawal(0.018, 0.012);
  for (const double x : {-0.14, -0.08, -0.02, 0.03, 0.1, 0.149}) {
    for (const double offset : {0.0, 0.02, 0.044})
      ExpectConsistent(scene, x < 0 ? 0 : 1, {x, offset, 0}, 1, 6e-3);
  }
  EXPECT_GT(scene.At(0, {-0.08, 0.04, 0}).velocity_W.y(), 0.02);
  const double half = scene.At(1, {1e-9, 0, 0}).bulk_speed_m_s * scene.network.pipe(0).area_m2();
  EXPECT_NEAR(half, 0.015, 1e-9);
  EXPECT_NEAR(scene.At(0, {-1e-9, 0, 0}).velocity_W.x(), scene.At(1, {1e-9, 0, 0}).velocity_W.x(), 1e-6);
  EXPECT_EQ(scene.At(1, {0.151, 0.01, 0}).velocity_W.y(), 0);
}

/// A tee of 0.15 m: in along x from -3 m, out along x and y.
Scene MakeTee(double in, double branch) {
  return Scene(
      MakeStar({{-Vector3d::UnitX(), 0.15, 3}, {Vector3d::UnitX(), 0.15, 3}, {Vector3d::UnitY(), 0.15, 3}}),
      {-in, in - branch, branch});
}

TEST(FlowField, IsDivergenceFreeFromTheTeeToThePipe) {
  const Scene scene = MakeTee(0.018, 0.007);
  // core to 1.5 radii past the node's reach, fade to 2.5, profile to 6.5 (radii of 0.075 m from 0.075 m on)
  for (const double x : {0.0, 0.05, 0.12, 0.17, 0.22, 0.25, 0.27, 0.35, 0.45, 0.55, 0.6}) {
    for (const double offset : {0.0, 0.021, 0.043}) {
      ExpectConsistent(scene, 0, {-x, 0.8 * offset, -0.6 * offset}, 1, 6e-3);
      ExpectConsistent(scene, 2, {0.6 * offset, x + 1e-4, 0.8 * offset}, 1, 6e-3);
    }
  }
}

TEST(FlowField, IsContinuousFromTheTeeToThePipe) {
  const Scene scene = MakeTee(0.018, 0.007);
  const Vector3d off(0, 0.02, -0.03);
  const double core = 0.075 + 2.5 * 0.075;
  for (const double x : {core - 1.5 * 0.075, core, core + 4 * 0.075}) {
    const WaterAtBall a = scene.At(0, Vector3d(-x + 1e-9, 0, 0) + off);
    const WaterAtBall b = scene.At(0, Vector3d(-x - 1e-9, 0, 0) + off);
    EXPECT_LT((a.velocity_W - b.velocity_W).norm(), 1e-6) << x;
    EXPECT_LT((a.acceleration_W - b.acceleration_W).norm(), 2e-3) << x;
    EXPECT_NEAR(a.pressure_Pa, b.pressure_Pa, 1e-4);
    EXPECT_NEAR(a.bore_radius_m, b.bore_radius_m, 1e-8);
    EXPECT_LT((a.pressure_fall_W_Pa_m - b.pressure_fall_W_Pa_m).norm(), 1e-5);
  }
  // whose water it is makes no difference near the node
  const Vector3d p(0.01, 0.02, 0.01);
  EXPECT_LT((scene.At(1, p).velocity_W - scene.At(2, p).velocity_W).norm(), 1e-12);
}

TEST(FlowField, InATeeTurnsRoundThroughRest) {
  const Vector3d p(0.02, 0.03, 0.01);
  EXPECT_EQ(MakeTee(0, 0).At(1, p).velocity_W.norm(), 0);
  const Vector3d u = MakeTee(0.018, 0.007).At(1, p).velocity_W;
  EXPECT_LT((u + MakeTee(-0.018, -0.007).At(1, p).velocity_W).norm(), 1e-12);
}

TEST(FlowField, ShortPipesBetweenTeesShareTheirLength) {
  // two tees 0.3 m apart: their cores would need 0.26 m each
  const auto pipe = [](const char* id, const char* from, const char* to) {
    PipeSpec p;
    p.id = id;
    p.from = from;
    p.to = to;
    p.diameter_m = 0.15;
    p.wall_thickness_m = 0.007;
    return p;
  };
  const Network network({{"A", {-3, 0, 0}},
                         {"B", {0, 0, 0}},
                         {"C", {0.3, 0, 0}},
                         {"D", {3, 0, 0}},
                         {"E", {0, 3, 0}},
                         {"F", {0.3, 3, 0}}},
                        {pipe("AB", "A", "B"), pipe("BC", "B", "C"), pipe("CD", "C", "D"),
                         pipe("BE", "B", "E"), pipe("CF", "C", "F")});
  const Scene scene(network, {0.018, 0.014, 0.01, 0.004, 0.004});
  const Vector3d off(0, 0.01, 0.02);
  const Vector3d a = scene.At(1, Vector3d(0.15 - 1e-9, 0, 0) + off).velocity_W;
  const Vector3d b = scene.At(1, Vector3d(0.15 + 1e-9, 0, 0) + off).velocity_W;
  EXPECT_LT((a - b).norm(), 1e-6);
  EXPECT_NEAR(a.x(), 0.014 / network.pipe(1).area_m2(), 1e-6);
  for (const double x : {0.02, 0.1, 0.14, 0.16, 0.22, 0.29}) {
    ExpectConsistent(scene, 1, Vector3d(x, 0, 0) + off, 1, 1e-4);
  }
}

TEST(FlowField, AcceleratesWithChangingFlow) {
  const Network network =
      MakeStar({{-Vector3d::UnitX(), 0.15, 3}, {Vector3d::UnitX(), 0.15, 3}, {Vector3d::UnitY(), 0.15, 3}});
  const auto state = [](double in, double branch) {
    return FlowState{
        {{{0, 3, -in, 0, 0, 0.02}}, {{0, 3, in - branch, 0, 0, 0.02}}, {{0, 3, branch, 0, 0, 0.02}}}};
  };
  const double area = network.pipe(0).area_m2();
  const FlowTimeline timeline({area, area, area}, {TrueTime{}, TrueTime{FromSeconds(10)}},
                              {state(0.018, 0.007), state(-0.01, 0.002)}, {{1e-4, 1e-4, 1e-4}, 1e-6});
  const Bore bore(network);
  const FlowField field(bore, timeline, kWater, kGravity, 0.03);
  // by differences in time, in the tee, its fade, its profile zone; less the steady part
  for (const Vector3d& p :
       {Vector3d(-0.02, 0.01, 0.02), Vector3d(-0.2, 0.01, 0.02), Vector3d(-0.3, 0.01, 0.02)}) {
    const NetworkSpot spot = SpotIn(network, 0, p);
    const auto velocity = [&](double t, const Vector3d& at) {
      return field.Eval(SpotIn(network, 0, at), at, TrueTime{FromSeconds(t)}).velocity_W;
    };
    const Vector3d local = (velocity(5.001, p) - velocity(4.999, p)) / 0.002;
    const Matrix3d g = CalcSlope([&](const Vector3d& at) { return velocity(5, at); }, p);
    const WaterAtBall water = field.Eval(spot, p, TrueTime{FromSeconds(5)});
    EXPECT_LT((local + g * water.velocity_W - water.acceleration_W).norm(), 2e-3) << p.transpose();
    EXPECT_GT(local.norm(), 0.02);
  }
}

TEST(FlowField, AConeTowardsAPipeTooNarrowForTheBallHasFlowWhereItFits) {
  // 150 to 80 mm over 140 mm: the bore's radius falls by a quarter of the way; a ball of 78 mm fits to a bore
  // of 78/0.95 mm. It sees more than the mean speed, for it is in the middle, and no more than if all the
  // water went through its disc.
  std::vector<PipeSpec> pipes{testing::MakePipeSpec("P", "A", "M"),
                              testing::MakePipeSpec("Q", "M", "B", {.diameter_m = 0.08})};
  const Network network({{"A", {0, 0, 0}}, {"M", {2, 0, 0}}, {"B", {5, 0, 0}}}, pipes);
  const double flow_m3_s = 0.3 * network.pipe(0).area_m2(), ball_m = 0.039;
  const FlowState state{{{{0, 2, flow_m3_s, 50, 50, 0.02}}, {{0, 3, flow_m3_s, 50, 50, 0.02}}}};
  const FlowTimeline timeline({network.pipe(0).area_m2(), network.pipe(1).area_m2()}, {TrueTime{}}, {state});
  const Bore bore(network);
  const FlowField field(bore, timeline, kWater, kGravity, ball_m);
  double last = 0.3;
  for (const double s_m : {0.02, 0.06, 0.1, 4 * (0.075 - ball_m / 0.95) - 1e-9}) {
    const Vector3d p(2 + s_m, 0, 0);
    const double radius_m = 0.075 - s_m / 4, mean = flow_m3_s / (M_PI * radius_m * radius_m);
    const double speed = field.Eval(SpotIn(network, 1, p), p, {}).velocity_W.x();
    EXPECT_GT(speed, last) << s_m;
    EXPECT_GT(speed, mean) << s_m;
    EXPECT_LT(speed, mean * std::pow(radius_m / ball_m, 2)) << s_m;
    last = speed;
  }
}

}  // namespace
}  // namespace piperun::sim
