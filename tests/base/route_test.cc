#include "base/route.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>
#include <string>

#include "base/check.h"
#include "tests/support/any.h"

namespace piperun {
namespace {

constexpr double kPi = std::numbers::pi;

PipeSpec MakePipe(const std::string& id, const std::string& from, const std::string& to) {
  PipeSpec pipe;
  pipe.id = id;
  pipe.from = from;
  pipe.to = to;
  pipe.diameter_m = 0.15;
  pipe.wall_thickness_m = 0.0075;
  return pipe;
}

/// A -P1-> B <-P2- C -P3-> D along x, P2 drawn against the way and bent by 90 degrees; D-E leads on, and Q is
/// a shortcut's stub at B. Lengths: P1 4 m; P2 5 + 6 - 2 + pi/2 m; P3 3 m.
Network MakeNetwork() {
  std::vector<NodeSpec> nodes{{"A", {0, 0, 0}},       {"B", {4, 0, 0}},  {"C", {9, 6, 0}},
                              {"D", {9, 9, 0}},       {"Q", {4, -7, 0}}, {"island1", {50, 0, 0}},
                              {"island2", {60, 0, 0}}};
  PipeSpec bent = MakePipe("P2", "C", "B");
  bent.vertices_m = {{9, 0, 0}};
  bent.bend_radius_m = 1;
  return Network(std::move(nodes), {MakePipe("P1", "A", "B"), bent, MakePipe("P3", "C", "D"),
                                    MakePipe("P4", "B", "Q"), MakePipe("far", "island1", "island2")});
}

constexpr double kLength2_m = 9 + kPi / 2;

Route MakeRoute(const Network& network) {
  return FindRoute(network, *network.FindNode("A"), *network.FindNode("D"));
}

TEST(FindRoute, WalksThePipesInOrderAndKnowsWhichAreReversed) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  ASSERT_EQ(route.legs().size(), 3u);
  EXPECT_EQ(network.pipe(route.legs()[0].pipe).id, "P1");
  EXPECT_EQ(network.pipe(route.legs()[1].pipe).id, "P2");
  EXPECT_EQ(network.pipe(route.legs()[2].pipe).id, "P3");
  EXPECT_FALSE(route.legs()[0].reversed);
  EXPECT_TRUE(route.legs()[1].reversed);
  EXPECT_FALSE(route.legs()[2].reversed);
  EXPECT_NEAR(route.length_m(), 4 + kLength2_m + 3, 1e-13);
}

TEST(FindRoute, TakesTheFewestPipes) {
  // straight on in three pipes of 1 m, or one pipe of 9 m beside it
  PipeSpec detour = MakePipe("detour", "A", "D");
  detour.vertices_m = {{0, 3, 0}, {3, 3, 0}};
  detour.bend_radius_m = 0.5;
  const Network network(
      {{"A", {0, 0, 0}}, {"B", {1, 0, 0}}, {"C", {2, 0, 0}}, {"D", {3, 0, 0}}},
      {MakePipe("P1", "A", "B"), MakePipe("P2", "B", "C"), MakePipe("P3", "C", "D"), detour});
  const Route route = FindRoute(network, 0, 3);
  ASSERT_EQ(route.legs().size(), 1u);
  EXPECT_EQ(network.pipe(route.legs()[0].pipe).id, "detour");
}

TEST(FindRoute, NoWayAndNoDistanceAreRefused) {
  const Network network = MakeNetwork();
  for (const char* retrieve : {"island1", "A"}) {
    try {
      FindRoute(network, *network.FindNode("A"), *network.FindNode(retrieve));
      FAIL() << retrieve;
    } catch (const InputError& e) {
      EXPECT_EQ(e.key_path(), "mission.retrieve");
    }
  }
}

TEST(Route, ChainageZeroIsTheLaunchNodeAndTheLengthTheRetrieveNode) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  EXPECT_NEAR((route.Eval(0).p_W - Vector3d(0, 0, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((route.Eval(route.length_m()).p_W - Vector3d(9, 9, 0)).norm(), 0, 1e-13);
  EXPECT_NEAR((route.Eval(0).tangent_W - Vector3d::UnitX()).norm(), 0, 1e-14);
  EXPECT_NEAR((route.Eval(route.length_m()).tangent_W - Vector3d::UnitY()).norm(), 0, 1e-14);
}

// 1 m into P2 along the way is 1 m before its `to` end
TEST(Route, LocatesOnAReversedPipeFromItsOwnFromNode) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  const PipePosition at = route.Locate(5);
  EXPECT_EQ(network.pipe(at.pipe).id, "P2");
  EXPECT_NEAR(at.s_m, kLength2_m - 1, 1e-13);
  EXPECT_NEAR(*route.Chainage(at.pipe, kLength2_m - 1), 5, 1e-13);
  EXPECT_NEAR(*route.Chainage(*network.FindPipe("P3"), 0.5), 4 + kLength2_m + 0.5, 1e-13);
}

TEST(Route, OffTheRouteThereIsNoChainage) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  EXPECT_FALSE(route.Chainage(*network.FindPipe("P4"), 1).has_value());
  EXPECT_FALSE(route.Chainage(*network.FindPipe("P1"), 4.1).has_value());
  EXPECT_FALSE(route.Chainage(*network.FindPipe("P1"), -0.1).has_value());
}

RC_GTEST_PROP(Route, LocateChainageAndEvalAgreeEverywhere, ()) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  const double chainage_m = route.length_m() * any::Between(0, 1);
  const PipePosition at = route.Locate(chainage_m);
  RC_ASSERT(std::abs(*route.Chainage(at.pipe, at.s_m) - chainage_m) <= 1e-12);
  // the pipe's own centreline, not the route's copy, says the same place
  for (const CentrelinePiece& piece : network.pipe(at.pipe).centreline) {
    if (at.s_m < piece.s_begin_m || at.s_m > piece.s_end_m()) continue;
    RC_ASSERT((EvalCentreline(piece, at.s_m).p_W - route.Eval(chainage_m).p_W).norm() <= 1e-12);
  }
}

