// The ball at wall features, held against geometry and rigid-body mechanics by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/ball_world.h"
#include "tests/support/features.h"

namespace piperun::sim {
namespace {

using testing::AddFeatures;
using testing::BoreNetwork;
using testing::FindSpot;
using testing::MakeBoreLine;

constexpr double kRadius = 0.03, kBore = 0.075, kRun = kBore - kRadius;
constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
constexpr double kMass = 1100 * kVolume, kInertial = kMass + 500 * kVolume;
constexpr double kInertia = 0.4 * kMass * kRadius * kRadius;
constexpr double kShare = kInertia / (kInertial * kRadius * kRadius);  // k = I / (M r^2)
constexpr double kWeight = (kMass - 1000 * kVolume) * 9.80665;

TubeBall Ball(double friction, double rolling_length_m = 0) {
  return {kRadius, kInertial, kInertia, friction, rolling_length_m};
}

BallLoad Weight(const BallInstant&) { return {{0, 0, -kWeight}, Vector3d::Zero()}; }

BallStart At(const Network& network, const Vector3d& p_W, const Vector3d& v_W = Vector3d::Zero()) {
  return {
      {p_W, Quaterniond::Identity()}, v_W, Vector3d::UnitZ().cross(v_W) / kRadius, FindSpot(network, 0, p_W)};
}

/// Two metres of pipe along x.
BoreNetwork Straight() { return MakeBoreLine({{0, 0, 0}, {2, 0, 0}}); }

/// A round bead at x = 1: height h, and as wide as makes its tube radius a.
void AddBead(BoreNetwork& line, double h, double a) {
  AddFeatures(line.bore, "weld_bead",
              {{"s_m", 1.0}, {"height_m", h}, {"width_m", 2 * std::sqrt(h * (2 * a - h))}});
}

TEST(BallAtFeature, DipsIntoAGapAsDeepAsItsRimsLetIt) {
  // resting on two rounded edges: (r + a)^2 = (w/2 + a)^2 + (height of its centre above the edges' centres)^2
  const double w = 0.016, a = 0.001;
  BoreNetwork line = Straight();
  AddFeatures(line.bore, "joint", {{"s_m", 1.0}, {"gap_m", w}, {"depth_m", 0.01}, {"edge_radius_m", a}});
  BallWorld world(line.bore, Ball(0.5, 0.01 * kRadius), Rate(1000), At(line.network, {1.001, 0, -kRun}),
                  Weight);
  for (int i = 0; i < 5000; ++i) world.Step();
  const double dip = kRadius + a - std::sqrt((kRadius + a) * (kRadius + a) - (w / 2 + a) * (w / 2 + a));
  EXPECT_GT(dip, 1e-3);
  EXPECT_NEAR(-world.state().X_LB.p.z() - kRun, dip, 1e-9);
  EXPECT_NEAR(world.state().X_LB.p.x(), 1, 1e-6);
  EXPECT_NEAR(world.state().v_WB_W.norm(), 0, 1e-7);
}

TEST(BallAtFeature, AShallowGapsFloorCarriesIt) {
  const double w = 0.016, depth = 0.0005;  // the dip would be 1.1 mm
  BoreNetwork line = Straight();
  AddFeatures(line.bore, "joint", {{"s_m", 1.0}, {"gap_m", w}, {"depth_m", depth}, {"edge_radius_m", 0.0}});
  BallWorld world(line.bore, Ball(0.5, 0.01 * kRadius), Rate(1000), At(line.network, {1.001, 0, -kRun}),
                  Weight);
  for (int i = 0; i < 5000; ++i) world.Step();
  EXPECT_NEAR(-world.state().X_LB.p.z() - kRun, depth, 1e-9);
  EXPECT_NEAR(world.state().normal_force_N, kWeight, 1e-6);
}

TEST(BallAtFeature, SitsInAServiceHoleOnTheEdgesAcrossThePipe) {
  // The hole's edge is lowest along the pipe, but stands higher across it, where the wall curves up: at (0,
  // c, -sqrt(R^2 - c^2)), c the hole's radius. The sphere around (0, 0, -z) touches it there:
  //   (sqrt(R^2 - c^2) - z)^2 + c^2 = r^2,   dip about c^2/2 (1/r - 1/R)
  const double c = 0.012;
  BoreNetwork line = Straight();
  AddFeatures(line.bore, "service_hole",
              {{"s_m", 1.0}, {"diameter_m", 2 * c}, {"clock_rad", std::numbers::pi}});
  // damped, not braked: rolling resistance would hold it a little off the middle
  BallWorld world(line.bore, Ball(0.5), Rate(1000), At(line.network, {1.002, 0, -kRun}),
                  [](const BallInstant& ball) {
                    return BallLoad{Vector3d(0, 0, -kWeight) - 0.5 * ball.v_WB_W, Vector3d::Zero()};
                  });
  for (int i = 0; i < 8000; ++i) world.Step();
  const double z = std::sqrt(kBore * kBore - c * c) - std::sqrt(kRadius * kRadius - c * c);
  EXPECT_NEAR(-world.state().X_LB.p.z(), z, 1e-9);
  EXPECT_NEAR((z - kRun) / (c * c / 2 * (1 / kRadius - 1 / kBore)), 1, 0.1);
}

TEST(BallAtFeature, IsLiftedOverABeadByItsHeight) {
  const double h = 0.003;
  BoreNetwork line = Straight();
  AddBead(line, h, 0.004);
  // held to a crawl, so that it does not take off
  BallWorld world(line.bore, Ball(0.9), Rate(1000), At(line.network, {0.97, 0, -kRun}),
                  [](const BallInstant& ball) {
                    return BallLoad{Vector3d(50 * (0.02 - ball.v_WB_W.x()), 0, -kWeight), Vector3d::Zero()};
                  });
  double highest = -1;
  while (world.state().X_LB.p.x() < 1.06 && Seconds(world.state().time) < 20) {
    world.Step();
    highest = std::max(highest, world.state().X_LB.p.z());
  }
  ASSERT_GT(world.state().X_LB.p.x(), 1.05);
  // over the crest it comes within v dt/2 = 10 um of the top of a circle of radius r + a
  EXPECT_NEAR(highest + kRun, h, 0.5 * 1e-5 * 1e-5 / 0.034 + 1e-8);
}

/// Whether a ball that rolls at `speed` gets over a bead.
bool Passes(double speed, double h, double a, double rate_Hz) {
  BoreNetwork line = Straight();
  AddBead(line, h, a);
  BallWorld world(line.bore, Ball(2), Rate(rate_Hz), At(line.network, {0.96, 0, -kRun}, {speed, 0, 0}),
                  Weight);
  while (world.state().X_LB.p.x() < 1.01 && world.state().v_WB_W.x() > -0.1 * speed &&
         Seconds(world.state().time) < 5) {
    world.Step();
  }
  return world.state().X_LB.p.x() > 1.005;
}

TEST(BallAtFeature, GetsOverABeadAboveTheSpeedThatTheImpactLeavesEnoughOf) {
  // Rolling on, it meets the bead where the line of centres leans by beta, cos beta = 1 - h/(r + a). Angular
  // momentum about that point is kept, and then it rolls about it (inelastic, no slip):
  //   M v r cos(beta) + I v/r = (M r^2 + I) v'/r   ->   v'/v = (cos beta + k)/(1 + k),   k = I/(M r^2)
  // and gets to the top, h higher, when (M + I/r^2) v'^2/2 >= W h. M holds the added mass, W is the weight in
  // water.
  const double h = 0.002, a = 0.004;
  const double kept = (1 - h / (kRadius + a) + kShare) / (1 + kShare);
  const double threshold = std::sqrt(2 * kWeight * h / (kInertial * (1 + kShare))) / kept;
  EXPECT_TRUE(Passes(1.002 * threshold, h, a, 10000));
  EXPECT_FALSE(Passes(0.998 * threshold, h, a, 10000));
  // at the usual step, the impact takes place up to v dt early or late
  EXPECT_TRUE(Passes(1.02 * threshold, h, a, 1000));
  EXPECT_FALSE(Passes(0.98 * threshold, h, a, 1000));
}

/// Velocity change of a ball by the impact on a bead: what the IMU sees.
Vector3d Knock(double rate_Hz) {
  BoreNetwork line = Straight();
  AddBead(line, 0.002, 0.004);
  BallWorld world(line.bore, Ball(2), Rate(rate_Hz), At(line.network, {0.96, 0, -kRun}, {0.8, 0, 0}),
                  [](const BallInstant&) { return BallLoad{}; });
  while (world.state().X_LB.p.x() < 0.995) world.Step();
  return world.state().v_WB_W - Vector3d(0.8, 0, 0);
}

TEST(BallAtFeature, TheImpulseOfAnImpactConvergesWithTheStep) {
  // without weight it flies off along the tangent of the bead, at v' of the impact
  const double beta = std::acos(1 - 0.002 / (kRadius + 0.004));
  const double v = 0.8 * (std::cos(beta) + kShare) / (1 + kShare);
  const Vector3d exact = v * Vector3d(std::cos(beta), 0, std::sin(beta)) - Vector3d(0.8, 0, 0);
  const double coarse = (Knock(1000) - exact).norm(), fine = (Knock(16000) - exact).norm();
  EXPECT_LT(coarse / exact.norm(), 0.1);
  EXPECT_LT(fine / exact.norm(), 0.1 / 8);
}

/// A ball dragged along by water of 1 m/s.
BallLoad Carry(const BallInstant& ball) {
  const Vector3d slip = ball.spot.axis.tangent_W - ball.v_WB_W;
  return {0.6 * slip.norm() * slip - Vector3d(0, 0, kWeight), -1e-5 * ball.w_WB_W};
}

TEST(BallAtFeature, AGateTooLowForItStopsIt) {
  for (const double opening : {0.058, 0.045, 0.02, 0.062}) {
    BoreNetwork line = Straight();
    AddFeatures(line.bore, "gate_valve", {{"s_m", 1.0}, {"opening_m", opening}});
    BallWorld world(line.bore, Ball(0.4, 3e-4), Rate(1000), At(line.network, {0.6, 0.01, -0.04}, {0.5, 0, 0}),
                    Carry);
    for (int i = 0; i < 20000 && world.state().X_LB.p.x() < 1.2; ++i) world.Step();
    // the gate's straight edge leaves a ball of 60 mm on the invert the height `opening`
    EXPECT_EQ(world.state().X_LB.p.x() > 1.1, opening > 0.06) << opening;
    if (opening < 0.06) {
      EXPECT_LT(world.state().v_WB_W.norm(), 1e-6) << opening;
    }
    EXPECT_EQ(world.state().rescues, 0);
  }
}

TEST(BallAtFeature, PositionAndVelocityAgreeOverEveryKindOfFeature) {
  BoreNetwork line = MakeBoreLine({{0, 0, 0}, {10, 0, 0}, {10, 8, 0}}, {.bend_radius_m = 0.4});
  AddFeatures(line.bore, "joint",
              {{"spacing_m", 1.3}, {"gap_m", 0.006}, {"gap_sd_m", 0.002}, {"offset_m", 0.001}});
  AddFeatures(line.bore, "weld_bead", {{"spacing_m", 0.9}, {"height_m", 0.001}});
  AddFeatures(line.bore, "service_hole", {{"spacing_m", 0.7}, {"clock_sd_rad", 2.0}});
  AddFeatures(line.bore, "scale",
              {{"s_m", 6.0}, {"length_m", 2.0}, {"height_m", 0.001}, {"height_sd_m", 0.0005}});
  AddFeatures(line.bore, "gate_valve", {{"s_m", 14.0}, {"opening_m", 0.1}});
  BallWorld world(line.bore, Ball(0.4, 3e-4), Rate(1000), At(line.network, {0.2, 0.01, -0.04}, {0.5, 0, 0}),
                  Carry);
  // strapdown: twice the acceleration, by leapfrog, gives the position
  Vector3d p = world.state().X_LB.p, v = world.state().v_WB_W + 0.5e-3 * world.state().a_WB_W;
  double deepest = 0;
  while (world.state().spot.s_m < 17 && Seconds(world.state().time) < 60) {
    world.Step();
    p += 1e-3 * v;
    v += 1e-3 * world.state().a_WB_W;
    deepest = std::max(deepest, (world.state().X_LB.p - world.state().spot.axis.p_W).norm() - kRun);
  }
  EXPECT_GE(world.state().spot.s_m, 17);
  EXPECT_LT((p - world.state().X_LB.p).norm(), 1e-6);
  EXPECT_LT(deepest, 0.003) << "gaps of 12 mm and holes of 20 mm let it in by less";
  EXPECT_EQ(world.state().rescues, 0);
}

/// One of any kind between 0.5 and 3 m; it may lie over others.
void AddAnyOne(BoreNetwork& line, std::uint64_t seed, const std::array<double, 4>& u) {
  const double s = 1 + 2 * u[0], x = u[2], y = u[3];
  switch (static_cast<int>(5 * u[1])) {
    case 0:
      return AddFeatures(line.bore, "weld_bead",
                         {{"s_m", s}, {"height_m", 1e-3 + 0.02 * x}, {"width_m", 0.002 + 0.01 * y}});
    case 1:
      return AddFeatures(line.bore, "gate_valve",
                         {{"s_m", s}, {"opening_m", 0.02 + 0.12 * x}, {"clock_rad", 6 * y}});
    case 2:
      return AddFeatures(line.bore, "scale",
                         {{"s_m", s}, {"length_m", 0.3}, {"cover", 0.5 * x}, {"height_m", 0.003 + 0.01 * y}},
                         kRadius, seed);
    case 3:
      return AddFeatures(line.bore, "service_hole",
                         {{"s_m", 0.5 * s}, {"diameter_m", 0.002 + 0.055 * x}, {"clock_rad", 6 * y}});
    default:
      return AddFeatures(line.bore, "joint", {{"s_m", 0.5 * s}, {"gap_m", 0.055 * x}, {"offset_m", 0.02 * y}},
                         kRadius, seed);
  }
}

/// Five random features of random sizes on 4.5 m of pipe with a bend, and a ball thrown in.
void ExpectNoEscape(std::uint64_t seed) {
  BoreNetwork line = MakeBoreLine({{0, 0, 0}, {2.4, 0, 0}, {2.4, 2.4, 0.3}}, {.bend_radius_m = 0.4});
  for (std::uint64_t i = 0; i < 5; ++i) AddAnyOne(line, seed, RandomStream(seed, "any", 0).Uniforms(i, 0));
  const auto u = RandomStream(seed, "start", 0).Uniforms(0, 0);
  const Vector3d at(0.2, 0.04 * (u[0] - 0.5), -0.04 * u[1]), v(3 * u[2], u[3] - 0.5, 0);
  BallWorld world(line.bore, Ball(0.4, 3e-4), Rate(1000), At(line.network, at, v), Carry);
  for (int i = 0; i < 5000 && world.state().spot.s_m < 4; ++i) {
    world.Step();
    const Vector3d offset = world.state().X_LB.p - world.state().spot.axis.p_W;
    ASSERT_TRUE(world.state().a_WB_W.allFinite()) << seed;
    ASSERT_LT(offset.norm(), kBore) << seed;
    ASSERT_LT(world.state().v_WB_W.norm(), 4) << seed;
  }
  EXPECT_EQ(world.state().rescues, 0) << seed;
}

TEST(BallAtFeature, NeverEscapesFromRandomFeatures) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) ExpectNoEscape(seed);
}

TEST(BallAtFeature, NeverEscapesFromTwoThousandRandomFeaturesSlow) {
  for (std::uint64_t seed = 40; seed < 440; ++seed) ExpectNoEscape(seed);
}

}  // namespace
}  // namespace piperun::sim
