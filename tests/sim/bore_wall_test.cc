#include "sim/bore_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "tests/support/pipes.h"
#include "tests/support/union_of_bores.h"

namespace piperun::sim {
namespace {

using testing::BoreNetwork;
using testing::FindSpot;
using testing::MakeBoreLine;
using testing::MakePipeSpec;
using testing::MakeStar;
using testing::PipeShape;
using testing::StarArm;
using testing::UnionOfBores;

constexpr double kBore = 0.075, kBall = 0.03;

/// Feet of a point in the drawing of `pipe`, their normals in its axes.
std::vector<WallFoot> FindFeet(const BoreNetwork& pipes, const BoreWall& wall, int pipe, const Vector3d& p_L,
                               double limit_m = 1) {
  const NetworkSpot spot = FindSpot(pipes.network, pipe, p_L);
  std::vector<WallFoot> feet;
  for (WallFoot foot : wall.FindFeet(spot, wall.X_FL(spot) * p_L, Vector3d::Zero(), limit_m)) {
    foot.normal = wall.X_LF(spot).q * foot.normal;
    feet.push_back(foot);
  }
  return feet;
}

WallFoot Nearest(const std::vector<WallFoot>& feet) {
  WallFoot none;
  none.distance_m = 1e9;
  for (const WallFoot& foot : feet) {
    if (foot.distance_m < none.distance_m) none = foot;
  }
  return none;
}

/// Distance from the axis of pipe 0 by looking everywhere along it.
double BruteDistance(const Network& network, const Vector3d& p_L) {
  const Pipe& pipe = network.pipe(0);
  double best = 1e9;
  const int n = 400000;
  for (int i = 0; i <= n; ++i) best = std::min(best, (pipe.Eval(pipe.length_m * i / n).p_W - p_L).norm());
  return best;
}

TEST(BoreWall, DistanceInABentPipeIsThatToTheNearestWall) {
  const BoreNetwork line =
      MakeBoreLine({{0, 0, 0}, {2, 0, 0}, {2, 1.5, 1}, {4, 3, 1}}, {.bend_radius_m = 0.25});
  const BoreWall wall(line.bore);
  for (const double s_m : {0.4, 1.85, 2.0, 2.9, 3.4, 4.9}) {
    const CentrelinePoint axis = line.network.pipe(0).Eval(s_m);
    const Vector3d side = axis.tangent_W.unitOrthogonal();
    const Vector3d p_L = axis.p_W + 0.031 * side + 0.017 * axis.tangent_W.cross(side);
    const WallFoot foot = Nearest(FindFeet(line, wall, 0, p_L));
    EXPECT_NEAR(foot.distance_m, kBore - BruteDistance(line.network, p_L), 1e-9) << s_m;
    const NetworkSpot spot = FindSpot(line.network, 0, p_L);
    EXPECT_NEAR((foot.normal - (spot.axis.p_W - p_L).normalized()).norm(), 0, 1e-12);
  }
}

/// Contacts of a sphere in pipe 0.
WallContacts Probe(const BoreNetwork& pipes, const BoreWall& wall, const Vector3d& p_L, const Vector3d& v_L,
                   double dt_s) {
  const NetworkSpot spot = FindSpot(pipes.network, 0, p_L);
  return wall.Probe(spot, wall.X_FL(spot) * p_L, wall.X_FL(spot).q * v_L, kBall, dt_s);
}

TEST(BoreWall, GapIsPredictedWhereTheStepLeads) {
  // straight pipe: moving sideways by a at distance e from the axis leads to sqrt(e^2 + a^2)
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {10, 0, 0}});
  const BoreWall wall(line.bore);
  const WallContacts contacts = Probe(line, wall, {5, 0, -0.045}, {0.7, 0.4, -0.2}, 0.01);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_NEAR(contacts.begin()->gap_m, 0.045 - std::hypot(0.045, 0.004), 1e-15);
}

