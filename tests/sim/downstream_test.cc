#include "sim/downstream.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::MakePipeSpec;

/// Two ways from A to B, the water's speed in every pipe beside it:
///
///   S --IN 0.4-- A --LONG 1.0-- B --OUT 0.4-- T     LONG: 100 m in 100 s
///                 \-S1 0.5- C -/                    S1: 30 m in 60 s
///                    S2, drawn from B to C, -1.0    S2: 30 m in 30 s
class Diamond : public ::testing::Test {
 protected:
  enum Node { kS, kA, kB, kC, kT };
  enum PipeIndex { kIn, kLong, kFirst, kSecond, kOut };

  Diamond()
      : pipes_{MakePipeSpec("IN", "S", "A", {.diameter_m = 0.2}),
               MakePipeSpec("LONG", "A", "B", {.diameter_m = 0.2}),
               MakePipeSpec("S1", "A", "C", {.diameter_m = 0.1}),
               MakePipeSpec("S2", "B", "C", {.diameter_m = 0.1}),
               MakePipeSpec("OUT", "B", "T", {.diameter_m = 0.2})} {
    const double lengths_m[] = {20, 100, 30, 30, 20};
    for (std::size_t i = 0; i < pipes_.size(); ++i) {
      pipes_[i].length_m = lengths_m[i];
      pipes_[i].bend_radius_m = 0;
    }
  }

  Downstream& Make(std::vector<bool> open = {}) {
    network_.emplace(
        std::vector<NodeSpec>{
            {"S", {-20, 0, 0}}, {"A", {0, 0, 0}}, {"B", {20, 0, 0}}, {"C", {10, 10, 0}}, {"T", {40, 0, 0}}},
        pipes_);
    bore_.emplace(*network_, std::move(open));
    std::vector<double> areas_m2;
    FlowState state;
    for (std::size_t i = 0; i < pipes_.size(); ++i) {
      const Pipe& pipe = network_->pipes()[i];
      areas_m2.push_back(pipe.area_m2());
      state.pipes.push_back({{0, pipe.length_m, speeds_m_s_[i] * pipe.area_m2(), 50, 50, 0.02}});
    }
    flow_.emplace(std::move(areas_m2), std::vector<TrueTime>{TrueTime{}},
                  std::vector<FlowState>{std::move(state)});
    return downstream_.emplace(*bore_, *flow_, TrueTime{});
  }

  /// "S1 -S2": pipes in order, a minus for those travelled backwards; "none" without a way.
  std::string Text(const std::optional<std::vector<RouteLeg>>& legs) const {
    if (!legs) return "none";
    std::string text;
    for (const RouteLeg& leg : *legs) {
      text += std::string(text.empty() ? "" : " ") + (leg.reversed ? "-" : "") + network_->pipe(leg.pipe).id;
    }
    return text;
  }

  std::vector<PipeSpec> pipes_;
  std::vector<double> speeds_m_s_{0.4, 1, 0.5, -1, 0.4};
  std::optional<Network> network_;
  std::optional<Bore> bore_;
  std::optional<FlowTimeline> flow_;
  std::optional<Downstream> downstream_;
};

TEST_F(Diamond, FastestWayIsTheOneWithTheLeastTravelTime) {
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.01)), "IN S1 -S2 OUT") << "90 s, not 100 s";
  speeds_m_s_[kFirst] = 0.4;  // 75 s + 30 s
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.01)), "IN LONG OUT");
}

TEST_F(Diamond, WaterLeadsNowhereAgainstItself) {
  EXPECT_EQ(Text(Make().FindFastestWay(kT, kS, 0.01)), "none");
  EXPECT_EQ(Text(Make().FindFastestWay(kC, kA, 0.01)), "none");
  EXPECT_EQ(Text(Make().FindFastestWay(kC, kT, 0.01)), "-S2 OUT");
  EXPECT_EQ(Text(Make().FindFastestWay(kC, kC, 0.01)), "");
}

