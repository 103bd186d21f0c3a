#include "sim/load_ranges.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace piperun::sim {
namespace {

const WaterProperties kWater{20, 1000, 1e-6, 1482};

LoadRanges Ranges(const BallParams& ball = {}, const ForceParams& forces = {},
                  ProfileLaw profile = ProfileLaw::kPowerLaw) {
  const std::vector<double> bores{0.075};
  return LoadRanges(CalcFluidLoadCoefficients(ball, forces, kWater, Vector3d::Zero(), bores), kWater,
                    profile);
}

WaterAtBall Flowing(double speed_m_s) {
  WaterAtBall water;
  water.bore_radius_m = 0.075;
  water.bulk_speed_m_s = speed_m_s;
  water.wall_gap_m = 0.045;
  return water;
}

TEST(LoadRanges, SayNothingOfAnOrdinaryRun) {
  LoadRanges ranges = Ranges();
  ranges.Feed({.free_reynolds = 1.9e5, .reynolds = 1.5e5, .spin_reynolds = 1.9e5, .diameter_ratio = 0.9},
              Flowing(-2));
  ranges.Feed({}, Flowing(0));
  EXPECT_TRUE(ranges.Sentences().empty());
}

TEST(LoadRanges, NameTheLawItsRangeAndTheFarthestExcursion) {
  LoadRanges ranges = Ranges();
  for (const double re : {1e3, 3.14e5, 2.5e5}) {
    ranges.Feed({.free_reynolds = re, .reynolds = 0.1 * re, .spin_reynolds = 2 * re, .diameter_ratio = 0.93},
                Flowing(1));
  }
  EXPECT_EQ(
      ranges.Sentences(),
      (std::vector<std::string>{
          "drag: Brown & Lawler is fitted for Re < 2e5; the ball reached Re 3.1e5",
          "wall factor: Kehlenbeck & Di Felice is fitted for d/D < 0.9; the ball had d/D 0.93",
          "spin torque: Dennis et al. and Sawatzki are used for Re_w < 2e5; the ball reached Re_w 6.3e5"}));
}

TEST(LoadRanges, AreThoseOfTheLawsThatAct) {
  const LoadNumbers far{.free_reynolds = 5e5, .reynolds = 3e5, .spin_reynolds = 3e5, .diameter_ratio = 0.85};
  LoadRanges crisis = Ranges({}, {.drag = "morrison", .wall_factor = "munroe", .spin_torque = false});
  crisis.Feed(far, Flowing(1));
  EXPECT_EQ(crisis.Sentences(),
            (std::vector<std::string>{"wall factor: Munroe is fitted for d/D < 0.8; the ball had d/D 0.85"}));
  LoadRanges foam = Ranges({.foam_thickness_m = 0.005}, {.spin_torque = false});
  foam.Feed(far, Flowing(1));
  EXPECT_TRUE(foam.Sentences().empty());
  WaterAtBall touching = Flowing(1);
  touching.wall_gap_m = 0;
  foam.Feed(far, touching);
  EXPECT_EQ(
      foam.Sentences(),
      (std::vector<std::string>{"rolling drag: Jan & Chen is used for Re < 2e5; the ball reached Re 3e5"}));
  LoadRanges plain = Ranges({.foam_thickness_m = 0.005}, {.rolling_drag = false, .spin_torque = false});
  plain.Feed(far, touching);
  EXPECT_TRUE(plain.Sentences().empty());
}

TEST(LoadRanges, TellOfThePipesFlow) {
  LoadRanges transition = Ranges();
  transition.Feed({}, Flowing(0.02));  // Re = 0.02 0.15 / 1e-6 = 3000
  transition.Feed({}, Flowing(1));
  ASSERT_EQ(transition.Sentences().size(), 1u);
  EXPECT_NE(transition.Sentences()[0].find("the pipe had Re 3e3"), std::string::npos)
      << transition.Sentences()[0];
  LoadRanges power = Ranges(), log = Ranges({}, {}, ProfileLaw::kLogLaw);
  power.Feed({}, Flowing(30));
  log.Feed({}, Flowing(30));
  EXPECT_EQ(power.Sentences(),
            (std::vector<std::string>{"profile: Nikuradse's power law is fitted for the pipe's "
                                      "Re < 3.2e6; the pipe had Re 4.5e6"}));
  EXPECT_TRUE(log.Sentences().empty());
}

}  // namespace
}  // namespace piperun::sim
