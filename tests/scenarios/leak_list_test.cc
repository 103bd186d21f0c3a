#include "scenarios/leak_list.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"

namespace piperun::scenarios {
namespace {

Network MakeLine() {
  const WallMaterial pvc{"pvc_u", 3.5e9, 0.05, 0.4, 1400, 1e-5};
  return Network({{"A", {0, 0, 0}}, {"B", {100, 0, 0}}, {"C", {400, 0, 0}}, {"D", {400, 50, 0}}},
                 {{"P0", "A", "B", 0.15, 0.007, 0, {}, pvc},
                  {"P1", "B", "C", 0.15, 0.007, 0, {}, pvc},
                  {"P2", "D", "C", 0.15, 0.007, 0, {}, pvc}});
}

const std::vector<RouteLeg> kPlan{{0, false}, {1, false}};

Scenario Drawing(std::int64_t count) {
  Scenario scenario;
  scenario.random_leaks.count = count;
  return scenario;
}

TEST(DrawLeaks, AreAFunctionOfSeedAndRun) {
  const Network line = MakeLine();
  Scenario scenario = Drawing(5);
  const auto first = DrawLeaks(scenario, line, kPlan, {}), again = DrawLeaks(scenario, line, kPlan, {});
  scenario.run = 1;
  const auto other = DrawLeaks(scenario, line, kPlan, {});
  ASSERT_EQ(first.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(first[i].s_m, again[i].s_m);
    EXPECT_NE(first[i].s_m, other[i].s_m);
    EXPECT_EQ(first[i].id, "R" + std::to_string(i + 1));
  }
}

TEST(DrawLeaks, KeepTheirDistanceFromEachOtherFromListedOnesAndFromEnds) {
  const Network line = MakeLine();
  Scenario scenario = Drawing(12);
  scenario.random_leaks.min_spacing_m = 10;
  const std::vector<Leak> listed{{"L1", 0, 50, 0.002, 0.6, 0}};
  for (scenario.run = 0; scenario.run < 50; ++scenario.run) {
    auto all = DrawLeaks(scenario, line, kPlan, listed);
    all.push_back(listed[0]);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_GE(all[i].s_m, 10);
      EXPECT_LE(all[i].s_m, line.pipe(all[i].pipe).length_m - 10);
      for (std::size_t j = 0; j < i; ++j) {
        if (all[i].pipe == all[j].pipe) {
          EXPECT_GE(std::abs(all[i].s_m - all[j].s_m), 10);
        }
      }
    }
  }
}

// One leak a run: the long pipe is three times as long, so 3/4 of 2,000 leaks lie in it, +- 4 sqrt(n p q) =
// 78; the logarithm of the hole is uniform, so that half the holes are below the geometric mean, +- 4
// sqrt(n/4) = 90.
TEST(DrawLeaks, AreUniformOverTheWayAndLogUniformInSize) {
  const Network line = MakeLine();
  Scenario scenario = Drawing(1);
  scenario.random_leaks.min_spacing_m = 0.01;
  int in_long_pipe = 0, small = 0;
  const double middle = std::sqrt(0.001 * 0.005);
  for (scenario.run = 0; scenario.run < 2000; ++scenario.run) {
    const Leak leak = DrawLeaks(scenario, line, kPlan, {}).front();
    EXPECT_NE(leak.pipe, 2) << "not on the way";
    in_long_pipe += leak.pipe == 1 ? 1 : 0;
    small += leak.hole_diameter_m < middle ? 1 : 0;
  }
  EXPECT_NEAR(in_long_pipe, 1500, 78);
  EXPECT_NEAR(small, 1000, 90);
}

TEST(DrawLeaks, MayLieAnywhereInTheNetwork) {
  const Network line = MakeLine();
  Scenario scenario = Drawing(20);
  scenario.random_leaks.where = "network";
  scenario.random_leaks.min_spacing_m = 0.5;
  bool aside = false;
  for (const Leak& leak : DrawLeaks(scenario, line, kPlan, {})) aside = aside || leak.pipe == 2;
  EXPECT_TRUE(aside);
}

TEST(DrawLeaks, WithoutRoomIsRefused) {
  Scenario scenario = Drawing(100);
  scenario.random_leaks.min_spacing_m = 10;
  EXPECT_THROW(DrawLeaks(scenario, MakeLine(), kPlan, {}), InputError);
}

}  // namespace
}  // namespace piperun::scenarios
