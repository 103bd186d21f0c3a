#include "base/centreline.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "base/check.h"
#include "tests/support/any.h"

namespace piperun {
namespace {

constexpr double kPi = std::numbers::pi;

/// A straight or an arc anywhere in space; arcs turn by up to 170 degrees.
CentrelinePiece AnyPiece() {
  CentrelinePiece piece;
  piece.s_begin_m = any::Between(0, 50);
  piece.p_begin_W = 20 * any::UnitVector();
  piece.tangent_begin_W = any::UnitVector();
  piece.length_m = any::Between(0.1, 10);
  if (any::Integer(0, 1) == 0) return piece;
  const double radius_m = any::Between(0.2, 5);
  piece.curvature_1_m = 1 / radius_m;
  piece.length_m = radius_m * any::Between(0.05, 170 * kPi / 180);
  piece.normal_begin_W = piece.tangent_begin_W.unitOrthogonal();
  return piece;
}

double AnyPlace(const CentrelinePiece& piece) { return any::Between(piece.s_begin_m, piece.s_end_m()); }

RC_GTEST_PROP(EvalCentreline, TangentAndCurvatureAreTheDerivativesOfThePosition, ()) {
  const CentrelinePiece piece = AnyPiece();
  const double s = AnyPlace(piece), h = 1e-4;
  const CentrelinePoint before = EvalCentreline(piece, s - h), at = EvalCentreline(piece, s),
                        after = EvalCentreline(piece, s + h);
  // central differences err by h^2/6 k^2 (<= 4.2e-8 at k = 5) plus rounding
  RC_ASSERT(((after.p_W - before.p_W) / (2 * h) - at.tangent_W).norm() <= 1e-7);
  RC_ASSERT(((after.tangent_W - before.tangent_W) / (2 * h) - at.curvature_W).norm() <= 1e-6);
  RC_ASSERT(std::abs(at.tangent_W.norm() - 1) <= 1e-14);
  RC_ASSERT(std::abs(at.curvature_W.norm() - piece.curvature_1_m) <= 1e-13);
  RC_ASSERT(std::abs(at.tangent_W.dot(at.curvature_W)) <= 1e-13);
}

// anywhere within 0.9 R of the centreline, so never beyond the bend's own axis
RC_GTEST_PROP(FindNearest, ReturnsThePlaceAPointWasOffsetFrom, ()) {
  const CentrelinePiece piece = AnyPiece();
  const double s = AnyPlace(piece);
  const CentrelinePoint at = EvalCentreline(piece, s);
  const double reach_m = piece.straight() ? 2 : 0.9 / piece.curvature_1_m;
  const Vector3d side = at.tangent_W.cross(any::UnitVector());
  const Vector3d p_W = at.p_W + any::Between(-reach_m, reach_m) * side;
  RC_ASSERT(std::abs(FindNearest(piece, p_W) - s) <= 1e-12);
  RC_ASSERT(std::abs(FindNearest(piece, at.p_W) - s) <= 1e-13);
}

TEST(FindNearest, GoesOnBeyondTheEndsOfAnArc) {
  CentrelinePiece arc;  // quarter circle of radius 2 m, from the origin along x, bending to y
  arc.curvature_1_m = 0.5;
  arc.length_m = kPi;
  arc.normal_begin_W = Vector3d::UnitY();
  EXPECT_NEAR(FindNearest(arc, {-1, 1, 0}), -2 * kPi / 4, 1e-14);      // 45 degrees before it
  EXPECT_NEAR(FindNearest(arc, {1, 3, 0}), kPi + 2 * kPi / 4, 1e-14);  // 45 degrees after it
  EXPECT_NEAR(FindNearest(arc, {0, 2, 5}), kPi / 2, 1e-14);            // on the axis: the middle
}

RC_GTEST_PROP(Reversed, IsTheSameCurveWalkedBackwards, ()) {
  const CentrelinePiece piece = AnyPiece();
  const CentrelinePiece back = Reversed(piece, 3);
  const double along = any::Between(0, piece.length_m);
  const CentrelinePoint there = EvalCentreline(piece, piece.s_begin_m + along);
  const CentrelinePoint same = EvalCentreline(back, back.s_end_m() - along);
  RC_ASSERT(back.s_begin_m == 3);
  RC_ASSERT(back.length_m == piece.length_m);
  RC_ASSERT((there.p_W - same.p_W).norm() <= 1e-13);
  RC_ASSERT((there.tangent_W + same.tangent_W).norm() <= 1e-13);
  RC_ASSERT((there.curvature_W - same.curvature_W).norm() <= 1e-12);
}

// two legs of 10 m at a right angle, R = 0.5 m: each leg loses R tan(45 deg) = 0.5 m, the arc is R pi/2
TEST(RoundCorners, ARightAngleCostsTwoRadiiAndGainsAQuarterCircle) {
  const auto pieces = RoundCorners({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}}, 0.5);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_DOUBLE_EQ(pieces[0].length_m, 9.5);
  EXPECT_DOUBLE_EQ(pieces[1].length_m, 0.5 * kPi / 2);
  EXPECT_DOUBLE_EQ(pieces[2].length_m, 9.5);
  EXPECT_NEAR(pieces[2].s_end_m(), 19 + 0.25 * kPi, 1e-14);
  const CentrelinePoint middle = EvalCentreline(pieces[1], pieces[1].s_begin_m + 0.125 * kPi);
  const double r = 0.5 / std::numbers::sqrt2;
  EXPECT_NEAR((middle.p_W - Vector3d(9.5 + r, 0.5 - r, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((middle.curvature_W - Vector3d(-std::numbers::sqrt2, std::numbers::sqrt2, 0)).norm(), 0, 1e-14);
}

// a bend of 60 degrees in a vertical plane: tangent length R tan(30 deg) = R/sqrt(3), arc R pi/3
TEST(RoundCorners, AClimbingBendHasTheLengthOfItsAngle) {
  const double c = 0.5, s = std::sqrt(0.75);
  const auto pieces = RoundCorners({{0, 0, 0}, {5, 0, 0}, {5 + 5 * c, 0, 5 * s}}, 1.2);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_NEAR(pieces[0].length_m, 5 - 1.2 / std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(pieces[1].length_m, 1.2 * kPi / 3, 1e-14);
}

RC_GTEST_PROP(RoundCorners, PiecesJoinInPositionTangentAndDistance, ()) {
  std::vector<Vector3d> vertices{Vector3d::Zero()};
  Vector3d direction = any::UnitVector();
  for (int i = 0; i < 4; ++i) {
    vertices.push_back(vertices.back() + any::Between(4, 10) * direction);
    direction = (direction + 0.9 * any::UnitVector()).normalized();  // turns by less than 65 degrees
  }
  const auto pieces = RoundCorners(vertices, 1.5);
  RC_ASSERT((pieces.front().p_begin_W - vertices.front()).norm() <= 1e-14);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const CentrelinePoint end = EvalCentreline(pieces[i - 1], pieces[i - 1].s_end_m());
    RC_ASSERT(pieces[i].s_begin_m == pieces[i - 1].s_end_m());
    RC_ASSERT((end.p_W - pieces[i].p_begin_W).norm() <= 1e-12);
    RC_ASSERT((end.tangent_W - pieces[i].tangent_begin_W).norm() <= 1e-12);
  }
  RC_ASSERT((EvalCentreline(pieces.back(), pieces.back().s_end_m()).p_W - vertices.back()).norm() <= 1e-12);
}

TEST(RoundCorners, AVertexOnAStraightIsNoCorner) {
  const auto pieces = RoundCorners({{0, 0, 0}, {4, 0, 0}, {10, 0, 0}}, 0.5);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_TRUE(pieces[0].straight() && pieces[1].straight());
  EXPECT_DOUBLE_EQ(pieces[1].s_end_m(), 10);
}

TEST(RoundCorners, ArcsMayMeetEndToEnd) {
  const auto pieces = RoundCorners({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {4, 2, 0}}, 1);
  ASSERT_EQ(pieces.size(), 4u);  // straight, arc, arc, straight
  EXPECT_NEAR(pieces.back().s_end_m(), 2 + kPi, 1e-12);
}

std::string RefusalOf(const std::vector<Vector3d>& vertices, double radius_m) {
  try {
    RoundCorners(vertices, radius_m);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(RoundCorners, ABendThatDoesNotFitNamesTheCornerAndTheLargestRadius) {
  const std::string text = RefusalOf({{0, 0, 0}, {10, 0, 0}, {10, 2, 0}, {20, 2, 0}}, 1.5);
  EXPECT_NE(text.find("radius 1.5 m does not fit at corner 2 at [10, 2, 0]"), std::string::npos) << text;
  EXPECT_NE(text.find("2 m long; the largest radius that fits there is 1 m"), std::string::npos) << text;
}

TEST(RoundCorners, CoincidingVerticesAndHairpinsAreRefused) {
  EXPECT_NE(RefusalOf({{0, 0, 0}, {0, 0, 0}}, 1).find("coincide (corner 1"), std::string::npos);
  EXPECT_NE(RefusalOf({{0, 0, 0}, {5, 0, 0}, {1, 0, 0}}, 1).find("turns back on itself at corner 1"),
            std::string::npos);
  EXPECT_NE(RefusalOf({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, 0).find("it must be > 0"), std::string::npos);
  EXPECT_NE(RefusalOf({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}}, std::nan("")).find("it must be > 0"),
            std::string::npos);
}

TEST(RoundCornersDeathTest, APointIsNoPolyline) {
  EXPECT_DEATH(RoundCorners({{0, 0, 0}}, 1), "two vertices");
}

}  // namespace
}  // namespace piperun
