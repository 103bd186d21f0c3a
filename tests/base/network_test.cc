#include "base/network.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>

#include "base/check.h"

namespace piperun {
namespace {

struct Plan {
  std::vector<NodeSpec> nodes{{"A", {0, 0, 0}}, {"B", {10, 0, 0}}, {"C", {10, 10, 2}}};
  std::vector<PipeSpec> pipes;

  Plan() {
    for (const auto& [id, from, to] : {std::tuple{"P1", "A", "B"}, std::tuple{"P2", "B", "C"}}) {
      PipeSpec pipe;
      pipe.id = id;
      pipe.from = from;
      pipe.to = to;
      pipe.diameter_m = 0.15;
      pipe.wall_thickness_m = 0.0075;
      pipes.push_back(pipe);
    }
  }
  Network Build() const { return Network(nodes, pipes); }
};

TEST(Pipe, HasItsBoreBeyondItsEndsToo) {
  // a closed end is a hemisphere: a ball in it lies beyond the pipe's end
  Plan plan;
  plan.nodes[2].position_m = {20, 0, 0};
  plan.pipes[1].diameter_m = 0.1;  // gets a cone at B, on one line with the wider pipe
  const Network network = plan.Build();
  EXPECT_EQ(network.pipe(0).RadiusAt_m(-0.01), 0.075);
  EXPECT_EQ(network.pipe(0).RadiusAt_m(10.01), 0.075);
  EXPECT_EQ(network.pipe(1).RadiusAt_m(-0.01), 0.075);
  EXPECT_EQ(network.pipe(1).RadiusAt_m(10.01), 0.05);
}

TEST(Network, FindsNodesAndPipesById) {
  const Network network = Plan().Build();
  EXPECT_EQ(network.FindNode("C"), 2);
  EXPECT_EQ(network.FindPipe("P2"), 1);
  EXPECT_FALSE(network.FindNode("P1").has_value());
  EXPECT_FALSE(network.FindPipe("p1").has_value());
  EXPECT_EQ(network.EndsAt(0), (std::vector<PipeEnd>{{0, false}}));
  EXPECT_EQ(network.EndsAt(1), (std::vector<PipeEnd>{{0, true}, {1, false}}));
}

TEST(Network, BoreGoesOnBeyondTheEndsOfAPipe) {
  const Network network = Plan().Build();
  const Pipe& pipe = network.pipe(0);
  EXPECT_EQ(pipe.RadiusAt_m(-0.1), pipe.radius_m());
  EXPECT_EQ(pipe.RadiusAt_m(pipe.length_m + 0.1), pipe.radius_m());
}

TEST(Network, PipesRunFromNodeToNode) {
  const Network network = Plan().Build();
  const Pipe& pipe = network.pipe(1);
  EXPECT_EQ(pipe.from, 1);
  EXPECT_EQ(pipe.to, 2);
  EXPECT_DOUBLE_EQ(pipe.length_m, std::sqrt(104.0));
  EXPECT_DOUBLE_EQ(pipe.radius_m(), 0.075);
  EXPECT_DOUBLE_EQ(pipe.area_m2(), std::numbers::pi * 0.005625);
  EXPECT_NEAR((EvalCentreline(pipe.centreline.back(), pipe.length_m).p_W - Vector3d(10, 10, 2)).norm(), 0,
              1e-14);
}

TEST(Network, VerticesBecomeBends) {
  Plan plan;
  plan.nodes[2].position_m = {10, 10, 0};
  plan.pipes = {plan.pipes[0]};
  plan.pipes[0].to = "C";
  plan.pipes[0].vertices_m = {{10, 0, 0}};
  plan.pipes[0].bend_radius_m = 0.5;
  const Network network = plan.Build();
  EXPECT_EQ(network.pipe(0).centreline.size(), 3u);
  EXPECT_NEAR(network.pipe(0).length_m, 19 + 0.25 * std::numbers::pi, 1e-13);
}

struct BadPlan {
  const char* name;
  std::function<void(Plan&)> spoil;
  const char* key;
  const char* words;
};

void PrintTo(const BadPlan& plan, std::ostream* out) { *out << plan.name; }

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class NetworkRefuses : public testing::TestWithParam<BadPlan> {};

TEST_P(NetworkRefuses, AndNamesKeyAndProblem) {
  Plan plan;
  GetParam().spoil(plan);
  try {
    plan.Build();
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), GetParam().key);
    EXPECT_NE(e.problem().find(GetParam().words), std::string::npos) << e.problem();
  }
}

