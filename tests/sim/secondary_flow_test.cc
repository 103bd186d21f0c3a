#include "sim/secondary_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/ball_world.h"
#include "sim/cross_flow.h"
#include "sim/flow_field.h"
#include "sim/fluid_load.h"
#include "tests/support/pipes.h"
#include "tests/support/star.h"

namespace piperun::sim {
namespace {

using testing::BoreNetwork;
using testing::MakePipeSpec;
using testing::SpotIn;

const WaterProperties kWater{20, 1000, 1e-6, 1482};
constexpr double kBend_m = 0.225, kDiameter_m = 0.15, kAmplitude = 0.15;

/// 3 m along x, a bend of 1.5 D to the left, 3 m along y. The bend runs from s = 2.775 to 3.1284.
Network MakeElbow() {
  return testing::MakeLineNetwork({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}}, {.bend_radius_m = kBend_m});
}
const Vector3d kBendCentre(3 - kBend_m, kBend_m, 0);
constexpr double kBendBegin_m = 3 - kBend_m, kBendEnd_m = kBendBegin_m + kBend_m * std::numbers::pi / 2;

NetworkSpot SpotAt(const Network& network, int pipe, double s_m) {
  const Pipe& p = network.pipe(pipe);
  return {pipe, p.FindPiece(s_m), s_m, p.Eval(s_m)};
}

CrossGrowth EvalAt(const SecondaryFlow& flow, const Network& network, double s_m, bool reversed = false,
                   int pipe = 0) {
  return flow.Eval(SpotAt(network, pipe, s_m), reversed);
}

TEST(SecondaryFlow, GrowsInTheBendAndFadesBehindIt) {
  const BoreNetwork elbow(MakeElbow());
  const SecondaryFlow flow(elbow.bore, kAmplitude);
  EXPECT_EQ(EvalAt(flow, elbow.network, 2).strength.cells_W.norm(), 0);
  const double x_m = 0.2, grown = kAmplitude * (1 - std::exp(-x_m / kDiameter_m));
  const Vector3d outward = (elbow.network.pipe(0).Eval(kBendBegin_m + x_m).p_W - kBendCentre).normalized();
  EXPECT_LT((EvalAt(flow, elbow.network, kBendBegin_m + x_m).strength.cells_W - grown * outward).norm(),
            1e-12);
  // after 90 degrees outward has turned to +x
  const double end = kAmplitude * (1 - std::exp(-(kBendEnd_m - kBendBegin_m) / kDiameter_m));
  const double behind = end * std::exp(-1.0 / (5 * kDiameter_m));
  EXPECT_LT(
      (EvalAt(flow, elbow.network, kBendEnd_m + 1).strength.cells_W - behind * Vector3d::UnitX()).norm(),
      1e-12);
  EXPECT_NEAR(EvalAt(flow, elbow.network, kBendEnd_m + 1).strength.swirl, behind / kAmplitude, 1e-12);
}

TEST(SecondaryFlow, IsBehindTheBendAlsoWhereTheWaterRunsBack) {
  const BoreNetwork elbow(MakeElbow());
  const SecondaryFlow flow(elbow.bore, kAmplitude);
  EXPECT_EQ(EvalAt(flow, elbow.network, kBendEnd_m + 1, true).strength.cells_W.norm(), 0);
  const double end = kAmplitude * (1 - std::exp(-(kBendEnd_m - kBendBegin_m) / kDiameter_m));
  const Vector3d expected = -end * std::exp(-1.0 / (5 * kDiameter_m)) * Vector3d::UnitY();
  EXPECT_LT((EvalAt(flow, elbow.network, kBendBegin_m - 1, true).strength.cells_W - expected).norm(), 1e-12);
}

TEST(SecondaryFlow, IsWeakerInGentleBends) {
  const auto behind = [](double bend_m) {
    const BoreNetwork line(
        testing::MakeLineNetwork({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}}, {.bend_radius_m = bend_m}));
    const SecondaryFlow flow(line.bore, kAmplitude);
    const double end_m = 9 - bend_m + bend_m * std::numbers::pi / 2;
    return EvalAt(flow, line.network, end_m).strength.cells_W.norm();
  };
  // 90 degrees of 3 m are 31 diameters: fully grown, 1.5 D/R_c = 0.075
  EXPECT_NEAR(behind(3) / kAmplitude, 0.075, 1e-9);
  EXPECT_LT(behind(0.2), kAmplitude);
}

