#include "sim/wall_feature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "base/check.h"
#include "sim/bore_wall.h"
#include "tests/support/features.h"

namespace piperun::sim {
namespace {

using testing::AddFeatures;
using testing::BoreNetwork;
using testing::FindSpot;
using testing::MakeBoreLine;
using testing::MakeFeatures;
using testing::ParamValues;

constexpr double kBore = 0.075, kBall = 0.03;

struct Rho {
  double operator()(const Vector3d& p) const { return std::hypot(p.y(), p.z()); }
} rho;

/// Feet of a point of pipe 0, normals in the drawing.
std::vector<WallFoot> FindFeet(const BoreNetwork& line, const BoreWall& wall, const Vector3d& p_L,
                               double limit_m = 0.2) {
  const NetworkSpot spot = FindSpot(line.network, 0, p_L);
  std::vector<WallFoot> feet;
  for (WallFoot foot : wall.FindFeet(spot, wall.X_FL(spot) * p_L, Vector3d::Zero(), limit_m)) {
    foot.normal = wall.X_LF(spot).q * foot.normal;
    feet.push_back(foot);
  }
  return feet;
}

/// A direction, evenly over the sphere: Fibonacci's spiral.
Vector3d SpiralDirection(int i, int n) {
  const double z = 1 - (2 * i + 1.0) / n, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
  return {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
}

/// For points p around x = 1 m: the ball that just reaches the nearest foot holds nothing solid, and behind
/// the foot there is something solid. `solid` knows nothing of feet: it tells of any point whether it is in a
/// body.
void ExpectNearestFeet(const BoreNetwork& line, const std::function<bool(const Vector3d&)>& solid) {
  const BoreWall wall(line.bore);
  const RandomStream stream(5, "points", 0);
  constexpr int kDirections = 4000;
  int checked = 0;
  for (std::uint64_t sample = 0; checked < 300; ++sample) {
    const auto u = stream.Uniforms(sample, 0);
    const Vector3d p(1 + 0.1 * (u[0] - 0.5), 0.15 * (u[1] - 0.5), 0.15 * (u[2] - 0.5));
    if (rho(p) < 1e-3 || rho(p) > kBore || solid(p)) continue;  // no ball's centre comes into a gap
    ++checked;
    WallFoot nearest{Vector3d::Zero(), 1e9};
    for (const WallFoot& foot : FindFeet(line, wall, p)) {
      if (foot.distance_m < nearest.distance_m) nearest = foot;
    }
    const double d = nearest.distance_m;
    ASSERT_LT(d, 0.1) << p.transpose();
    EXPECT_TRUE(solid(p - (d + 1e-9) * nearest.normal))
        << p.transpose() << "; " << nearest.normal.transpose();
    for (int i = 0; i < kDirections; ++i) {
      const Vector3d q = p + (d - 1e-9) * SpiralDirection(i, kDirections);
      ASSERT_FALSE(solid(q)) << p.transpose() << " to " << q.transpose() << ", " << d;
    }
  }
}

BoreNetwork Straight() { return MakeBoreLine({{0, 0, 0}, {2, 0, 0}}); }

TEST(WallFeature, AWeldBeadIsACapOfItsHeightAndWidth) {
  BoreNetwork line = Straight();
  const double h = 0.004, w = 0.01;
  AddFeatures(line.bore, "weld_bead", {{"s_m", 1.0}, {"height_m", h}, {"width_m", w}});
  // a circle through (-w/2, 0), (0, h), (w/2, 0) above the wall, by its equation
  const double a = (h * h + w * w / 4) / (2 * h);
  ExpectNearestFeet(line, [&](const Vector3d& p) {
    const double above = kBore - rho(p), x = p.x() - 1;
    return above < 0 || (above - (h - a)) * (above - (h - a)) + x * x < a * a;
  });
}

TEST(WallFeature, AGateLeavesItsOpening) {
  BoreNetwork line = Straight();
  AddFeatures(line.bore, "gate_valve",
              {{"s_m", 1.0}, {"opening_m", 0.1}, {"thickness_m", 0.02}, {"edge_radius_m", 0.0}});
  ExpectNearestFeet(line, [](const Vector3d& p) {
    return rho(p) > kBore || (std::abs(p.x() - 1) < 0.01 && p.z() > 0.1 - kBore);
  });
}

TEST(WallFeature, TheClockRunsClockwiseSeenAlongThePipe) {
  // seen towards +x (east), three o'clock is south
  BoreNetwork line = Straight();
  AddFeatures(
      line.bore, "gate_valve",
      {{"s_m", 1.0}, {"opening_m", 0.1}, {"edge_radius_m", 0.0}, {"clock_rad", std::numbers::pi / 2}});
  ExpectNearestFeet(line, [](const Vector3d& p) {
    return rho(p) > kBore || (std::abs(p.x() - 1) < 0.01 && -p.y() > 0.1 - kBore);
  });
}

TEST(WallFeature, AServiceHoleTakesItsCylinderOutOfTheWall) {
  BoreNetwork line = Straight();
  AddFeatures(line.bore, "service_hole", {{"s_m", 1.0}, {"diameter_m", 0.05}});
  ExpectNearestFeet(line, [](const Vector3d& p) {
    return rho(p) > kBore && !(p.z() > 0 && std::hypot(p.x() - 1, p.y()) < 0.025);
  });
}

TEST(WallFeature, AJointIsAGapWithAFloorAndTheNextStickOutOfLine) {
  BoreNetwork line = Straight();
  const double w = 0.012, depth = 0.006, e = 0.003, ramp = 0.3;
  AddFeatures(line.bore, "joint",
              {{"s_m", 1.0},
               {"gap_m", w},
               {"depth_m", depth},
               {"offset_m", e},
               {"edge_radius_m", 0.0},
               {"ramp_m", ramp}});
  ASSERT_EQ(line.bore.features()[0].shapes.size(), 4U);
  const Vector3d towards = line.bore.features()[0].shapes[3].towards_W;
  EXPECT_NEAR(towards.norm(), 1, 1e-12);
  // the next stick's axis: from e away from `towards`, at the rim, back to the drawn one
  const Vector3d begin = Vector3d(1 + w / 2, 0, 0) - e * towards, end(1 + w / 2 + ramp, 0, 0);
  ExpectNearestFeet(line, [&](const Vector3d& p) {
    const double x = p.x() - 1;
    const bool wall = rho(p) > kBore && std::abs(x) > w / 2;
    const Vector3d axis = (end - begin).normalized();
    const double along = (p - begin).dot(axis);
    const bool stick = along > 0 && along < (end - begin).norm() && (p - begin - along * axis).norm() > kBore;
    return wall || stick || rho(p) > kBore + depth;
  });
}

TEST(WallFeature, ScaleIsLumpsOfTheStatedHeightOnTheStatedShareOfTheWall) {
  BoreNetwork line = Straight();
  const ParamValues values{{"s_m", 1.0},        {"length_m", 0.5},
                           {"cover", 0.3},      {"lump_diameter_m", 0.02},
                           {"height_m", 0.004}, {"height_sd_m", 0.001}};
  AddFeatures(line.bore, "scale", values);
  ASSERT_EQ(line.bore.features().size(), 1U);
  const auto& shapes = line.bore.features()[0].shapes;
  double sum = 0, sum_squares = 0, area = 0;
  std::vector<Vector3d> centres;
  for (const FeatureShape& shape : shapes) {
    const auto& boss = std::get<Boss>(shape.body);
    const double height = kBore - (boss.centre_m - boss.radius_m);
    // a cap's base: where its sphere meets the wall, to the wall's curvature; 20 mm at the mean height
    const double base = 2 * std::sqrt(height * (2 * boss.radius_m - height));
    EXPECT_NEAR(base / height, 0.02 / 0.004, 1e-9);
    EXPECT_LE(std::abs(shape.s_m - 1), 0.25);
    area += 0.25 * std::numbers::pi * base * base;
    sum += height;
    sum_squares += height * height;
    centres.push_back(Vector3d(shape.s_m, 0, 0) + boss.centre_m * shape.towards_W);
  }
  // the last lump is the one that covers enough; the largest is 35 mm wide
  EXPECT_NEAR(area / (2 * std::numbers::pi * kBore * 0.5), 0.3, 0.035 * 0.035 * 0.8 / (0.47 * 0.5));
  const double n = static_cast<double>(shapes.size()), mean = sum / n;
  EXPECT_NEAR(mean, 0.004, 4 * 0.001 / std::sqrt(n));
  // a normal number cut at 3 sigma has 0.9733 of the variance; relative error of a variance sqrt(2/n)
  EXPECT_NEAR((sum_squares / n - mean * mean) / (0.9733e-6), 1, 4 * std::sqrt(2 / n));
  ExpectNearestFeet(line, [&](const Vector3d& p) {
    if (rho(p) > kBore) return true;
    for (std::size_t i = 0; i < centres.size(); ++i) {
      if ((p - centres[i]).norm() < std::get<Boss>(shapes[i].body).radius_m) return true;
    }
    return false;
  });
}

TEST(WallFeature, FeetCarryTheIndexOfTheirFeature) {
  BoreNetwork line = Straight();
  AddFeatures(line.bore, "gate_valve", {{"s_m", 0.6}, {"opening_m", 0.1}});
  AddFeatures(line.bore, "joint", {{"s_m", 1.0}, {"gap_m", 0.01}});
  const BoreWall wall(line.bore);
  for (const WallFoot& foot : FindFeet(line, wall, {1, 0, -0.05}, 0.04)) EXPECT_EQ(foot.feature, 1);
  const auto at_gate = FindFeet(line, wall, {0.56, 0, 0.05}, 0.04);
  ASSERT_EQ(at_gate.size(), 2U);
  EXPECT_EQ(at_gate[0].feature, -1) << "the wall";
  EXPECT_EQ(at_gate[1].feature, 0);
}

TEST(WallFeature, ABeadInABendIsACircleInItsOwnCrossSection) {
  // 90 degrees about (0, 0.4); the bead is at 45
  BoreNetwork line = MakeBoreLine({{-2, 0, 0}, {0.4, 0, 0}, {0.4, 3, 0}}, {.bend_radius_m = 0.4});
  const double s = 2 + 0.4 * std::numbers::pi / 4, h = 0.003, w = 0.01;
  AddFeatures(line.bore, "weld_bead", {{"s_m", s}, {"height_m", h}, {"width_m", w}});
  const BoreWall wall(line.bore);
  const Vector3d outward(std::sqrt(0.5), -std::sqrt(0.5), 0), along(std::sqrt(0.5), std::sqrt(0.5), 0);
  const Vector3d centre = Vector3d(0, 0.4, 0) + 0.4 * outward;
  const double a = (h * h + w * w / 4) / (2 * h), circle = kBore - h + a;
  for (const double side : {-1.0, 1.0}) {
    for (const double x : {-0.02, 0.004}) {
      const Vector3d p = centre + x * along + side * 0.05 * outward;
      double expected = 1e9;
      for (const WallFoot& foot : FindFeet(line, wall, p, 0.06)) {
        if (foot.feature == 0) expected = std::min(expected, foot.distance_m);
      }
      EXPECT_NEAR(std::hypot(x, circle - 0.05) - a, expected, 1e-12);
    }
  }
}

TEST(WallFeature, IsFeltBehindASmoothJointOfPipesEitherWayRound) {
  for (const bool turned : {false, true}) {
    std::vector<NodeSpec> nodes{{"A", {0, 0, 0}}, {"B", {1, 0, 0}}, {"C", {2, 0, 0}}};
    const auto second = turned ? testing::MakePipeSpec("Q", "C", "B") : testing::MakePipeSpec("Q", "B", "C");
    BoreNetwork line(Network(nodes, {testing::MakePipeSpec("P", "A", "B"), second}));
    AddFeatures(line.bore, "joint", {{"s_m", 0.99}, {"gap_m", 0.01}, {"edge_radius_m", 0.001}});
    const BoreWall wall(line.bore);
    const Vector3d p(1.004, 0.01, -0.04);
    const NetworkSpot spot = FindSpot(line.network, 1, p);
    double nearest = 1e9;
    for (const WallFoot& foot : wall.FindFeet(spot, wall.X_FL(spot) * p, Vector3d::Zero(), 0.06)) {
      if (foot.feature == 0) nearest = std::min(nearest, foot.distance_m);
    }
    // the far rim: its wall begins at 0.99 + 0.005 + 0.001, so p is past it, and the near one 26 mm back
    const double offset = std::hypot(p.y(), p.z());
    EXPECT_NEAR(nearest, std::hypot(p.x() - 0.984, kBore + 0.001 - offset) - 0.001, 1e-12) << turned;
  }
}

TEST(WallFeature, SticksOfASeriesScatterOneByOne) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {6000, 0, 0}});
  const auto joints =
      MakeFeatures(line.bore, "joint", {{"spacing_m", 6.0}, {"spacing_sd_m", 0.05}, {"offset_m", 0.001}});
  ASSERT_GT(joints.size(), 980U);
  double sum = 0, squares = 0, product = 0, last = 0;
  Vector3d direction = Vector3d::Zero();
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const double d = joints[i].s_m - joints[i - 1].s_m - 6;
    sum += d;
    squares += d * d;
    product += d * std::exchange(last, d);
    direction += joints[i].shapes.back().towards_W;
  }
  const double n = static_cast<double>(joints.size() - 1), sd = std::sqrt(squares / n);
  EXPECT_NEAR(sum / n, 0, 4 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(sd / 0.05, 1, 4 / std::sqrt(2 * n));
  EXPECT_NEAR(product / n / (0.05 * 0.05), 0, 4 / std::sqrt(n))
      << "one stick's length tells nothing of the next";
  EXPECT_LT(direction.norm() / n, 4 / std::sqrt(n)) << "offsets point anywhere";
}

