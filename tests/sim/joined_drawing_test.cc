#include "sim/joined_drawing.h"

#include <gtest/gtest.h>

#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

/// A - M - B to the east, 3 m each as drawn, and M - C to the north; A - M is stated as 9 m.
Network MakeStretchedNetwork() {
  testing::PipeShape straight;
  straight.bend_radius_m = 0;
  std::vector<PipeSpec> pipes{testing::MakePipeSpec("AM", "A", "M", straight),
                              testing::MakePipeSpec("MB", "M", "B", straight),
                              testing::MakePipeSpec("CM", "C", "M", straight)};
  pipes[0].length_m = 9;
  return Network({{"A", {0, 0, 0}}, {"M", {3, 0, 0}}, {"B", {6, 0, 0}}, {"C", {3, 3, 0}}}, pipes);
}

TEST(JoinedDrawing, MeetsItsNeighbourWhereLengthsWereStretched) {
  const Network network = MakeStretchedNetwork();
  ASSERT_EQ(network.pipe(0).Eval(9).p_W, Vector3d(9, 0, 0));
  // AM seen from MB: 1 m before the joint is 1 m before M
  const JoinedDrawing before(network, 1, 0);
  EXPECT_TRUE(before.meets());
  EXPECT_TRUE((network.pipe(0).Eval(8).p_W + before.Shift_W(8)).isApprox(Vector3d(2, 0, 0)));
  // MB seen from AM goes on where AM ends
  const JoinedDrawing after(network, 0, 1);
  EXPECT_TRUE((network.pipe(1).Eval(1).p_W + after.Shift_W(1)).isApprox(Vector3d(10, 0, 0)));
  EXPECT_TRUE((network.pipe(1).Eval(2.5).p_W + after.Shift_W(2.5)).isApprox(Vector3d(11.5, 0, 0)));
}

TEST(JoinedDrawing, StaysWhereItIsDrawnWhereDrawingsMeetOrPipesDoNot) {
  const Network network = MakeStretchedNetwork();
  const JoinedDrawing neighbour(network, 1, 2), itself(network, 0, 0);
  EXPECT_TRUE(neighbour.meets() && itself.meets());
  for (const double s_m : {0.0, 1.0, 3.0}) {
    EXPECT_LT(neighbour.Shift_W(s_m).norm(), 1e-15);
    EXPECT_EQ(itself.Shift_W(s_m), Vector3d::Zero());
  }
  const Network apart({{"A", {0, 0, 0}}, {"B", {3, 0, 0}}, {"C", {0, 1, 0}}, {"D", {3, 1, 0}}},
                      {testing::MakePipeSpec("AB", "A", "B"), testing::MakePipeSpec("CD", "C", "D")});
  const JoinedDrawing other(apart, 0, 1);
  EXPECT_FALSE(other.meets());
  EXPECT_EQ(other.Shift_W(1), Vector3d::Zero());
}

TEST(JoinedDrawing, OfPipesThatShareBothNodesMeetsAtTheNearerOne) {
  testing::PipeShape straight;
  straight.bend_radius_m = 0;
  std::vector<PipeSpec> pipes{testing::MakePipeSpec("P", "A", "B", straight),
                              testing::MakePipeSpec("Q", "B", "A", straight)};
  pipes[1].length_m = 10;
  const Network network({{"A", {0, 0, 0}}, {"B", {3, 0, 0}}}, pipes);
  const JoinedDrawing way(network, 0, 1);
  const auto seen = [&](double s_m) -> Vector3d { return network.pipe(1).Eval(s_m).p_W + way.Shift_W(s_m); };
  EXPECT_TRUE(seen(1).isApprox(Vector3d(2, 0, 0)));
  EXPECT_TRUE(seen(9).isApprox(Vector3d(1, 0, 0)));
}

}  // namespace
}  // namespace piperun::sim
