#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "sim/ball_world.h"
#include "sim/bore_wall.h"
#include "tests/support/pipes.h"
#include "tests/support/union_of_bores.h"

namespace piperun::sim {
namespace {

using testing::BoreNetwork;
using testing::FindSpot;
using testing::MakePipeSpec;
using testing::MakeStar;
using testing::StarArm;
using testing::UnionOfBores;

// The reference ball of ball_world_test.cc.
constexpr double kRadius = 0.03, kBore = 0.075, kRun = kBore - kRadius;
constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
constexpr double kMass = 1100 * kVolume, kInertial = kMass + 500 * kVolume;
constexpr double kInertia = 0.4 * kMass * kRadius * kRadius;
constexpr double kRotary = kInertia / (kRadius * kRadius);
constexpr double kGravity = 9.80665;
constexpr double kWeight = (kMass - 1000 * kVolume) * kGravity;  // in water

TubeBall Ball(double friction = 0.5) { return {kRadius, kInertial, kInertia, friction, 0}; }

BallStart At(const Network& network, int pipe, const Vector3d& p_L, const Vector3d& v_W = Vector3d::Zero(),
             const Vector3d& w_W = Vector3d::Zero()) {
  return {{p_L, Quaterniond::Identity()}, v_W, w_W, FindSpot(network, pipe, p_L)};
}

/// Rolling along the invert.
BallStart Rolling(const Network& network, int pipe, const Vector3d& p_L, const Vector3d& v_W) {
  return At(network, pipe, p_L, v_W, Vector3d::UnitZ().cross(v_W) / kRadius);
}

BallLoad Weight(const BallInstant&) { return {{0, 0, -kWeight}, Vector3d::Zero()}; }

/// A main along x through the origin, pipe 0 towards +x, pipe 1 towards -x, and a branch, pipe 2.
std::vector<StarArm> Tee(const Vector3d& branch, double branch_radius_m) {
  return {{{3, 0, 0}, kBore}, {{-3, 0, 0}, kBore}, {3 * branch, branch_radius_m}};
}

TEST(BallAtJunction, RestsOnTheRimOfAnOpeningSmallerThanItself) {
  // the rim over a branch that leads down is highest beside the ball, at (0, +-b, -sqrt(R^2 - b^2)): the ball
  // touches there, sqrt(r^2 - b^2) above
  const double b = 0.02, above = std::sqrt(kRadius * kRadius - b * b);
  const BoreNetwork tee(MakeStar(Vector3d::Zero(), Tee({0, 0, -1}, b)));
  BallWorld world(tee.bore, Ball(0), Rate(1000), At(tee.network, 0, {0.01, 0.01, -0.04}),
                  [](const BallInstant& ball) {
                    return BallLoad{-1.0 * ball.v_WB_W - Vector3d(0, 0, kWeight), Vector3d::Zero()};
                  });
  for (int i = 0; i < 20000; ++i) world.Step();
  const double z = above - std::sqrt(kBore * kBore - b * b);
  EXPECT_NEAR((world.state().X_LB.p - Vector3d(0, 0, z)).norm(), 0, 1e-6);
  EXPECT_LT(world.state().v_WB_W.norm(), 1e-6);
  EXPECT_NEAR(world.state().normal_force_N, kWeight * kRadius / above, 1e-6);  // 2 N cos = W
  EXPECT_EQ(world.state().rescues, 0);
}

/// Speed after an inelastic impact that turns the path by an angle: the angular momentum about the new
/// contact stays, v' = v (M cos + I/r^2)/(M + I/r^2). So it does when the ball lands again from such a path.
double CalcSpeedAfterTurn(double v, double cosine) {
  return v * (kInertial * cosine + kRotary) / (kInertial + kRotary);
}

TEST(BallAtJunction, RollsOverAnOpeningAndLosesNoMoreThanTwoImpacts) {
  // in flight for at most 2b/v it falls delta and meets the far rim at an angle, 1 - cos = delta/r; the rim
  // throws it up at that angle, and it lands
  const double b = 0.02, v = 1, fall = 0.5 * kWeight / kInertial * (2 * b / v) * (2 * b / v);
  const double cosine = 1 - fall / kRadius;
  const double least = CalcSpeedAfterTurn(CalcSpeedAfterTurn(v, cosine), cosine);
  const BoreNetwork tee(MakeStar(Vector3d::Zero(), Tee({0, 0, -1}, b)));
  BallWorld world(tee.bore, Ball(), Rate(1000), Rolling(tee.network, 1, {-0.3, 0, -kRun}, {v, 0, 0}), Weight);
  double lowest = 0;
  while (world.state().X_LB.p.x() < 2 && Seconds(world.state().time) < 3) {
    world.Step();
    lowest = std::min(lowest, world.state().X_LB.p.z() + kRun);
  }
  EXPECT_LT(lowest, -0.02e-3) << "it did fall";
  EXPECT_GT(lowest, -fall);
  EXPECT_LT(world.state().v_WB_W.x(), 0.999 * v);
  EXPECT_GT(world.state().v_WB_W.x(), least);
  EXPECT_NEAR(world.state().X_LB.p.z(), -kRun, 1e-9);
  EXPECT_EQ(world.state().spot.pipe, 0);
}

TEST(BallAtJunction, RollsPastASideOpeningThatItsInvertDoesNotTouch) {
  // the mouth of an equal branch at the side reaches the invert in one point, without an edge
  const BoreNetwork tee(MakeStar({5, 6, 7}, Tee({0, 1, 0}, kBore)));
  const Vector3d hub(5, 6, 7);
  BallWorld world(tee.bore, Ball(), Rate(1000),
                  Rolling(tee.network, 1, hub + Vector3d(-0.3, 0, -kRun), {1, 0, 0}), Weight);
  for (int i = 0; i < 600; ++i) world.Step();
  EXPECT_NEAR((world.state().X_LB.p - hub - Vector3d(0.3, 0, -kRun)).norm(), 0, 1e-9);
  EXPECT_NEAR(world.state().v_WB_W.x(), 1, 1e-9);
}

TEST(BallAtJunction, ReportsTheCrossingIntoABranch) {
  const BoreNetwork tee(MakeStar(Vector3d::Zero(), Tee({0, 1, 0}, kBore)));
  BallWorld world(tee.bore, Ball(), Rate(1000), At(tee.network, 1, {-0.3, 0, -kRun}, {0.5, 0, 0}),
                  [](const BallInstant& ball) {
                    const bool there = ball.p_LB.x() > 0;  // pulls aside at the branch
                    return BallLoad{Vector3d(there ? -0.5 : 0.1, there ? 1 : 0, -kWeight) - 0.3 * ball.v_WB_W,
                                    Vector3d::Zero()};
                  });
  std::vector<SpotMove::Crossing> crossings;
  Vector3d last = world.state().X_LB.p;
  while (world.state().X_LB.p.y() < 1 && Seconds(world.state().time) < 10) {
    world.Step();
    if (world.state().crossing) crossings.push_back(*world.state().crossing);
    EXPECT_NEAR((world.state().X_LB.p - last - 1e-3 * world.state().v_step_W).norm(), 0, 1e-14);
    last = world.state().X_LB.p;
  }
  ASSERT_FALSE(crossings.empty());
  EXPECT_EQ(crossings.front().left, (PipeEnd{1, false}));
  EXPECT_EQ(crossings.back().entered, (PipeEnd{2, false}));
  EXPECT_EQ(world.state().spot.pipe, 2);
  EXPECT_NEAR(world.state().spot.s_m, world.state().X_LB.p.y(), 1e-12);
}

TEST(BallAtJunction, CrossesAJointWhoseDrawingDoesNotClose) {
  // a pipe of stated length 2.5 m drawn 2 m long: its end lies half a metre beyond the node, where the next
  // begins
  std::vector<PipeSpec> pipes{MakePipeSpec("P", "A", "M"), MakePipeSpec("Q", "M", "B")};
  pipes[0].length_m = 2.5;
  const BoreNetwork line(Network({{"A", {0, 0, 0}}, {"M", {2, 0, 0}}, {"B", {6, 0, 0}}}, pipes));
  BallWorld world(line.bore, Ball(), Rate(1000), Rolling(line.network, 0, {2.2, 0, -kRun}, {1, 0, 0}),
                  Weight);
  Vector3d offset = Vector3d::Zero();  // from the ball's own way to the drawing
  for (int i = 0; i < 600; ++i) {
    world.Step();
    if (world.state().crossing) offset += world.state().crossing->shift_L;
  }
  EXPECT_EQ(world.state().spot.pipe, 1);
  EXPECT_NEAR((offset - Vector3d(-0.5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(world.state().spot.s_m, 0.3, 1e-9);
  EXPECT_NEAR((world.state().X_LB.p - offset - Vector3d(2.8, 0, -kRun)).norm(), 0, 1e-9);
  EXPECT_NEAR(world.state().v_WB_W.x(), 1, 1e-9);
}

TEST(BallAtJunction, RisesThroughAVerticalMitre) {
  const BoreNetwork riser(MakeStar(Vector3d::Zero(), {{{3, 0, 0}, kBore}, {{0, 0, 3}, kBore}}));
  BallWorld world(riser.bore, Ball(), Rate(1000), At(riser.network, 0, {0.5, 0, -kRun}),
                  [](const BallInstant& ball) {
                    return BallLoad{Vector3d(-0.3, 0, 0.3) - 0.3 * ball.v_WB_W, Vector3d::Zero()};
                  });
  for (int i = 0; i < 8000 && world.state().X_LB.p.z() < 2; ++i) world.Step();
  EXPECT_EQ(world.state().spot.pipe, 1);
  EXPECT_GE(world.state().X_LB.p.z(), 2);
  EXPECT_NEAR(world.state().X_LB.p.x(), -kRun, 0.01) << "pushed against the wall of the riser";
  EXPECT_EQ(world.state().rescues, 0);
}

TEST(BallAtJunction, ADeadEndHoldsTheBallAgainstAPush) {
  const BoreNetwork end(MakeStar(Vector3d::Zero(), {{{3, 0, 0}, kBore}}));
  BallWorld world(end.bore, Ball(0), Rate(1000), At(end.network, 0, {0.5, 0, -kRun}),
                  [](const BallInstant& ball) {
                    return BallLoad{Vector3d(-0.3, 0, -kWeight) - 0.3 * ball.v_WB_W, Vector3d::Zero()};
                  });
  for (int i = 0; i < 20000; ++i) world.Step();
  // at rest in the half sphere where the wall's normal balances push and weight
  const Vector3d load(-0.3, 0, -kWeight);
  EXPECT_NEAR((world.state().X_LB.p - kRun * load.normalized()).norm(), 0, 1e-6);
  EXPECT_NEAR(world.state().normal_force_N, load.norm(), 1e-6);
}

TEST(BallAtJunction, APlateHoldsTheBallAtAShutBranch) {
  std::vector<StarArm> arms = Tee({0, 1, 0}, 0.05);
  arms[2].passable = false;
  const BoreNetwork tee(MakeStar(Vector3d::Zero(), arms));
  BallWorld world(
      tee.bore, Ball(0), Rate(1000), At(tee.network, 0, {0.001, 0.01, -0.005}), [](const BallInstant& ball) {
        return BallLoad{Vector3d(-0.1 * ball.p_LB.x(), 0.3, -kWeight) - 0.5 * ball.v_WB_W, Vector3d::Zero()};
      });
  for (int i = 0; i < 20000; ++i) world.Step();
  EXPECT_NEAR(world.state().X_LB.p.y(), 0.075 - kRadius, 1e-9);  // the plate sits where the widest bore ends
  EXPECT_LT(world.state().v_WB_W.norm(), 1e-6);
}

/// A pipe of the main's bore up to x = 1, one of 0.1 m from there on; it begins with a cone.
BoreNetwork MakeReducer() {
  return BoreNetwork(Network({{"A", {0, 0, 0}}, {"M", {1, 0, 0}}, {"B", {3, 0, 0}}},
                             {MakePipeSpec("wide", "A", "M", {.diameter_m = 0.15}),
                              MakePipeSpec("narrow", "M", "B", {.diameter_m = 0.1})}));
}

TEST(BallAtJunction, ABallTooLargeForAConeJamsWhereItFits) {
  // contact all around at R(s) cos(alpha) = r; F = N sin(alpha), N the sum around
  const BoreNetwork reducer = MakeReducer();
  const double radius = 0.06, slope = 0.025 / reducer.network.pipe(1).cone_from.length_m, push = 0.5;
  const double cosine = 1 / std::hypot(1, slope), sine = slope * cosine;
  BallWorld world(reducer.bore, {radius, 1, 1e-3, 0, 0}, Rate(1000),
                  At(reducer.network, 0, {0.5, 0.002, -0.01}), [&](const BallInstant& ball) {
                    return BallLoad{Vector3d(push, 0, 0) - 1.0 * ball.v_WB_W, Vector3d::Zero()};
                  });
  for (int i = 0; i < 20000; ++i) world.Step();
  const double x = 1 + (kBore - radius / cosine) / slope;
  EXPECT_NEAR((world.state().X_LB.p - Vector3d(x, 0, 0)).norm(), 0, 1e-6);
  EXPECT_LT(world.state().v_WB_W.norm(), 1e-6);
  EXPECT_NEAR(world.state().normal_force_N, push / sine, 1e-4);
}

TEST(BallAtJunction, JumpsOffTheEdgeOfAReducer) {
  // At 0.5 m/s the cone turns the path up by alpha with an impact; the ball climbs it, centre from -R + r to
  // -R' + r cos(alpha); at the edge, v^2/r being above gravity in water, it flies, and lands in the narrow
  // pipe.
  const BoreNetwork reducer = MakeReducer();
  const double v = 0.5, cosine = std::cos(std::atan(0.025 / reducer.network.pipe(1).cone_from.length_m));
  const double at_foot = CalcSpeedAfterTurn(v, cosine), climb = 0.025 - kRadius * (1 - cosine);
  const double at_edge = std::sqrt(at_foot * at_foot - 2 * kWeight * climb / (kInertial + kRotary));
  BallWorld world(reducer.bore, Ball(), Rate(4000), Rolling(reducer.network, 0, {0.9, 0, -kRun}, {v, 0, 0}),
                  Weight);
  while (world.state().X_LB.p.x() < 2 && Seconds(world.state().time) < 5) world.Step();
  EXPECT_NEAR(world.state().v_WB_W.x(), CalcSpeedAfterTurn(at_edge, cosine), 1e-4);
  EXPECT_NEAR(world.state().X_LB.p.z(), -0.02, 1e-9);
}

// ---- convergence

/// Passage over an opening: impulse and peak of the wall's force, in one tee at 0.8 m/s.
struct Passage {
  double impulse_N_s = 0;
  double peak_N = 0;
};

Passage Pass(std::int64_t rate_Hz, const std::optional<ContactCompliance>& compliance) {
  const BoreNetwork tee(MakeStar(Vector3d::Zero(), Tee(Vector3d(0, 0.6, -0.8), 0.05)));
  TubeBall ball = Ball();
  ball.compliance = compliance;
  const double dt_s = 1.0 / static_cast<double>(rate_Hz);
  BallWorld world(tee.bore, ball, Rate(static_cast<double>(rate_Hz)),
                  Rolling(tee.network, 1, {-0.25, 0, -kRun}, {0.8, 0, 0}), Weight);
  Passage passage;
  for (std::int64_t k = 0; k < rate_Hz / 2; ++k) {
    world.Step();
    passage.impulse_N_s += world.state().normal_force_N * dt_s;
    passage.peak_N = std::max(passage.peak_N, world.state().normal_force_N);
  }
  EXPECT_EQ(world.state().rescues, 0);
  return passage;
}

void PrintRow(std::int64_t rate_Hz, const Passage& p, const Passage& before) {
  std::printf("  %6d Hz  impulse %.6f N s (%+.1e)  peak %.4f N (%+.1e)\n", static_cast<int>(rate_Hz),
              p.impulse_N_s, p.impulse_N_s - before.impulse_N_s, p.peak_N, p.peak_N - before.peak_N);
}

std::vector<Passage> PassAtRates(const std::optional<ContactCompliance>& compliance) {
  std::vector<Passage> passages;
  for (std::int64_t rate_Hz = 250; rate_Hz <= 32000; rate_Hz *= 2) {
    passages.push_back(Pass(rate_Hz, compliance));
    PrintRow(rate_Hz, passages.back(), passages[passages.size() - (passages.size() > 1 ? 2 : 1)]);
  }
  return passages;
}

double LargestChange(const std::vector<Passage>& passages, std::size_t from, double Passage::*value) {
  double largest = 0;
  for (std::size_t i = from; i + 1 < passages.size(); ++i) {
    largest = std::max(largest, std::abs(passages[i + 1].*value - passages[i].*value));
  }
  return largest;
}

TEST(BallAtJunction, ImpulseThroughATeeConvergesAsTheStepIsHalved) {
  const std::vector<Passage> passages = PassAtRates(std::nullopt);
  // of first order: every three halvings leave an eighth; half an eighth is left for luck
  const double coarse = LargestChange(passages, 0, &Passage::impulse_N_s);
  EXPECT_LT(LargestChange(passages, 4, &Passage::impulse_N_s), coarse / 4);
  EXPECT_LT(LargestChange(passages, 5, &Passage::impulse_N_s), 2e-3 * passages.back().impulse_N_s);
}

TEST(BallAtJunction, PeakForceOfACompliantBallConvergesAsTheStepIsHalved) {
  const std::vector<Passage> passages = PassAtRates(ContactCompliance{5000, 10});
  const double coarse = LargestChange(passages, 0, &Passage::peak_N);
  EXPECT_LT(LargestChange(passages, 4, &Passage::peak_N), coarse / 4);
  EXPECT_LT(LargestChange(passages, 5, &Passage::peak_N), 0.02 * passages.back().peak_N);
}

// ---- what an IMU would say, and what must never happen

TEST(BallAtJunction, StrapdownClosesThroughATee) {
  const BoreNetwork tee(MakeStar({412, -230, 61}, Tee(Vector3d(0, 0.6, -0.8), 0.05)));
  const Vector3d hub(412, -230, 61), gravity(0, 0, -kGravity);
  const double dt_s = 1e-3;
  BallWorld world(tee.bore, Ball(), Rate(1000),
                  Rolling(tee.network, 1, hub + Vector3d(-0.5, 0, -kRun), {0.8, 0, 0}), Weight);
  Pose X_WB = world.state().X_LB;
  Vector3d v = world.state().v_WB_W;
  double kick_s = 0.5 * dt_s;  // the start velocity is that at the instant
  for (int i = 0; i < 2000; ++i) {
    const BallState before = world.state();
    const Vector3d f_B = before.X_LB.q.conjugate() * (before.a_WB_W - gravity);
    world.Step();
    v += kick_s * (X_WB.q * f_B + gravity);
    X_WB.p += dt_s * v;
    X_WB.q = (X_WB.q * ExpSO3(world.state().dtheta_B_rad)).normalized();
    kick_s = dt_s;
  }
  EXPECT_GT(world.state().X_LB.p.x() - hub.x(), 0.5);
  EXPECT_LT((X_WB.p - world.state().X_LB.p).norm(), 1e-6);
  std::printf("  strapdown closure %.1e m\n", (X_WB.p - world.state().X_LB.p).norm());
}

/// Arms in random directions at least 0.6 rad apart.
std::vector<StarArm> DrawArms(const RandomStream& stream, std::uint64_t joint) {
  std::vector<StarArm> arms;
  const auto n = 1 + static_cast<std::size_t>(5 * stream.Uniforms(joint, 0)[0]);
  for (std::uint64_t slot = 1; arms.size() < n; ++slot) {
    const auto u = stream.Uniforms(joint, slot);
    const double z = 2 * u[1] - 1, angle = 2 * std::numbers::pi * u[0], rho = std::sqrt(1 - z * z);
    const Vector3d to(rho * std::cos(angle), rho * std::sin(angle), z);
    const bool apart = std::all_of(arms.begin(), arms.end(), [&](const StarArm& arm) {
      return arm.to_m.normalized().dot(to) < std::cos(0.6);
    });
    if (apart) arms.push_back({0.6 * to, 0.022 + 0.06 * u[2]});
  }
  arms[0].radius_m = 0.06;  // one that the ball fits
  return arms;
}

/// A new random push every 30 ms.
BallLoad DrawLoad(const RandomStream& stream, const BallInstant& ball) {
  const auto sample = static_cast<std::uint64_t>(Seconds(ball.time) / 0.03);
  const auto u = stream.Normals(sample, 0);
  return {2 * Vector3d(u[0], u[1], u[2]) - 0.8 * ball.v_WB_W, Vector3d::Zero()};
}

struct Worst {
  double overlap_m = 0;
  double speed_m_s = 0;
};

/// Knocks the ball about in one joint; the water it must stay in is told by inside and outside alone.
Worst KnockAbout(const std::vector<StarArm>& arms, std::uint64_t seed, int steps) {
  const BoreNetwork star(MakeStar(Vector3d::Zero(), arms));
  const BoreWall wall(star.bore);
  UnionOfBores bores;
  for (const StarArm& arm : arms) bores.tubes.push_back({arm.to_m.normalized(), arm.radius_m});
  const RandomStream stream(seed, "push", 0);
  BallWorld world(star.bore, {0.028, 0.15, 4e-5, 0.4, 1e-4}, Rate(1000),
                  At(star.network, 0, 0.3 * arms[0].to_m),
                  [&](const BallInstant& ball) { return DrawLoad(stream, ball); });
  Worst worst;
  for (int i = 0; i < steps; ++i) {
    world.Step();
    const BallState& ball = world.state();
    if (!ball.X_LB.p.allFinite() || !bores.Contains(ball.X_LB.p) || ball.rescues > 0) {
      ADD_FAILURE() << "escaped at step " << i << " to " << ball.X_LB.p.transpose();
      return worst;
    }
    worst.speed_m_s = std::max(worst.speed_m_s, ball.v_WB_W.norm());
    for (const WallFoot& foot :
         wall.FindFeet(ball.spot, wall.X_FL(ball.spot) * ball.X_LB.p, Vector3d::Zero(), 0.028)) {
      worst.overlap_m = std::max(worst.overlap_m, 0.028 - foot.distance_m);
    }
  }
  return worst;
}

TEST(BallAtJunction, NeverLeavesTheWaterOfRandomJoints) {
  const RandomStream stream(11, "joints", 0);
  Worst worst;
  for (std::uint64_t joint = 0; joint < 40; ++joint) {
    SCOPED_TRACE("joint " + std::to_string(joint));
    const Worst here = KnockAbout(DrawArms(stream, joint), joint, 2500);
    worst.overlap_m = std::max(worst.overlap_m, here.overlap_m);
    worst.speed_m_s = std::max(worst.speed_m_s, here.speed_m_s);
    // a wall that a step meets without its having been predicted turns away by (v dt)^2 / (2 r)
    EXPECT_LE(here.overlap_m, 0.5e-6 * here.speed_m_s * here.speed_m_s / 0.028);
  }
  std::printf("  deepest overlap %.1e m, highest speed %.1f m/s\n", worst.overlap_m, worst.speed_m_s);
  EXPECT_GT(worst.speed_m_s, 1);
}

}  // namespace
}  // namespace piperun::sim