TEST(BoreWall, PredictionCrossesIntoTheBend) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}}, {.bend_radius_m = 0.5});
  const BoreWall wall(line.bore);
  // the bend begins at x = 1.5 about (1.5, 0.5)
  const WallContacts contacts = Probe(line, wall, {1.4995, 0, -0.045}, {10, 0, 0}, 1e-3);
  ASSERT_EQ(contacts.size(), 1U);
  const double outward = std::hypot(0.0095, 0.5) - 0.5;  // p' = (1.5095, 0)
  EXPECT_NEAR(contacts.begin()->gap_m, 0.045 - std::hypot(outward, 0.045), 1e-14);
}

TEST(BoreWall, PredictionCrossesASmoothJoint) {
  // the same pipe cut in two where the bend begins
  const std::vector<NodeSpec> nodes{{"A", {0, 0, 0}}, {"M", {1.5, 0, 0}}, {"B", {2, 2, 0}}};
  const BoreNetwork two(Network(nodes, {MakePipeSpec("P", "A", "M"),
                                        MakePipeSpec("Q", "M", "B", {.bend_radius_m = 0.5}, {{2, 0, 0}})}));
  const BoreWall wall(two.bore);
  const WallContacts contacts = Probe(two, wall, {1.4995, 0, -0.045}, {10, 0, 0}, 1e-3);
  ASSERT_EQ(contacts.size(), 1U);
  const double outward = std::hypot(0.0095, 0.5) - 0.5;
  EXPECT_NEAR(contacts.begin()->gap_m, 0.045 - std::hypot(outward, 0.045), 1e-14);
}

TEST(BoreWall, SeesNoWallFromTheAxisOrFromAfar) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {10, 0, 0}});
  const BoreWall wall(line.bore);
  EXPECT_EQ(Probe(line, wall, {5, 0, 0}, {1, 0, 0}, 1e-3).size(), 0U);
  EXPECT_EQ(Probe(line, wall, {5, 0, -0.042}, {1, 0, 0}, 1e-3).size(), 0U);
  EXPECT_EQ(Probe(line, wall, {5, 0, -0.0435}, {1, 0, 0}, 1e-3).size(), 1U);
  EXPECT_EQ(Probe(line, wall, {5, 0, -0.03}, {0, 0, -15}, 1e-3).size(), 1U)
      << "fast enough to pass through within the step";
}

// ---- joints, against rays sent in all directions (tests/support/union_of_bores.h)

Vector3d Direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * std::numbers::pi / 180, e = elevation_deg * std::numbers::pi / 180;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

struct Shape {
  const char* name;
  std::vector<StarArm> arms;
};

std::vector<Shape> Shapes() {
  const auto arm = [](double azimuth, double radius_m, double elevation = 0) {
    return StarArm{3 * Direction(azimuth, elevation), radius_m};
  };
  return {{"tee", {arm(0, 0.075), arm(180, 0.075), arm(90, 0.075)}},
          {"tee with a narrow branch", {arm(10, 0.075), arm(190, 0.075), arm(100, 0.04)}},
          {"tee, branch at 45 degrees", {arm(0, 0.075), arm(180, 0.075), arm(45, 0.05)}},
          {"tee, slim branch at 30 degrees", {arm(0, 0.075), arm(180, 0.075), arm(30, 0.025)}},
          {"riser", {arm(0, 0.075), arm(180, 0.075), arm(0, 0.05, 90)}},
          {"Y", {arm(0, 0.075), arm(120, 0.075), arm(240, 0.075)}},
          {"Y of three bores", {arm(0, 0.075), arm(140, 0.06), arm(215, 0.045)}},
          {"cross", {arm(0, 0.075), arm(180, 0.075), arm(90, 0.075), arm(270, 0.075)}},
          {"uneven cross in space", {arm(0, 0.075), arm(180, 0.07), arm(90, 0.05, 20), arm(250, 0.06, -30)}},
          {"mitre", {arm(0, 0.075), arm(120, 0.075)}},
          {"sharp mitre", {arm(0, 0.075), arm(50, 0.075)}},
          {"mitre with a step", {arm(0, 0.075), arm(135, 0.05)}},
          {"step", {arm(0, 0.075), arm(178, 0.05)}},
          {"dead end", {arm(0, 0.075)}}};
}

