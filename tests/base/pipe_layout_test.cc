#include "base/pipe_layout.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>
#include <string>

#include "base/bend_fit.h"
#include "base/check.h"
#include "tests/support/any.h"

namespace piperun {
namespace {

constexpr double kPi = std::numbers::pi;
const double kHalf = std::sqrt(0.5);

PipeSpec MakePipe(const std::string& id, const std::string& from, const std::string& to,
                  double diameter_m = 0.2) {
  PipeSpec pipe;
  pipe.id = id;
  pipe.from = from;
  pipe.to = to;
  pipe.diameter_m = diameter_m;
  pipe.wall_thickness_m = 0.01;
  return pipe;
}

/// A at the origin, B 10 m to the east, C 10 m to the north of it.
struct Elbow {
  std::vector<NodeSpec> nodes{{"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {10, 10, 0}}};
  std::vector<PipeSpec> pipes{MakePipe("P1", "A", "B"), MakePipe("P2", "B", "C")};

  explicit Elbow(double bend_radius_m = 0, bool fit_bends = false) {
    for (PipeSpec& pipe : pipes) {
      pipe.bend_radius_m = bend_radius_m;
      pipe.fit_bends = fit_bends;
    }
  }
  Network Build() const { return Network(nodes, pipes); }
};

void ExpectAt(const Vector3d& p, const Vector3d& expected) {
  EXPECT_NEAR((p - expected).norm(), 0, 1e-12) << p.transpose();
}

std::string RefusalOf(const Elbow& elbow, const std::string& key) {
  try {
    elbow.Build();
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), key);
    return e.problem();
  }
  return "accepted";
}

// each straight loses R tan(45 deg) = 0.5 m, each pipe gains half of a quarter circle, R pi/4
TEST(JointBend, GivesEachPipeHalfOfTheArc) {
  const Network network = Elbow(0.5).Build();
  const Vector3d middle = Vector3d(9.5, 0.5, 0) + 0.5 * Vector3d(kHalf, -kHalf, 0);
  for (const Pipe& pipe : network.pipes()) EXPECT_NEAR(pipe.length_m, 9.5 + 0.125 * kPi, 1e-12);
  const Pipe &p1 = network.pipe(0), &p2 = network.pipe(1);
  ExpectAt(p1.Eval(p1.length_m).p_W, middle);
  ExpectAt(p2.Eval(0).p_W, middle);
  ExpectAt(p1.Inward(true), {-kHalf, -kHalf, 0});
  ExpectAt(p2.Inward(false), {kHalf, kHalf, 0});
  ExpectAt(p1.Eval(0).p_W, {0, 0, 0});
  ExpectAt(p2.Eval(p2.length_m).p_W, {10, 10, 0});
}

TEST(JointBend, IsTheSameWhicheverWayThePipesAreDrawn) {
  for (const bool swap1 : {false, true}) {
    for (const bool swap2 : {false, true}) {
      Elbow elbow(0.5);
      if (swap1) std::swap(elbow.pipes[0].from, elbow.pipes[0].to);
      if (swap2) std::swap(elbow.pipes[1].from, elbow.pipes[1].to);
      const Network network = elbow.Build();
      const PipeEnd end1{0, !swap1}, end2{1, swap2};
      const Pipe &p1 = network.pipe(0), &p2 = network.pipe(1);
      EXPECT_NEAR(p1.length_m, 9.5 + 0.125 * kPi, 1e-12);
      EXPECT_NEAR(p2.length_m, 9.5 + 0.125 * kPi, 1e-12);
      ExpectAt(p1.Inward(end1.at_to), {-kHalf, -kHalf, 0});
      ExpectAt(p2.Inward(end2.at_to), {kHalf, kHalf, 0});
      ExpectAt(p1.Eval(p1.EndS_m(end1.at_to)).p_W, p2.Eval(p2.EndS_m(end2.at_to)).p_W);
      ExpectAt(p2.Eval(p2.EndS_m(!end2.at_to)).p_W, {10, 10, 0});
    }
  }
}

TEST(JointBend, TakesTheGreaterRadius) {
  Elbow elbow(0.5);
  elbow.pipes[1].bend_radius_m = 2;
  EXPECT_NEAR(elbow.Build().pipe(0).length_m, 8 + 0.5 * kPi, 1e-12);
}

TEST(JointBend, WithoutARadiusOnBothSidesTheCornerStaysSharp) {
  Elbow elbow(0.5);
  elbow.pipes[1].bend_radius_m = 0;
  const Network network = elbow.Build();
  EXPECT_EQ(network.pipe(0).length_m, 10);
  ExpectAt(network.pipe(0).Eval(10).p_W, {10, 0, 0});
  ExpectAt(network.pipe(1).Inward(false), {0, 1, 0});
}

TEST(JointBend, WhereThreePipesMeetAllEndStraight) {
  Elbow elbow(0.5);
  elbow.nodes.push_back({"D", {20, 0, 0}});
  elbow.pipes.push_back(MakePipe("P3", "B", "D"));
  elbow.pipes.back().bend_radius_m = 0.5;
  const Network network = elbow.Build();
  for (const Pipe& pipe : network.pipes()) EXPECT_EQ(pipe.length_m, 10);
}

// the wider pipe has the elbow, 10 - R + R pi/2; the narrower begins R behind it, with a taper of 1 in 4
TEST(JointBend, BetweenDifferentBoresLiesInTheWiderPipeAndTheReducerBehindIt) {
  for (const bool wide_first : {false, true}) {
    Elbow elbow(0.5);
    elbow.pipes[0].diameter_m = wide_first ? 0.3 : 0.2;
    elbow.pipes[1].diameter_m = wide_first ? 0.2 : 0.3;
    const Network network = elbow.Build();
    const Pipe &wide = network.pipe(wide_first ? 0 : 1), &narrow = network.pipe(wide_first ? 1 : 0);
    const Cone cone = wide_first ? narrow.cone_from : narrow.cone_to;
    EXPECT_NEAR(wide.length_m, 9.5 + 0.25 * kPi, 1e-12);
    EXPECT_NEAR(narrow.length_m, 9.5, 1e-12);
    ExpectAt(wide.Eval(wide.EndS_m(wide_first)).p_W, narrow.Eval(narrow.EndS_m(!wide_first)).p_W);
    ExpectAt(wide.Inward(wide_first), -narrow.Inward(!wide_first));
    EXPECT_DOUBLE_EQ(cone.length_m, 0.2);
    EXPECT_EQ(cone.end_radius_m, 0.15);
    EXPECT_EQ(wide.cone_from.length_m + wide.cone_to.length_m, 0);
    EXPECT_DOUBLE_EQ(narrow.RadiusAt_m(wide_first ? 0.1 : narrow.length_m - 0.1), 0.125);
  }
}

RC_GTEST_PROP(JointBend, IsTangentAtAnyAngleInSpace, ()) {
  Elbow elbow(any::Between(0.3, 2));
  elbow.nodes[0].position_m = 1e4 * any::UnitVector();
  const Vector3d t_in = any::UnitVector();
  const Vector3d t_out = (t_in + any::Between(0.01, 1.2) * any::UnitVector()).normalized();
  elbow.nodes[1].position_m = elbow.nodes[0].position_m + any::Between(20, 50) * t_in;
  elbow.nodes[2].position_m = elbow.nodes[1].position_m + any::Between(20, 50) * t_out;
  if (any::Integer(0, 1) == 0) elbow.pipes[0].diameter_m = 0.3;
  if (any::Integer(0, 1) == 0) {
    for (PipeSpec& pipe : elbow.pipes) pipe.length_m = any::Between(51, 80);
  }
  const Network network = elbow.Build();
  const Pipe &p1 = network.pipe(0), &p2 = network.pipe(1);
  RC_ASSERT((p1.Inward(true) + p2.Inward(false)).norm() <= 1e-12);
  for (const PipeSpec& spec : elbow.pipes) {
    if (spec.length_m == 0) {
      // as drawn, the pipes end at the same place; 1e4 m from the origin a coordinate has 2e-12 m
      RC_ASSERT((p1.Eval(p1.length_m).p_W - p2.Eval(0).p_W).norm() <= 1e-10);
    } else {
      const Pipe& pipe = network.pipe(&spec == &elbow.pipes[0] ? 0 : 1);
      RC_ASSERT(std::abs(pipe.length_m / spec.length_m - 1) <= 1e-14);
    }
  }
}

TEST(JointBend, ThatDoesNotFitIsRefusedWithCornerAndRadius) {
  const std::string text = RefusalOf(Elbow(12), "network.pipes[0]");
  EXPECT_NE(text.find("radius 12 m does not fit at corner 1 at [10, 0, 0]"), std::string::npos) << text;
  EXPECT_NE(text.find("the largest radius that fits there is 10 m"), std::string::npos) << text;
}

// the pipe keeps its length to the last bits, and its straights their directions
TEST(StatedLength, HoldsThroughBendsWithDirectionsUnchanged) {
  Elbow elbow(0.5);
  elbow.pipes = {elbow.pipes[0]};
  elbow.pipes[0].to = "C";
  elbow.pipes[0].vertices_m = {{10, 0, 0}};
  elbow.pipes[0].length_m = 37;
  const Pipe pipe = elbow.Build().pipe(0);
  ASSERT_EQ(pipe.centreline.size(), 3u);
  EXPECT_NEAR(pipe.length_m, 37, 1e-13);
  EXPECT_DOUBLE_EQ(pipe.centreline[1].length_m, 0.25 * kPi);
  // both straights are as long as each other, as drawn
  EXPECT_NEAR(pipe.centreline[0].length_m, (37 - 0.25 * kPi) / 2, 1e-12);
  EXPECT_NEAR(pipe.centreline[2].length_m, (37 - 0.25 * kPi) / 2, 1e-12);
  EXPECT_EQ(pipe.centreline[0].tangent_begin_W, Vector3d::UnitX());
  ExpectAt(pipe.centreline[2].tangent_begin_W, Vector3d::UnitY());
}

TEST(StatedLength, BelowTheRiseIsRefused) {
  Elbow elbow;
  elbow.nodes[2].position_m.z() = 30;
  elbow.pipes[1].length_m = 29;
  EXPECT_NE(RefusalOf(elbow, "network.pipes[1].length_m").find("shorter than the rise of 30 m"),
            std::string::npos);
}

TEST(StatedLength, ThatItsBendsUseUpIsRefused) {
  Elbow elbow(9.9);
  for (PipeSpec& pipe : elbow.pipes) pipe.length_m = 10;
  elbow.pipes[0].diameter_m = 0.3;  // has the whole quarter circle, 15.6 m
  EXPECT_NE(RefusalOf(elbow, "network.pipes[0]").find("leave no straight"), std::string::npos);
}

TEST(Cone, IsCutToHalfOfItsStraight) {
  Elbow elbow;
  elbow.nodes[2].position_m = {10.3, 0, 0};
  elbow.pipes[0].diameter_m = 0.4;
  const Network network = elbow.Build();
  EXPECT_NEAR(network.pipe(1).cone_from.length_m, 0.15, 1e-14);
  EXPECT_EQ(network.pipe(1).cone_from.end_radius_m, 0.2);
  EXPECT_EQ(network.pipe(1).cone_to.length_m, 0);
}

TEST(Cone, IsNotWhereABoreChangesAtASharpCorner) {
  Elbow elbow;
  elbow.pipes[0].diameter_m = 0.4;
  const Network network = elbow.Build();
  for (const Pipe& pipe : network.pipes()) EXPECT_EQ(pipe.cone_from.length_m + pipe.cone_to.length_m, 0);
}

/// One pipe A -> (x, 0) -> C with a right angle at its vertex; the first straight is x long.
Pipe LayCorner(double x_m, bool fit_bends, int pipes_at_a = 1) {
  Elbow elbow(1, fit_bends);
  elbow.pipes = {elbow.pipes[0]};
  elbow.pipes[0].to = "C";
  elbow.pipes[0].vertices_m = {{x_m, 0, 0}};
  elbow.nodes[2].position_m = {x_m, 10, 0};
  for (int i = 1; i < pipes_at_a; ++i) {
    const std::string id = "Q" + std::to_string(i);
    elbow.nodes.push_back({id, {-5, 5.0 * i, 0}});
    elbow.pipes.push_back(MakePipe(id, "A", id));
  }
  return elbow.Build().pipe(0);
}

double FirstBend_m(const Pipe& pipe) {
  for (const CentrelinePiece& piece : pipe.centreline) {
    if (!piece.straight()) return 1 / piece.curvature_1_m;
  }
  return 0;
}

TEST(FitBends, KeepsABendThatFits) { EXPECT_DOUBLE_EQ(FirstBend_m(LayCorner(5, true)), 1); }

// nine tenths of the straight of 0.5 m
TEST(FitBends, MakesABendAsTightAsItsStraightNeeds) {
  EXPECT_NEAR(FirstBend_m(LayCorner(0.5, true)), 0.45, 1e-12);
}

// 0.09 m is below 0.6 D = 0.12 m: the vertex goes, the line is straight
TEST(FitBends, LeavesAVertexOutWhereNoBendFits) {
  const Pipe pipe = LayCorner(0.1, true);
  ASSERT_EQ(pipe.centreline.size(), 1u);
  EXPECT_NEAR(pipe.length_m, std::hypot(0.1, 10), 1e-12);
}

TEST(FitBends, WithoutItNothingIsTightened) { EXPECT_THROW(LayCorner(0.5, false), InputError); }

// at a junction 1.5 D = 0.3 m stay straight, which leaves 0.7 m of 1 m
TEST(FitBends, KeepsTheEndAtAJunctionStraight) {
  const Pipe pipe = LayCorner(1, true, 3);
  EXPECT_NEAR(FirstBend_m(pipe), 0.7, 1e-12);
  EXPECT_NEAR(pipe.centreline.front().length_m, 0.3, 1e-12);
}

TEST(FitBends, LeavesAMitreBetweenPipesWhereNoBendFits) {
  Elbow elbow(1, true);
  elbow.nodes[2].position_m = {10, 0.1, 0};
  const Network network = elbow.Build();
  EXPECT_EQ(network.pipe(0).length_m, 10);
  EXPECT_NEAR(network.pipe(1).length_m, 0.1, 1e-15);
  ExpectAt(network.pipe(1).Inward(false), {0, 1, 0});
}

TEST(FitBends, LeavesARepeatedVertexOut) {
  Elbow elbow(1, true);
  elbow.pipes[0].vertices_m = {{0, 0, 0}, {5, 0, 0}, {5, 0, 0}, {10, 0, 0}};
  EXPECT_NEAR(elbow.Build().pipe(0).length_m, 9 + 0.25 * kPi, 1e-12);
}

// a spur there and back cannot be bent; the line goes on without it
TEST(FitBends, LeavesASpurOut) {
  Elbow elbow(0.5, true);
  elbow.pipes[0].vertices_m = {{5, 0, 0}, {5, 3, 0}, {5, 0, 0}};
  elbow.pipes[0].length_m = 10;
  EXPECT_NEAR(elbow.Build().pipe(0).length_m, 10, 1e-13);
}

TEST(FittingRadii, WhatOneBendDoesNotNeedGoesToTheOther) {
  // a straight of 1 m (0.9 m for bends) between two bends with plenty of room on their far sides
  const auto radii_of = [](double wanted1_m, double wanted2_m) {
    const std::vector<BendStraight> straights{{100, {-1, 0}}, {1, {0, 1}}, {100, {1, -1}}};
    return CalcFittingRadii(straights, {{wanted1_m, true, {{{0, 1, 1}, {1, 0, 1}}}},
                                        {wanted2_m, true, {{{1, 1, 1}, {2, 0, 1}}}}});
  };
  EXPECT_EQ(radii_of(0.2, 0.3), (std::vector<double>{0.2, 0.3}));
  EXPECT_EQ(radii_of(2, 3), (std::vector<double>{0.45, 0.45}));
  EXPECT_NEAR(radii_of(0.2, 3)[1], 0.7, 1e-15);
  EXPECT_EQ(radii_of(0.2, 3)[0], 0.2);
}

TEST(StraightEnds, ABendThatReachesIntoAJunctionIsRefused) {
  Elbow elbow(1);
  elbow.nodes.push_back({"D", {20, 0, 0}});
  elbow.pipes.push_back(MakePipe("P3", "B", "D"));
  // R tan(45 deg) = 1 m is all of the last straight
  elbow.pipes[0].vertices_m = {{5, 1, 0}, {10, 1, 0}};
  const std::string text = RefusalOf(elbow, "network.pipes[0]");
  EXPECT_NE(text.find("next to node 'B' leaves no straight"), std::string::npos) << text;
}

}  // namespace
}  // namespace piperun
