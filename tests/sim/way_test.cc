#include "sim/way.h"

#include <gtest/gtest.h>

namespace piperun::sim {
namespace {

/// A -P0- N -P1- B, and P2 from C into N.
Network MakeTee() {
  const WallMaterial pvc{"pvc_u", 3.5e9, 0.05, 0.4, 1400, 1e-5};
  return Network({{"A", {0, 0, 0}}, {"N", {10, 0, 0}}, {"B", {30, 0, 0}}, {"C", {10, 5, 0}}},
                 {{"P0", "A", "N", 0.15, 0.007, 0, {}, pvc},
                  {"P1", "N", "B", 0.15, 0.007, 0, {}, pvc},
                  {"P2", "C", "N", 0.1, 0.005, 0, {}, pvc}});
}

constexpr PipeEnd kFromA{0, false}, kP0AtN{0, true}, kP1AtN{1, false}, kP2AtN{2, true};

TEST(Way, ChainageGoesOnThroughPipesTravelledEitherWay) {
  const Network tee = MakeTee();
  Way way(tee, kFromA);
  EXPECT_EQ(way.Chainage_m(4), 4);
  way.Cross({kP0AtN, kP2AtN, Vector3d::Zero()});
  EXPECT_TRUE(way.leg().reversed);
  EXPECT_DOUBLE_EQ(way.Chainage_m(5), 10);  // the node is at P2's far end
  EXPECT_DOUBLE_EQ(way.Chainage_m(1), 14);
}

TEST(Way, APipeLeftByTheEndItWasEnteredIsForgotten) {
  const Network tee = MakeTee();
  Way way(tee, kFromA);
  way.Cross({kP0AtN, kP1AtN, Vector3d::Zero()});
  way.Cross({kP1AtN, kP2AtN, Vector3d::Zero()});
  ASSERT_EQ(way.legs().size(), 2u);
  EXPECT_EQ(way.leg().pipe, 2);
  EXPECT_DOUBLE_EQ(way.leg().chainage_begin_m, 10);
  way.Cross({kP2AtN, kP0AtN, Vector3d::Zero()});  // and back into the first
  ASSERT_EQ(way.legs().size(), 1u);
  EXPECT_DOUBLE_EQ(way.Chainage_m(9), 9);
}

TEST(Way, BackBeyondTheLaunchChainageBeginsAnew) {
  const Network tee = MakeTee();
  Way way(tee, kP1AtN);
  way.Cross({kP1AtN, kP0AtN, Vector3d::Zero()});
  EXPECT_DOUBLE_EQ(way.Chainage_m(7), 3);
}

TEST(Way, ShiftsBetweenDrawingsAddUpAndAreTakenBack) {
  const Network tee = MakeTee();
  const Vector3d shift(0.5, -0.2, 0.1);
  Way way(tee, kFromA);
  way.Cross({kP0AtN, kP1AtN, shift});
  EXPECT_EQ(way.leg().offset_W, (-shift).eval());
  way.Cross({kP1AtN, kP0AtN, -shift});
  EXPECT_EQ(way.leg().offset_W, Vector3d::Zero().eval());
}

TEST(Way, FindsTheFirstLegInAPipe) {
  const Network tee = MakeTee();
  Way way(tee, kFromA);
  way.Cross({kP0AtN, kP1AtN, Vector3d::Zero()});
  EXPECT_EQ(way.FindLeg(2), nullptr);
  ASSERT_NE(way.FindLeg(1), nullptr);
  EXPECT_DOUBLE_EQ(way.CalcChainage_m(*way.FindLeg(1), 3), 13);
}

}  // namespace
}  // namespace piperun::sim