TEST(SecondaryFlow, SlopesAreThoseOfDifferencesThroughASpaceBend) {
  const BoreNetwork line(
      testing::MakeLineNetwork({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}, {.bend_radius_m = 0.3}));
  const SecondaryFlow flow(line.bore, kAmplitude);
  const double length_m = line.network.pipe(0).length_m, step_m = 1e-6;
  int places = 0;
  for (const bool reversed : {false, true}) {
    for (double s = 0.05; s < length_m - 0.05; s += 0.0371) {
      const NetworkSpot a = SpotAt(line.network, 0, s - step_m), b = SpotAt(line.network, 0, s + step_m);
      if (a.piece != b.piece) continue;
      const CrossGrowth at = EvalAt(flow, line.network, s, reversed);
      const CrossStrength x = flow.Eval(a, reversed).strength, y = flow.Eval(b, reversed).strength;
      EXPECT_LT(((y.cells_W - x.cells_W) / (2 * step_m) - at.slope_1_m.cells_W).norm(), 1e-8) << s;
      EXPECT_NEAR((y.swirl - x.swirl) / (2 * step_m), at.slope_1_m.swirl, 1e-8) << s;
      EXPECT_NEAR(at.strength.cells_W.dot(SpotAt(line.network, 0, s).axis.tangent_W), 0, 1e-15);
      EXPECT_LT((y.cells_W - x.cells_W).norm(), 1e-5) << "continuous";
      ++places;
    }
  }
  EXPECT_GT(places, 80);
}

TEST(SecondaryFlow, GoesOnThroughSmoothJointsOnly) {
  // the elbow ends 1 m behind its bend, and another pipe goes on in line
  const auto make = [](const Vector3d& on) {
    return Network({{"A", {0, 0, 0}}, {"B", {3, 3, 0}}, {"C", Vector3d(3, 3, 0) + on}},
                   {MakePipeSpec("P", "A", "B", {.bend_radius_m = kBend_m}, {{3, 0, 0}}),
                    MakePipeSpec("Q", "C", "B", {.bend_radius_m = 0})});
  };
  const BoreNetwork straight(make({0, 3, 0})), corner(make({3, 0, 0}));
  const SecondaryFlow smooth(straight.bore, kAmplitude), sharp(corner.bore, kAmplitude);
  ASSERT_TRUE(straight.bore.joint(1).smooth);
  ASSERT_FALSE(corner.bore.joint(1).smooth);
  const double length_m = straight.network.pipe(0).length_m;
  const Vector3d end = EvalAt(smooth, straight.network, length_m).strength.cells_W;
  EXPECT_GT(end.norm(), 1e-3);
  // Q is drawn against the water: its `to` is where the water comes in
  const Vector3d on = EvalAt(smooth, straight.network, 3 - 0.75, true, 1).strength.cells_W;
  EXPECT_LT((on - std::exp(-1.0) * end).norm(), 1e-12);
  EXPECT_EQ(EvalAt(sharp, corner.network, 2, true, 1).strength.cells_W.norm(), 0);
}

TEST(SecondaryFlow, EndsInARingOfSmoothPipes) {
  // a ring of two half circles, drawn as squares with rounded corners, both ends smooth
  const Network ring(
      {{"A", {0, 0, 0}}, {"B", {2, 2, 0}}},
      {MakePipeSpec("P", "A", "B", {.bend_radius_m = 0.5}, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}}),
       MakePipeSpec("Q", "B", "A", {.bend_radius_m = 0.5}, {{2, 3, 0}, {-1, 3, 0}, {-1, 0, 0}})});
  const Bore bore(ring);
  ASSERT_TRUE(bore.joint(0).smooth && bore.joint(1).smooth);
  const SecondaryFlow flow(bore, kAmplitude);
  EXPECT_TRUE(EvalAt(flow, ring, 0.5).strength.cells_W.allFinite());
}