TEST(WallFeature, ASeriesLeavesOutBendsWhereItMustLieStraight) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, {.bend_radius_m = 0.5});
  const auto holes = MakeFeatures(line.bore, "service_hole", {{"spacing_m", 0.1}});
  const auto beads = MakeFeatures(line.bore, "weld_bead", {{"spacing_m", 0.1}});
  const double bend_begin = 4.5, bend_end = 4.5 + 0.25 * std::numbers::pi;
  const auto in_bend = [&](const WallFeature& f) { return f.s_m > bend_begin && f.s_m < bend_end; };
  EXPECT_EQ(std::count_if(holes.begin(), holes.end(), in_bend), 0);
  EXPECT_GE(std::count_if(beads.begin(), beads.end(), in_bend), 7);
}

/// The key that making a feature is refused for.
std::string RefusedKey(std::string_view kind, const ParamValues& values) {
  const BoreNetwork line = Straight();
  try {
    MakeFeatures(line.bore, kind, values);
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "none";
}

TEST(WallFeature, RefusesWhatDoesNotFitPipeOrBall) {
  EXPECT_EQ(RefusedKey("joint", {{"s_m", 2.5}}), "s_m") << "beyond the pipe";
  EXPECT_EQ(RefusedKey("joint", {}), "s_m") << "no place";
  EXPECT_EQ(RefusedKey("joint", {{"s_m", 1.0}, {"spacing_m", 1.0}}), "s_m") << "two of them";
  EXPECT_EQ(RefusedKey("joint", {{"spacing_m", 1.0}, {"spacing_sd_m", 0.2}}), "spacing_sd_m");
  EXPECT_EQ(RefusedKey("joint", {{"s_m", 1.0}, {"gap_m", 0.06}}), "gap_m") << "as wide as the ball";
  EXPECT_EQ(RefusedKey("joint", {{"s_m", 1.0}, {"gap_m", 0.05}, {"gap_sd_m", 0.004}}), "gap_m");
  EXPECT_EQ(RefusedKey("joint", {{"s_m", 1.0}, {"offset_m", 0.08}}), "offset_m");
  EXPECT_EQ(RefusedKey("weld_bead", {{"s_m", 1.0}, {"height_m", 0.075}}), "height_m");
  EXPECT_EQ(RefusedKey("scale", {{"s_m", 1.0}, {"height_m", 0.075}}), "height_m");
  EXPECT_EQ(RefusedKey("scale", {{"s_m", 1.0}, {"lump_diameter_m", 0.001}, {"cover", 0.9}}), "cover");
  EXPECT_EQ(RefusedKey("gate_valve", {{"s_m", 1.0}, {"opening_m", 0.15}}), "opening_m");
  EXPECT_EQ(RefusedKey("gate_valve", {{"s_m", 1.0}, {"edge_radius_m", 0.02}}), "edge_radius_m");
  EXPECT_EQ(RefusedKey("service_hole", {{"s_m", 1.0}, {"diameter_m", 0.06}}), "diameter_m");
  EXPECT_EQ(RefusedKey("gate_valve", {{"s_m", 1.0}, {"opening_m", 0.01}}), "none") << "it only jams the ball";
  EXPECT_EQ(RefusedKey("weld_bead", {{"s_m", 1.0}, {"height_m", 0.07}}), "none");
}

}  // namespace
}  // namespace piperun::sim