UnionOfBores MakeUnion(const std::vector<StarArm>& arms) {
  UnionOfBores bores;
  for (const StarArm& arm : arms) bores.tubes.push_back({arm.to_m.normalized(), arm.radius_m});
  return bores;
}

/// The arm in which a point lies deepest.
int FindArm(const std::vector<StarArm>& arms, const Vector3d& p) {
  int best = 0;
  double best_m = 1e9;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const Vector3d a = arms[i].to_m.normalized();
    const double off = (p - p.dot(a) * a).norm() / arms[i].radius_m;
    if (p.dot(a) < 0 || off >= best_m) continue;
    best = static_cast<int>(i);
    best_m = off;
  }
  return best;
}

Vector3d Draw(const RandomStream& stream, std::uint64_t sample, double half_m) {
  const auto u = stream.Uniforms(sample, 0);
  return half_m * Vector3d(2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1);
}

/// At random points of the joint, no ray leaves sooner than the nearest foot says, and the foot is on the
/// boundary: so it is the nearest point.
void CompareWithRays(const std::vector<StarArm>& arms, std::uint64_t seed, int points) {
  const Vector3d hub(20, -30, 5);
  const BoreNetwork star(MakeStar(hub, arms));
  const BoreWall wall(star.bore);
  const UnionOfBores bores = MakeUnion(arms);
  const RandomStream stream(seed, "points", 0);
  for (std::uint64_t sample = 0; points > 0; ++sample) {
    const Vector3d p = Draw(stream, sample, 0.18);
    if (!bores.Contains(p)) continue;
    --points;
    const WallFoot foot = Nearest(FindFeet(star, wall, FindArm(arms, p), hub + p));
    EXPECT_LE(foot.distance_m, bores.CalcDistance(p) + 1e-10) << "at " << p.transpose();
    EXPECT_TRUE(bores.IsOnBoundary(p - foot.distance_m * foot.normal, 1e-8)) << "at " << p.transpose();
  }
}

TEST(BoreWall, NearestFootInAJointIsTheNearestPointOfTheBoundary) {
  for (const Shape& shape : Shapes()) {
    SCOPED_TRACE(shape.name);
    CompareWithRays(shape.arms, 1, 25);
  }
}

TEST(BoreWall, NearestFootInARandomJointIsTheNearestPointOfTheBoundary) {
  const RandomStream stream(7, "joints", 0);
  for (std::uint64_t joint = 0; joint < 40; ++joint) {
    std::vector<StarArm> arms;
    const auto n = 1 + static_cast<std::size_t>(5 * stream.Uniforms(joint, 0)[0]);
    for (std::uint32_t slot = 1; arms.size() < n; ++slot) {
      const auto u = stream.Uniforms(joint, slot);
      const Vector3d to = Direction(360 * u[0], std::asin(2 * u[1] - 1) * 180 / std::numbers::pi);
      const bool apart = std::all_of(arms.begin(), arms.end(), [&](const StarArm& arm) {
        return arm.to_m.normalized().dot(to) < std::cos(0.5);
      });
      if (apart) arms.push_back({3 * to, 0.03 + 0.06 * u[2]});
    }
    SCOPED_TRACE("joint " + std::to_string(joint));
    CompareWithRays(arms, 100 + joint, 8);
  }
}