/// Flow at a point by the textbook form of the two cells: core along +y of the pipe along x.
Vector3d CalcCellsByHand(double y, double z, double w, double radius) {
  // psi = w z (1 - r^2/R^2), u_y = dpsi/dz, u_z = -dpsi/dy
  const double r2 = (y * y + z * z) / (radius * radius);
  return {0, w * (1 - r2) - 2 * w * z * z / (radius * radius), 2 * w * y * z / (radius * radius)};
}

TEST(CrossFlow, CellsAreTangentToTheWallAndReturnAlongIt) {
  CrossPlace place;
  place.radius_m = 0.075;
  CrossSpeed speed;
  speed.cells_W_m_s = {0, 0.15, 0};
  speed.swirl_m_s = 0.1;
  for (double angle = 0.1; angle < 6.2; angle += 0.3) {
    place.offset_W = 0.075 * Vector3d(0, std::cos(angle), std::sin(angle));
    EXPECT_NEAR(CalcCrossFlow(place, speed).velocity_W.dot(place.offset_W), 0, 1e-16);
  }
  speed.swirl_m_s = 0;
  place.offset_W = {0, 0.02, -0.03};
  EXPECT_LT((CalcCrossFlow(place, speed).velocity_W - CalcCellsByHand(0.02, -0.03, 0.15, 0.075)).norm(),
            1e-16);
  place.offset_W = {0, 0, 0.075};
  EXPECT_NEAR(CalcCrossFlow(place, speed).velocity_W.y(), -0.3, 1e-15)
      << "back along the wall, twice as fast";
}

TEST(CrossFlow, OfABallIsTheMeanOverItsDisc) {
  CrossPlace place;
  place.radius_m = 0.075;
  place.offset_W = {0, 0.015, -0.02};
  CrossSpeed speed;
  speed.cells_W_m_s = {0, 0.12, 0.05};
  speed.swirl_m_s = 0.08;
  Vector3d mean = Vector3d::Zero();
  constexpr int kRings = 400, kAngles = 16;  // equal areas, angles exact for a cubic
  for (int i = 0; i < kRings; ++i) {
    const double r = 0.03 * std::sqrt((i + 0.5) / kRings);
    for (int j = 0; j < kAngles; ++j) {
      const double angle = 2 * std::numbers::pi * j / kAngles;
      CrossPlace at = place;
      at.offset_W += r * Vector3d(0, std::cos(angle), std::sin(angle));
      mean += CalcCrossFlow(at, speed).velocity_W / (kRings * kAngles);
    }
  }
  place.ball_radius_m = 0.03;
  EXPECT_LT((CalcCrossFlow(place, speed).velocity_W - mean).norm(), 1e-9);
}

/// A network with one flow through pipe 0, and a ball's view of it.
struct Scene {
  Scene(Network n, double flow_m3_s, double ball_radius_m, const StreamParams& stream = {})
      : network(std::move(n)),
        bore(network),
        timeline({network.pipe(0).area_m2()}, {TrueTime{}},
                 {FlowState{{{{0, network.pipe(0).length_m, flow_m3_s, 0, 0, 0.02}}}}}),
        field(bore, timeline, kWater, 9.81, ball_radius_m, stream) {}
  WaterAtBall At(const Vector3d& p, const Swirl& swirl = {}) const {
    return field.Eval(SpotIn(network, 0, p), p, {}, swirl);
  }

  Network network;
  Bore bore;
  FlowTimeline timeline;
  FlowField field;
};

struct Difference {
  Matrix3d gradient;
  Vector3d Curl() const {
    return {gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0),
            gradient(1, 0) - gradient(0, 1)};
  }
};