TEST_F(Diamond, StillWaterLeadsNowhere) {
  speeds_m_s_[kSecond] = -0.9e-4;
  EXPECT_EQ(Text(Make().FindFastestWay(kC, kT, 0.01)), "none");
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.01)), "IN LONG OUT");
  speeds_m_s_[kSecond] = -1.1e-4;
  EXPECT_EQ(Text(Make().FindFastestWay(kC, kT, 0.01)), "-S2 OUT");
}

TEST_F(Diamond, ABallGoesNeitherThroughWhatStopsItNorThroughWhatIsShut) {
  pipes_[kFirst].passable = false;
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.01)), "IN LONG OUT");
  pipes_[kLong].passable = false;
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.01)), "none");
  pipes_[kFirst].passable = true;
  EXPECT_EQ(Text(Make({true, true, true, false, true}).FindFastestWay(kS, kT, 0.01)), "none");
}

TEST_F(Diamond, ABallTakesTheWayThatIsWideEnough) {
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.05)), "IN S1 -S2 OUT") << "a bore of 100 mm";
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.051)), "IN LONG OUT");
  EXPECT_EQ(Text(Make().FindFastestWay(kS, kT, 0.101)), "none");
}

TEST_F(Diamond, MainFlowFollowsTheGreatestFlowNotTheGreatestSpeed) {
  speeds_m_s_[kFirst] = 3.9;  // in a quarter of the area
  EXPECT_EQ(Text(Make().FollowMainFlow(kS, 0.01)), "IN LONG OUT");
  speeds_m_s_[kFirst] = 4.1;
  EXPECT_EQ(Text(Make().FollowMainFlow(kS, 0.01)), "IN S1 -S2 OUT");
  EXPECT_EQ(Text(Make().FollowMainFlow(kS, 0.06)), "IN LONG OUT");
}

TEST_F(Diamond, MainFlowEndsWhereWaterLeadsNoFurtherOrClosesOnItself) {
  speeds_m_s_[kOut] = 0;
  EXPECT_EQ(Text(Make().FollowMainFlow(kS, 0.01)), "IN LONG");
  speeds_m_s_ = {0.4, 1, -1, 1, 0};  // round and round
  EXPECT_EQ(Text(Make().FollowMainFlow(kS, 0.01)), "IN LONG S2 -S1");
  EXPECT_EQ(Text(Make().FollowMainFlow(kT, 0.01)), "");
}

TEST_F(Diamond, LeadsOnFromAPipeWhoseWaterComesToTheNode) {
  const Downstream& water = Make();
  EXPECT_TRUE(water.LeadsOn(kSecond, kT));
  EXPECT_TRUE(water.LeadsOn(kSecond, kB)) << "at its `from` end: it flows backwards";
  EXPECT_FALSE(water.LeadsOn(kSecond, kC));
  EXPECT_FALSE(water.LeadsOn(kOut, kS));
  EXPECT_TRUE(water.LeadsOn(kOut, -1));
  speeds_m_s_[kOut] = 0;
  EXPECT_FALSE(Make().LeadsOn(kOut, -1));
  EXPECT_FALSE(Make().LeadsOn(kLong, kT));
}

TEST_F(Diamond, LeadsIntoNarrowerWhereWaterGoesNotWhereItComesFrom) {
  const Downstream& water = Make();
  EXPECT_TRUE(water.LeadsIntoNarrower(bore_->joint(kA), 0.051));
  EXPECT_FALSE(water.LeadsIntoNarrower(bore_->joint(kA), 0.05));
  EXPECT_FALSE(water.LeadsIntoNarrower(bore_->joint(kB), 0.051)) << "the narrow pipe's water comes here";
}

TEST_F(Diamond, LeadsAwayFromWhereWaterEnters) {
  const Downstream& water = Make();
  EXPECT_TRUE(water.LeadsAway(bore_->joint(kS)));
  EXPECT_TRUE(water.LeadsAway(bore_->joint(kC)));
  EXPECT_FALSE(water.LeadsAway(bore_->joint(kT)));
}

}  // namespace
}  // namespace piperun::sim