/// Follows a straight path, feet at every step: wherever the nearest one was, one goes on from it, its normal
/// turned by no more than the step allows.
void ExpectContinuousNormals(const std::vector<StarArm>& arms, const Vector3d& begin, const Vector3d& end) {
  const BoreNetwork star(MakeStar(Vector3d::Zero(), arms));
  const BoreWall wall(star.bore);
  const int steps = 4000;
  const double step_m = (end - begin).norm() / steps;
  WallFoot last;
  double largest = 0;
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = begin + (end - begin) * i / steps;
    const std::vector<WallFoot> feet = FindFeet(star, wall, FindArm(arms, p), p, 0.1);
    ASSERT_FALSE(feet.empty());
    if (i > 0 && last.distance_m < 0.04) {  // the tubes' axes, where normals turn at once, are farther
      double turn = 1e9;
      for (const WallFoot& foot : feet) turn = std::min(turn, (foot.normal - last.normal).norm());
      largest = std::max(largest, turn * last.distance_m / step_m);
    }
    last = Nearest(feet);
  }
  // an edge or a sphere's centre turns by step/distance, a tube's wall by up to step/(R - distance)
  EXPECT_LT(largest, 2) << "jump of a normal";
}

TEST(BoreWall, NormalsTurnWithoutAJumpOverARim) {
  const auto arms = [](double radius_m, double azimuth_deg) {
    return std::vector<StarArm>{
        {{3, 0, 0}, 0.075}, {{-3, 0, 0}, 0.075}, {3 * Direction(azimuth_deg, 0), radius_m}};
  };
  for (const double radius_m : {0.075, 0.06, 0.035}) {
    for (const double azimuth_deg : {90.0, 60.0, 40.0}) {
      SCOPED_TRACE(std::to_string(radius_m) + " at " + std::to_string(azimuth_deg));
      // off the plane of symmetry, in which one nearest point turns into two with all its speed
      ExpectContinuousNormals(arms(radius_m, azimuth_deg), {-0.25, 0.044, 0.003}, {0.25, 0.044, 0.005});
      ExpectContinuousNormals(arms(radius_m, azimuth_deg), {-0.25, 0.044, 0.013}, {0.25, 0.044, 0.013});
      ExpectContinuousNormals(arms(radius_m, azimuth_deg), {-0.2, 0.01, -0.04}, {0.2, 0.05, -0.01});
    }
  }
}

TEST(BoreWall, StraightPipeCutByANodeHasNoEdge) {
  const std::vector<StarArm> arms{{{3, 0, 0}, 0.075}, {{-3, 0, 1e-5}, 0.075}};  // too kinked to be smooth
  const BoreNetwork star(MakeStar(Vector3d::Zero(), arms));
  ASSERT_FALSE(star.bore.joint(0).smooth);
  const BoreWall wall(star.bore);
  for (const double x : {-0.05, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 0.05}) {
    const std::vector<WallFoot> feet = FindFeet(star, wall, x < 0 ? 1 : 0, {x, 0.02, -0.04}, 0.06);
    ASSERT_EQ(feet.size(), 1U) << x;
    EXPECT_NEAR(feet[0].distance_m, 0.075 - std::hypot(0.02, 0.04), 1e-6);
  }
}

// ---- cones

/// Two collinear pipes of radii R and r < R, which meet at x = 1; the narrow one begins with a cone.
BoreNetwork MakeReducer(double wide_m, double narrow_m) {
  return BoreNetwork(Network({{"A", {0, 0, 0}}, {"M", {1, 0, 0}}, {"B", {2, 0, 0}}},
                             {MakePipeSpec("wide", "A", "M", {.diameter_m = 2 * wide_m}),
                              MakePipeSpec("narrow", "M", "B", {.diameter_m = 2 * narrow_m})}));
}

/// Distance to the reducer's wall by looking everywhere along its meridian.
double BruteReducerDistance(double wide_m, double narrow_m, double cone_m, double x, double rho) {
  double best = 1e9;
  const int n = 200000;
  for (int i = 0; i <= n; ++i) {
    const double at = 0.8 + 0.6 * i / n;
    const double share = std::clamp((at - 1) / cone_m, 0.0, 1.0);
    best = std::min(best, std::hypot(at - x, wide_m + share * (narrow_m - wide_m) - rho));
  }
  return std::min(best, std::hypot(1 + cone_m - x, narrow_m - rho));
}