Difference CalcDifference(const Scene& scene, const Vector3d& p, const Swirl& swirl) {
  constexpr double kStep = 2e-6;
  Difference result;
  for (int j = 0; j < 3; ++j) {
    const Vector3d d = kStep * Vector3d::Unit(j);
    result.gradient.col(j) =
        (scene.At(p + d, swirl).velocity_W - scene.At(p - d, swirl).velocity_W) / (2 * kStep);
  }
  return result;
}

/// What the cells and the swirl add, against differences: the main flow, whose tabulated gradient is not the
/// slope of its own table, is taken off.
void ExpectExact(const Network& network, double flow_m3_s, const Vector3d& p, const Swirl& swirl) {
  StreamParams plain, all;
  plain.secondary_flow = false;
  all.swirl_switching = true;
  const Scene with(network, flow_m3_s, 0.03, all), without(network, flow_m3_s, 0.03, plain);
  const WaterAtBall a = with.At(p, swirl), b = without.At(p);
  const Difference da = CalcDifference(with, p, swirl), db = CalcDifference(without, p, {});
  ASSERT_GT((a.velocity_W - b.velocity_W).norm(), 1e-3) << p.transpose();
  EXPECT_NEAR(da.gradient.trace(), 0, 2e-5) << p.transpose();
  EXPECT_LT((da.Curl() - db.Curl() - 2 * (a.spin_W - b.spin_W)).norm(), 2e-6) << p.transpose();
  const Vector3d change = da.gradient * a.velocity_W - db.gradient * b.velocity_W;
  const Vector3d switching = swirl.s == 0
                                 ? Vector3d(Vector3d::Zero())
                                 : Vector3d(swirl.ds_dt_1_s * (with.At(p, {swirl.s + 1, 0}).velocity_W -
                                                               with.At(p, {swirl.s, 0}).velocity_W));
  // u2 . grad u1 takes the tabulated gradient, 5e-3 of U/R at most off the slope of the table; |u2| < 0.3 U
  EXPECT_LT((change + switching - (a.acceleration_W - b.acceleration_W)).norm(), 0.3 * 5e-3 / 0.075)
      << p.transpose();
}

TEST(CrossFlow, IsDivergenceFreeWithItsCurlAndAcceleration) {
  const Network elbow = MakeElbow();
  const Vector3d in_bend = kBendCentre + 0.25 * Vector3d(1, -1, 0).normalized() + Vector3d(0, 0, 0.02);
  for (const double flow : {0.018, -0.018}) {
    for (const Swirl& swirl : {Swirl{}, Swirl{0.8, 3}}) {
      ExpectExact(elbow, flow, in_bend, swirl);
      ExpectExact(elbow, flow, kBendCentre + Vector3d(0.19, -0.02, -0.015), swirl);
      if (flow > 0) ExpectExact(elbow, flow, {3.02, 0.6, -0.03}, swirl);
      if (flow < 0) ExpectExact(elbow, flow, {2.5, -0.02, 0.01}, swirl);
    }
  }
}

TEST(CrossFlow, IsDivergenceFreeInAConeBehindABend) {
  Network elbow = MakeElbow();
  const double length_m = elbow.pipe(0).length_m;
  const_cast<Pipe&>(elbow.pipe(0)).cone_to = {length_m - kBendEnd_m - 0.1,
                                              0.1};  // a network of the test's own
  StreamParams plain, all;
  plain.secondary_flow = false;
  const Scene with(elbow, 0.018, 0.03, all), without(elbow, 0.018, 0.03, plain);
  const Vector3d p(3.015, 0.45, -0.03);
  EXPECT_GT((with.At(p).velocity_W - without.At(p).velocity_W).norm(), 0.02);
  const Difference a = CalcDifference(with, p, {}), b = CalcDifference(without, p, {});
  EXPECT_NEAR(a.gradient.trace(), 0, 2e-5);
  EXPECT_LT((a.Curl() - b.Curl() - 2 * (with.At(p).spin_W - without.At(p).spin_W)).norm(), 2e-6);
}