RC_GTEST_PROP(Route, TheHintOnlyChangesTheTimeToFindAPiece, ()) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  const double chainage_m = any::Between(-30, 30);
  const auto hint = any::Integer<std::size_t>(0, 20);
  RC_ASSERT(route.FindPiece(chainage_m, hint) == route.FindPiece(chainage_m));
}

TEST(Route, PiecesFollowEachOtherWithoutAStep) {
  const Network network = MakeNetwork();
  const Route route = MakeRoute(network);
  for (std::size_t i = 1; i < route.pieces().size(); ++i) {
    const CentrelinePiece &a = route.pieces()[i - 1].line, &b = route.pieces()[i].line;
    const CentrelinePoint end = EvalCentreline(a, a.s_end_m());
    EXPECT_EQ(a.s_end_m(), b.s_begin_m);
    EXPECT_NEAR((end.p_W - b.p_begin_W).norm(), 0, 1e-12);
    EXPECT_NEAR((end.tangent_W - b.tangent_begin_W).norm(), 0, 1e-12);
  }
}

std::string RefusalOf(const Network& network, std::vector<RouteLeg> legs) {
  try {
    const Route route(network, std::move(legs));
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Route, PipesThatDoNotMeetAreRefused) {
  const std::string text = RefusalOf(MakeNetwork(), {{0, false}, {2, false}});
  EXPECT_NE(text.find("pipes 'P1' and 'P3' do not meet"), std::string::npos) << text;
}

// P4 leaves P1 at a right angle at B, 4 m from A
TEST(Route, TurnsASharpCornerWhereItsPipesDo) {
  const Network network = MakeNetwork();
  const Route route(network, {{0, false}, {3, false}});
  EXPECT_EQ(route.length_m(), 11);
  EXPECT_NEAR((route.Eval(3.999).p_W - Vector3d(3.999, 0, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((route.Eval(4.5).p_W - Vector3d(4, -0.5, 0)).norm(), 0, 1e-14);
  EXPECT_EQ(route.Eval(3.999).tangent_W, Vector3d::UnitX());
  EXPECT_EQ(route.Eval(4).tangent_W, Vector3d(-Vector3d::UnitY()));
}

/// Along x: P1 of bore 0.15 m from A to B at 5 m, P2 of 0.25 m from C at 9 m back to B, P3 of 0.15 m on to D.
Network MakeNetworkOfTwoBores() {
  PipeSpec wide = MakePipe("P2", "C", "B");
  wide.diameter_m = 0.25;
  return Network({{"A", {0, 0, 0}}, {"B", {5, 0, 0}}, {"C", {9, 0, 0}}, {"D", {20, 0, 0}}},
                 {MakePipe("P1", "A", "B"), wide, MakePipe("P3", "C", "D")});
}

// cones of 2 (0.25 - 0.15) = 0.2 m lie in the narrow pipes; the radius changes by 1 in 4
TEST(Route, KnowsTheBoreThroughReducers) {
  const Network network = MakeNetworkOfTwoBores();
  const auto radius_at = [](const Route& route, double chainage_m) { return route.RadiusAt_m(chainage_m); };
  const Route route(network, {{0, false}, {1, true}, {2, false}});
  EXPECT_EQ(route.pieces().size(), 5u);
  for (const auto& [chainage_m, radius_m] : {std::pair{0.0, 0.075},
                                             {4.8, 0.075},
                                             {4.9, 0.1},
                                             {4.999999, 0.12499975},
                                             {5.0, 0.125},
                                             {7.0, 0.125},
                                             {9.0, 0.125},
                                             {9.1, 0.1},
                                             {9.2, 0.075},
                                             {15.0, 0.075}}) {
    EXPECT_NEAR(radius_at(route, chainage_m), radius_m, 1e-14) << chainage_m;
    const PipePosition at = route.Locate(chainage_m);
    EXPECT_NEAR(network.pipe(at.pipe).RadiusAt_m(at.s_m), radius_m, 1e-14) << chainage_m;
  }
  // and the same way back
  const Route back(network, {{2, true}, {1, false}, {0, true}});
  for (const double chainage_m : {1.0, 4.85, 4.95, 6.0, 9.05, 9.15, 12.0}) {
    EXPECT_NEAR(radius_at(back, 20 - chainage_m), radius_at(route, chainage_m), 1e-14) << chainage_m;
  }
}

TEST(Route, LocatesInConesAsItDoesElsewhere) {
  const Network network = MakeNetworkOfTwoBores();
  const Route route(network, {{0, false}, {1, true}, {2, false}});
  for (const double chainage_m : {4.7, 4.9, 5.5, 9.1, 9.3}) {
    const PipePosition at = route.Locate(chainage_m);
    EXPECT_NEAR(*route.Chainage(at.pipe, at.s_m), chainage_m, 1e-13);
    EXPECT_NEAR((route.Eval(chainage_m).p_W - Vector3d(chainage_m, 0, 0)).norm(), 0, 1e-13);
  }
}

// drawn as a square of 10 m, stated 10, 12, 10, 10 m: the way goes east 10, north 12, west 10, south 10
TEST(Route, ShiftsEveryLegToWhereTheOneBeforeEnded) {
  std::vector<PipeSpec> pipes{MakePipe("east", "A", "B"), MakePipe("north", "C", "B"),
                              MakePipe("west", "C", "D"), MakePipe("south", "D", "A")};
  for (PipeSpec& pipe : pipes) pipe.length_m = 10;
  pipes[1].length_m = 12;
  const Network network({{"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {10, 10, 0}}, {"D", {0, 10, 0}}}, pipes);
  const Route route(network, {{0, false}, {1, true}, {2, false}, {3, false}});
  EXPECT_NEAR(route.length_m(), 42, 1e-13);
  EXPECT_NEAR((route.Eval(22 - 1e-9).p_W - Vector3d(10, 12, 0)).norm(), 0, 1e-8);
  EXPECT_NEAR((route.Eval(32).p_W - Vector3d(0, 12, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((route.Eval(42).p_W - Vector3d(0, 2, 0)).norm(), 0, 1e-12);
}

TEST(MakeLegs, TurnsEveryPipeTheWayItIsWalked) {
  const Network network = MakeNetworkOfTwoBores();
  const auto legs = MakeLegs(network, *network.FindNode("D"), {2, 1, 0});
  ASSERT_EQ(legs.size(), 3u);
  EXPECT_TRUE(legs[0].reversed);
  EXPECT_FALSE(legs[1].reversed);
  EXPECT_TRUE(legs[2].reversed);
}

TEST(MakeLegs, PipesThatDoNotLeadOnAreRefused) {
  try {
    MakeLegs(MakeNetwork(), 0, {0, 2});
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(e.problem().find("pipe 'P3' does not lead on from node 'B'"), std::string::npos) << e.what();
  }
}

/// A square A, B, C, D; the short way from A to C leads through B.
std::vector<PipeSpec> MakeSquare() {
  return {MakePipe("AB", "A", "B"), MakePipe("BC", "B", "C"), MakePipe("AE", "A", "E"),
          MakePipe("ED", "E", "D"), MakePipe("DC", "D", "C")};
}
const std::vector<NodeSpec> kSquare{
    {"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {10, 10, 0}}, {"D", {0, 10, 0}}, {"E", {0, 5, 0}}};

TEST(FindRoute, GoesRoundWhatABallCannotPass) {
  std::vector<PipeSpec> pipes = MakeSquare();
  EXPECT_EQ(FindRoute(Network(kSquare, pipes), 0, 2).legs().size(), 2u);
  pipes[1].passable = false;
  EXPECT_EQ(FindRoute(Network(kSquare, pipes), 0, 2).legs().size(), 3u);
  pipes[4].passable = false;
  EXPECT_THROW(FindRoute(Network(kSquare, pipes), 0, 2), InputError);
}

TEST(FindRoute, EndsAtOpenWaterAndDoesNotPassIt) {
  std::vector<NodeSpec> nodes = kSquare;
  nodes[1].open_water = true;
  const Network network(nodes, MakeSquare());
  EXPECT_EQ(FindRoute(network, 0, 1).legs().size(), 1u);
  EXPECT_EQ(FindRoute(network, 0, 2).legs().size(), 3u);
  EXPECT_EQ(FindRoute(network, 1, 2).legs().size(), 1u);
}

TEST(RouteDeathTest, WithoutPipesItAborts) { EXPECT_DEATH(Route(MakeNetwork(), {}), "at least one pipe"); }

}  // namespace
}  // namespace piperun