TEST(BoreWall, DistanceInAReducerIsThatToTheNearestWall) {
  for (const double narrow_m : {0.065, 0.05, 0.035}) {
    const BoreNetwork reducer = MakeReducer(0.075, narrow_m);
    ASSERT_TRUE(reducer.bore.joint(1).smooth);
    const double cone_m = reducer.network.pipe(1).cone_from.length_m;
    ASSERT_GT(cone_m, 0);
    const BoreWall wall(reducer.bore);
    for (double x = 0.9; x < 1.25; x += 0.0071) {
      for (const double rho : {0.001, 0.02, 0.034}) {
        const Vector3d p(x, rho * std::cos(0.7), rho * std::sin(0.7));
        const std::vector<WallFoot> feet = FindFeet(reducer, wall, x < 1 ? 0 : 1, p, 0.2);
        const double expected = BruteReducerDistance(0.075, narrow_m, cone_m, x, rho);
        EXPECT_NEAR(Nearest(feet).distance_m, expected, 1e-9) << x << " " << rho << " " << narrow_m;
      }
    }
  }
}

TEST(BoreWall, BothWallsTouchAtTheWideEndOfACone) {
  // a sphere in the corner between cylinder and cone touches both: distance r from each at
  // x = 1 - r tan(alpha/2), rho = R - r, half angle alpha
  const BoreNetwork reducer = MakeReducer(0.075, 0.05);
  const double alpha = std::atan(0.025 / reducer.network.pipe(1).cone_from.length_m);
  const BoreWall wall(reducer.bore);
  const Vector3d p(1 - kBall * std::tan(alpha / 2), 0, -(0.075 - kBall));
  const std::vector<WallFoot> feet = FindFeet(reducer, wall, 0, p, 0.04);
  ASSERT_EQ(feet.size(), 2U);
  for (const WallFoot& foot : feet) EXPECT_NEAR(foot.distance_m, kBall, 1e-14);
  const double cosine = feet[0].normal.dot(feet[1].normal);
  EXPECT_NEAR(cosine, std::cos(alpha), 1e-12);
}

TEST(BoreWall, TheNarrowEndOfAConeIsAnEdge) {
  const BoreNetwork reducer = MakeReducer(0.075, 0.05);
  const double cone_m = reducer.network.pipe(1).cone_from.length_m, slope = -0.025 / cone_m;
  const BoreWall wall(reducer.bore);
  const double depth = 0.02, ds = 0.5 * slope * depth;  // half way between the two walls' normals
  const std::vector<WallFoot> feet = FindFeet(reducer, wall, 1, {1 + cone_m + ds, 0, -(0.05 - depth)}, 0.025);
  ASSERT_EQ(feet.size(), 1U);
  EXPECT_NEAR(feet[0].distance_m, std::hypot(ds, depth), 1e-14);
  EXPECT_NEAR((feet[0].normal - Vector3d(ds, 0, depth).normalized()).norm(), 0, 1e-12);
}

TEST(BoreWall, ABallThatJamsInAConeTouchesItAllAround) {
  // on the axis, radius r touches the cone where R(s) cos(alpha) = r
  const BoreNetwork reducer = MakeReducer(0.075, 0.05);
  const double ball = 0.06, slope = 0.025 / reducer.network.pipe(1).cone_from.length_m;
  const double cosine = 1 / std::hypot(1, slope);
  const BoreWall wall(reducer.bore);
  const Vector3d p(1 + (0.075 - ball / cosine) / slope, 0, 0);
  const NetworkSpot spot = FindSpot(reducer.network, 1, p);
  const WallContacts contacts = wall.Probe(spot, wall.X_FL(spot) * p, {0.01, 0, 0}, ball, 1e-3);
  ASSERT_EQ(contacts.size(), 3U);
  Vector3d sum = Vector3d::Zero();
  for (const WallContact& contact : contacts) {
    EXPECT_NEAR(contact.gap_m, 0, 1e-12);
    sum += contact.normal_F;
  }
  EXPECT_NEAR((sum - Vector3d(-3 * slope * cosine, 0, 0)).norm(), 0, 1e-12) << "they balance across the pipe";
}