TEST(CrossFlow, MovesTheCoreOutwards) {
  const Scene scene(MakeElbow(), 0.018, 0.03);
  const Vector3d outward = Vector3d(1, -1, 0).normalized();
  const WaterAtBall middle = scene.At(kBendCentre + kBend_m * outward);
  const double bulk = 0.018 / scene.network.pipe(0).area_m2();
  // 45 degrees in, 0.1767 m: A (1 - e^-1.178) (1 - 0.4^2)
  EXPECT_NEAR(middle.velocity_W.dot(outward) / bulk, 0.15 * (1 - std::exp(-0.17671 / 0.15)) * 0.84, 1e-5);
}

TEST(CrossFlow, FadesBeforeAJointAndIsNotInItsCore) {
  // the elbow runs into a tee
  const Network network({{"A", {0, 0, 0}}, {"T", {3, 2, 0}}, {"B", {3, 5, 0}}, {"C", {6, 2, 0}}},
                        {MakePipeSpec("P", "A", "T", {.bend_radius_m = kBend_m}, {{3, 0, 0}}),
                         MakePipeSpec("Q", "T", "B"), MakePipeSpec("R", "T", "C")});
  const Bore bore(network);
  const double area = network.pipe(0).area_m2();
  const FlowTimeline timeline({area, area, area}, {TrueTime{}},
                              {FlowState{{{{0, network.pipe(0).length_m, 0.018, 0, 0, 0.02}},
                                          {{0, 3, 0.01, 0, 0, 0.02}},
                                          {{0, 3, 0.008, 0, 0, 0.02}}}}});
  StreamParams plain;
  plain.secondary_flow = false;
  const FlowField with(bore, timeline, kWater, 9.81, 0.03),
      without(bore, timeline, kWater, 9.81, 0.03, plain);
  const auto cross = [&](double y) {
    const Vector3d p(3.01, y, 0.02);
    return (with.Eval(SpotIn(network, 0, p), p, {}).velocity_W -
            without.Eval(SpotIn(network, 0, p), p, {}).velocity_W)
        .norm();
  };
  const double core_m = 0.075 + 2.5 * 0.075;
  EXPECT_EQ(cross(2 - core_m + 0.01), 0);
  EXPECT_LT(cross(2 - core_m - 1e-4), 1e-6);
  EXPECT_GT(cross(2 - core_m - 0.3), 1e-3);
}

/// Water that turns about the axis of a pipe and moves on: u = Omega e_x x r + U e_x.
struct Vortex {
  double spin_1_s, speed_m_s;
  WaterAtBall At(const Vector3d& p) const {
    const Vector3d omega = spin_1_s * Vector3d::UnitX(), r(0, p.y(), p.z());
    WaterAtBall water;
    water.velocity_W = omega.cross(r) + speed_m_s * Vector3d::UnitX();
    water.acceleration_W = -spin_1_s * spin_1_s * r;
    water.spin_W = omega;
    water.bore_radius_m = 0.075;
    return water;
  }
};

TEST(SecondaryFlow, ABallLikeWaterStaysOnItsStreamlineInAVortex) {
  const Network network = testing::MakeLineNetwork({{0, 0, 0}, {20, 0, 0}});
  const Bore bore(network);
  BallParams ball;
  ball.radius_m = 0.01;
  ball.density_kg_m3 = kWater.density_kg_m3;
  const ForceParams far_from_walls{.rolling_drag = false, .lift = false, .magnus = false};
  const std::vector<double> bores{network.pipe(0).radius_m()};
  const FluidLoadCoefficients c =
      CalcFluidLoadCoefficients(ball, far_from_walls, kWater, {0, 0, -9.81}, bores);
  const Vortex vortex{6, 0.8};
  const auto load = [&](const BallInstant& at) -> BallLoad {
    const FluidLoad f = CalcFluidLoad(c, at.v_WB_W, at.w_WB_W, vortex.At(at.p_LB));
    return {f.Force_W_N(), f.spin_torque_W_N_m};
  };
  const Vector3d p(2, 0.03, 0);
  const double mass = ball.mass_kg() + c.added_mass_kg;
  const BallStart start{
      {p, Quaterniond::Identity()}, vortex.At(p).velocity_W, vortex.At(p).spin_W, SpotIn(network, 0, p)};
  BallWorld world(bore, {0.01, mass, 0.4 * ball.mass_kg() * 1e-4, 0.4, 0}, Rate(4000), start, load);
  constexpr int kTurns = 5;
  const auto steps = static_cast<int>(std::lround(kTurns * 2 * std::numbers::pi / 6 * 4000));
  double worst = 0;
  for (int i = 0; i < steps; ++i) {
    world.Step();
    worst = std::max(worst, std::abs(world.state().X_LB.p.tail<2>().norm() - 0.03));
  }
  EXPECT_LT(worst / kTurns, 1e-6);
  EXPECT_NEAR(world.state().X_LB.p.x(), 2 + 0.8 * steps / 4000.0, 1e-9);
}

