#include "estimator/wall_classes.h"

#include <gtest/gtest.h>

#include "estimator/pipe_loss.h"
#include "tests/estimator/walk.h"

namespace piperun::estimator {
namespace {

const WallMaterial kIron{"ductile_iron", 165e9, 0.02, 0.28, 7050, 1e-4};

/// Pipes of 100 m in a row, each of plastic or iron.
RouteMap MakeRoute(const std::vector<bool>& plastic) {
  std::vector<NodeSpec> nodes{{"N0", {0, 0, 0}}};
  std::vector<PipeSpec> pipes;
  std::vector<RouteLeg> legs;
  for (std::size_t i = 0; i < plastic.size(); ++i) {
    nodes.push_back({"N" + std::to_string(i + 1), {100 * static_cast<double>(i + 1), 0, 0}});
    PipeSpec pipe;
    pipe.id = "P" + std::to_string(i);
    pipe.from = nodes[i].id;
    pipe.to = nodes[i + 1].id;
    pipe.diameter_m = 0.15;
    pipe.wall_thickness_m = 0.0075;
    pipe.material = plastic[i] ? testing::PvcU() : kIron;
    pipes.push_back(pipe);
    legs.push_back({static_cast<int>(i), false});
  }
  Network network(nodes, pipes);
  Route route(network, legs);
  return {std::move(network), std::move(route)};
}

TEST(WallClasses, AStretchOfPlasticInIronIsAClassOfItsOwn) {
  const auto classes = ClassifyWalls(MakeRoute({false, true, true, false}), 2000);
  ASSERT_EQ(classes.size(), 2u);
  EXPECT_LT(classes[0].slope_dB_m, 0.5);  // iron, some 0.24 dB/m
  EXPECT_GT(classes[1].slope_dB_m, 5);    // plastic, some 6.4
  EXPECT_EQ(classes[0].stretches.size(), 2u);
  EXPECT_EQ(classes[1].stretches.size(), 1u);
  EXPECT_TRUE(classes[1].Holds(150) && classes[1].Holds(299));
  EXPECT_FALSE(classes[1].Holds(99) || classes[1].Holds(301));
  EXPECT_TRUE(classes[1].Holds(301, 2));
  EXPECT_TRUE(classes[0].Holds(-5) && classes[0].Holds(1e6));  // a track may run past the map
}

TEST(WallClasses, OneWallIsOneClassWithItsOwnSlope) {
  const RouteMap map = MakeRoute({true, true});
  const auto classes = ClassifyWalls(map, 2000);
  ASSERT_EQ(classes.size(), 1u);
  EXPECT_DOUBLE_EQ(classes[0].slope_dB_m, CalcAttenuation_dB_m(map.network.pipe(0), 2000));
  ASSERT_EQ(classes[0].stretches.size(), 1u);
}

}  // namespace
}  // namespace piperun::estimator
