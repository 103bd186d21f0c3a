#include "estimator/invert_track.h"

#include <gtest/gtest.h>

#include <cmath>

namespace piperun::estimator {
namespace {

constexpr double kBall_m = 0.03;

PipeSpec MakePipe(const std::string& id, const std::string& from, const std::string& to, double diameter_m) {
  PipeSpec pipe;
  pipe.id = id;
  pipe.from = from;
  pipe.to = to;
  pipe.diameter_m = diameter_m;
  pipe.wall_thickness_m = 0.01;
  return pipe;
}

/// 10 m east at a bore of 0.15 m, 10 m on at 0.25 m, then a sharp corner and 10 m north at 0.25 m. The
/// reducer is the last 0.2 m of the first pipe.
RouteMap MakeMap() {
  const Network network(
      {{"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {20, 0, 0}}, {"D", {20, 10, 0}}},
      {MakePipe("P1", "A", "B", 0.15), MakePipe("P2", "B", "C", 0.25), MakePipe("P3", "C", "D", 0.25)});
  Route route = FindRoute(network, 0, 3);
  return {network, std::move(route)};
}

TEST(InvertTrack, TheBallSinksThroughAReducerWithItsInvert) {
  const RouteMap map = MakeMap();
  InvertTrack track(map, kBall_m);
  EXPECT_NEAR(track.Eval(5).p_W.z(), -(0.075 - kBall_m), 1e-15);
  EXPECT_NEAR(track.Eval(9.9).p_W.z(), -(0.1 - kBall_m), 1e-14);
  EXPECT_NEAR(track.Eval(15).p_W.z(), -(0.125 - kBall_m), 1e-15);
}

// the path of the centre against its own difference quotient, and by hand: sqrt(1 + 1/16)
TEST(InvertTrack, InAReducerTheCentreTravelsAlongItsSlope) {
  const RouteMap map = MakeMap();
  InvertTrack track(map, kBall_m);
  const double h = 1e-5;
  const double path_m = (track.Eval(9.9 + h).p_W - track.Eval(9.9 - h).p_W).norm();
  EXPECT_NEAR(track.Eval(9.9).stretch, path_m / (2 * h), 1e-9);
  EXPECT_NEAR(track.Eval(9.9).stretch, std::sqrt(17.0) / 4, 1e-14);
  EXPECT_EQ(track.Eval(5).stretch, 1);
}

TEST(InvertTrack, TurnsASharpCornerAtOnce) {
  const RouteMap map = MakeMap();
  InvertTrack track(map, kBall_m);
  const InvertPoint before = track.Eval(20 - 1e-9), after = track.Eval(20 + 1e-9);
  EXPECT_NEAR((before.p_W - after.p_W).norm(), 0, 1e-8);
  EXPECT_EQ(before.tangent_W, Vector3d::UnitX());
  EXPECT_NEAR((after.tangent_W - Vector3d::UnitY()).norm(), 0, 1e-15);
}

TEST(InvertTrack, NothingIsStraightAroundASharpCorner) {
  const RouteMap map = MakeMap();
  InvertTrack track(map, kBall_m);
  EXPECT_TRUE(track.StraightAround(18.9, 1));
  EXPECT_FALSE(track.StraightAround(19.5, 1));
  EXPECT_FALSE(track.StraightAround(20.9, 1));
  EXPECT_TRUE(track.StraightAround(21.1, 1));
  EXPECT_TRUE(track.StraightAround(10, 1));  // a reducer runs straight on
}

// a bend shorter than the margin, well inside it
TEST(InvertTrack, NothingIsStraightAroundAShortBend) {
  PipeSpec pipe = MakePipe("P", "A", "B", 0.15);
  pipe.vertices_m = {{10, 0, 0}};
  pipe.bend_radius_m = 0.2;
  const Network network({{"A", {0, 0, 0}}, {"B", {20, 5, 0}}}, {pipe});
  Route route = FindRoute(network, 0, 1);
  const RouteMap map{network, std::move(route)};
  InvertTrack track(map, kBall_m);
  EXPECT_FALSE(track.StraightAround(9.5, 1));
  EXPECT_TRUE(track.StraightAround(8, 1));
}

TEST(InvertTrack, NearASharpCornerTheCourseSaysWhichWay) {
  const RouteMap map = MakeMap();
  const InvertTrack track(map, kBall_m);
  EXPECT_NEAR((track.FindTangent(19.9, 0.3, Vector3d::UnitY()) - Vector3d::UnitY()).norm(), 0, 1e-15);
  EXPECT_NEAR((track.FindTangent(19.9, 0.3, Vector3d::UnitX()) - Vector3d::UnitX()).norm(), 0, 1e-15);
  EXPECT_NEAR((track.FindTangent(19.9, 0.05, Vector3d::UnitY()) - Vector3d::UnitX()).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace piperun::estimator