/// A ball of 1 cm and of the density of the water, released with it, and the water's own way.
double FollowStreamline(const Vector3d& release, double duration_s) {
  // laminar (nu raised: Re = 1500), so that the profile's gradient is exact, and so must be Du/Dt
  const WaterProperties syrup{20, 1000, 1e-4, 1482};
  const Network network = MakeElbow();
  const Bore bore(network);
  const double area_m2 = network.pipe(0).area_m2();
  const FlowTimeline timeline({area_m2}, {TrueTime{}},
                              {FlowState{{{{0, network.pipe(0).length_m, area_m2, 0, 0, 0.04}}}}});
  const FlowField field(bore, timeline, syrup, 9.81, 0.005);
  BallParams ball;
  ball.radius_m = 0.005;
  ball.density_kg_m3 = 1000;
  const ForceParams far_from_walls{.rolling_drag = false, .lift = false, .magnus = false};
  const std::vector<double> bores{network.pipe(0).radius_m()};
  const FluidLoadCoefficients c =
      CalcFluidLoadCoefficients(ball, far_from_walls, syrup, {0, 0, -9.81}, bores);
  const auto load = [&](const BallInstant& at) -> BallLoad {
    const FluidLoad f = CalcFluidLoad(c, at.v_WB_W, at.w_WB_W, field.Eval(at.spot, at.p_LB, at.time));
    return {f.Force_W_N() - f.pressure_fall_W_N, f.spin_torque_W_N_m};
  };
  const auto velocity = [&](const Vector3d& p) {
    return field.Eval(SpotIn(network, 0, p), p, {}).velocity_W;
  };
  const double inertia = 0.4 * ball.mass_kg() * 2.5e-5, dt = 1.0 / 8000;
  const BallStart start{
      {release, Quaterniond::Identity()}, velocity(release), Vector3d::Zero(), SpotIn(network, 0, release)};
  BallWorld world(bore, {0.005, ball.mass_kg() + c.added_mass_kg, inertia, 0, 0}, Rate(8000), start, load);
  Vector3d water = release;
  double worst_m = 0;
  for (int i = 0; i < duration_s / dt; ++i) {
    world.Step();
    const Vector3d k1 = velocity(water), k2 = velocity(water + dt / 2 * k1);
    const Vector3d k3 = velocity(water + dt / 2 * k2), k4 = velocity(water + dt * k3);
    water += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    worst_m = std::max(worst_m, (world.state().X_LB.p - water).norm());
  }
  EXPECT_GT((water - release).norm(), 0.15) << "some way";
  return worst_m;
}

TEST(SecondaryFlow, ABallLikeWaterStaysOnItsStreamlineInTheBendAndBehindIt) {
  // not across the bend's beginning, where the mean flow becomes a free vortex at once
  const Vector3d in_bend = kBendCentre + kBend_m * Vector3d(0.1, -std::sqrt(0.99), 0);
  EXPECT_LT(FollowStreamline(in_bend + Vector3d(0, 0.01, 0.02), 0.1), 1e-6);
  EXPECT_LT(FollowStreamline({3.02, 0.25, -0.02}, 0.5), 1e-6);
}

}  // namespace
}  // namespace piperun::sim