const BadPlan kBadPlans[] = {
    {"NoPipe", [](Plan& p) { p.pipes.clear(); }, "network.pipes", "at least one pipe"},
    {"NodeIdTwice", [](Plan& p) { p.nodes[2].id = "A"; }, "network.nodes[2].id", "'A' is used twice"},
    {"PipeIdTwice", [](Plan& p) { p.pipes[1].id = "P1"; }, "network.pipes[1].id", "'P1' is used twice"},
    {"NodeWithoutId", [](Plan& p) { p.nodes[1].id = ""; }, "network.nodes[1].id", "must not be empty"},
    {"PipeWithoutId", [](Plan& p) { p.pipes[0].id = ""; }, "network.pipes[0].id", "must not be empty"},
    {"UnknownFrom", [](Plan& p) { p.pipes[0].from = "X"; }, "network.pipes[0].from", "no node 'X'"},
    {"UnknownTo", [](Plan& p) { p.pipes[1].to = "b"; }, "network.pipes[1].to", "no node 'b'"},
    {"ZeroBore", [](Plan& p) { p.pipes[0].diameter_m = 0; }, "network.pipes[0].diameter_m",
     "0 is not allowed"},
    {"NegativeBore", [](Plan& p) { p.pipes[0].diameter_m = -0.1; }, "network.pipes[0].diameter_m",
     "-0.1 is not"},
    {"BoreNotANumber", [](Plan& p) { p.pipes[0].diameter_m = kNan; }, "network.pipes[0].diameter_m",
     "nan is not"},
    {"EndlessBore", [](Plan& p) { p.pipes[0].diameter_m = kInfinity; }, "network.pipes[0].diameter_m",
     "inf is not"},
    {"NoWall", [](Plan& p) { p.pipes[1].wall_thickness_m = 0; }, "network.pipes[1].wall_thickness_m",
     "must be a"},
    {"NodeNowhere", [](Plan& p) { p.nodes[1].position_m.y() = kNan; }, "network.nodes[1].position_m",
     "not a finite"},
    {"NodesCoincide", [](Plan& p) { p.nodes[1].position_m.setZero(); }, "network.pipes[0]", "coincide"},
    {"VertexNowhere",
     [](Plan& p) {
       p.pipes[1].vertices_m = {{10, 5, 0}, {kInfinity, 0, 0}};
       p.pipes[1].bend_radius_m = 1;
     },
     "network.pipes[1].vertices_m[1]", "not a finite"},
    {"BendWithoutRadius",
     [](Plan& p) {
       p.pipes[0].vertices_m = {{5, 5, 0}};
     },
     "network.pipes[0].bend_radius_m", "0 is not allowed"},
    {"BendTighterThanTheBore",
     [](Plan& p) {
       p.pipes[0].vertices_m = {{5, 5, 0}};
       p.pipes[0].bend_radius_m = 0.075;
     },
     "network.pipes[0].bend_radius_m", "must exceed the bore radius 0.075 m"},
    {"SelfLoop", [](Plan& p) { p.pipes[1].to = "B"; }, "network.pipes[1].to", "from 'B' to itself"},
    {"NegativeLength", [](Plan& p) { p.pipes[1].length_m = -3; }, "network.pipes[1].length_m", "-3 is not"},
    {"LengthNotANumber", [](Plan& p) { p.pipes[1].length_m = kNan; }, "network.pipes[1].length_m",
     "nan is not"},
    {"EndlessLength", [](Plan& p) { p.pipes[0].length_m = kInfinity; }, "network.pipes[0].length_m",
     "inf is not"},
    {"LengthBelowTheRise", [](Plan& p) { p.pipes[1].length_m = 1.5; }, "network.pipes[1].length_m",
     "shorter than the rise of 2 m"},
    {"BendRadiusNotANumber", [](Plan& p) { p.pipes[0].bend_radius_m = kNan; },
     "network.pipes[0].bend_radius_m", "nan m is too tight"},
    {"BendThatDoesNotFit",
     [](Plan& p) {
       p.pipes[0].vertices_m = {{5, 5, 0}};
       p.pipes[0].bend_radius_m = 50;
     },
     "network.pipes[0]", "does not fit at corner 1"},
};

INSTANTIATE_TEST_SUITE_P(BadInput, NetworkRefuses, testing::ValuesIn(kBadPlans),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace piperun