// ---- shut pipes, short pipes, and centres outside of the water

TEST(BoreWall, APlateShutsAnImpassableBranchBehindItsMouth) {
  const std::vector<StarArm> arms{{{3, 0, 0}, 0.075}, {{-3, 0, 0}, 0.075}, {{0, 3, 0}, 0.05, false}};
  const BoreNetwork star(MakeStar(Vector3d::Zero(), arms));
  const BoreWall wall(star.bore);
  const double plate_m = 0.075;  // reach of the branch: the widest bore
  const std::vector<WallFoot> in_branch = FindFeet(star, wall, 2, {0, 0.06, 0}, 0.02);
  ASSERT_EQ(in_branch.size(), 1U);
  EXPECT_NEAR(in_branch[0].distance_m, plate_m - 0.06, 1e-14);
  EXPECT_NEAR((in_branch[0].normal - Vector3d(0, -1, 0)).norm(), 0, 1e-12);
  // felt from the main, too, by a ball that has come half way in
  const std::vector<WallFoot> in_main = FindFeet(star, wall, 0, {0.01, 0.05, 0}, 0.03);
  EXPECT_NEAR(Nearest(in_main).distance_m, plate_m - 0.05, 1e-14);
}

TEST(BoreWall, ShortPipesFeelBothTheirJointsSlow) {
  // an off-set cross: branches to +y and -y from nodes 60 mm apart on a main along x
  const double apart = 0.06;
  std::vector<NodeSpec> nodes{{"A", {-3, 0, 0}}, {"M", {0, 0, 0}}, {"N", {apart, 0, 0}},
                              {"B", {3, 0, 0}},  {"C", {0, 3, 0}}, {"D", {apart, -3, 0}}};
  const PipeShape wide{.diameter_m = 0.15}, slim{.diameter_m = 0.1};
  const BoreNetwork cross(
      Network(nodes, {MakePipeSpec("main", "A", "M", wide), MakePipeSpec("short", "M", "N", wide),
                      MakePipeSpec("rest", "N", "B", wide), MakePipeSpec("left", "M", "C", slim),
                      MakePipeSpec("right", "N", "D", slim)}));
  const BoreWall wall(cross.bore);
  UnionOfBores bores;  // the main is one tube; the nodes' spheres lie within it
  bores.tubes = {
      {{1, 0, 0}, 0.075}, {{-1, 0, 0}, 0.075}, {{0, 1, 0}, 0.05}, {{0, -1, 0}, 0.05, {apart, 0, 0}}};
  const RandomStream stream(3, "points", 0);
  int checked = 0;
  for (std::uint64_t sample = 0; checked < 30; ++sample) {
    const Vector3d p = Draw(stream, sample, 0.07) + Vector3d(apart / 2, 0, 0);
    if (std::hypot(p.y(), p.z()) > 0.074 || p.x() < 0 || p.x() > apart) continue;  // in the short pipe
    ++checked;
    const WallFoot foot = Nearest(FindFeet(cross, wall, 1, p));
    EXPECT_LE(foot.distance_m, bores.CalcDistance(p) + 1e-10) << p.transpose();
    EXPECT_TRUE(bores.IsOnBoundary(p - foot.distance_m * foot.normal, 1e-8)) << p.transpose();
  }
}

TEST(BoreWall, ACentreOutsideOfTheWaterIsLedBackToTheNearestBore) {
  const std::vector<StarArm> arms{{{3, 0, 0}, 0.075}, {{-3, 0, 0}, 0.075}, {{0, 3, 0}, 0.05}};
  const BoreNetwork star(MakeStar(Vector3d::Zero(), arms));
  const BoreWall wall(star.bore);
  const WallContacts contacts = Probe(star, wall, {0.06, 0.08, 0}, {1, 1, 0}, 1e-3);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_TRUE(contacts.rescue);
  EXPECT_NEAR(contacts.begin()->gap_m, -0.005 - kBall, 1e-12);
}

}  // namespace
}  // namespace piperun::sim
