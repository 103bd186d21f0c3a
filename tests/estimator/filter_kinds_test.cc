// What every kind of filter must do, whatever is in it. A new kind joins by being there.

#include <gtest/gtest.h>

#include "tests/estimator/allocation_counter.h"
#include "tests/estimator/walk.h"

namespace piperun::estimator {
namespace {

using namespace testing;  // the record generator

std::vector<std::string> KindNames() {
  std::vector<std::string> names;
  for (const FilterKind& kind : FilterKinds()) names.emplace_back(kind.name);
  return names;
}

class FilterKindsTest : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Estimator> Make(const EstimatorStart& start) const {
    return MakeOfKind(FilterKinds(), GetParam(), start, {{"locator.kind", 0, "none"}});
  }
};

TEST_P(FilterKindsTest, FollowsARollingBallRoundTwoBends) {
  const RouteMap map = MakeMap({{0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {14, 10, 0}});
  const RollingBall ball = MakeBall(map);
  const BallRecord record = ball.Roll(400);
  const auto filter = Make(MakeStart(map, ball));
  double attitude_rad = 0, chainage_m = 0;
  Feed(*filter, record, Corrupt(record, kWalkGrade, 3), 0.3e-6, 3,
       [&](const NavState& nav, const BallTruth& truth) {
         ASSERT_TRUE(nav.p_W.allFinite() && nav.q_WB.coeffs().allFinite());
         attitude_rad = AttitudeError_W(truth.q_WB, nav.q_WB).norm();
         chainage_m = nav.chainage_m - truth.chainage_m;
       });
  // the radius is exact and there is no slip: what is left is the error of the attitude, times the radius
  EXPECT_LT(attitude_rad, 3 * kDegree);
  EXPECT_LT(std::abs(chainage_m), 3 * kDegree * kBallRadius_m + 0.01);
}

TEST_P(FilterKindsTest, AllocatesNothingPerMeasurement) {
  const RouteMap map = MakeMap({{0, 0, 0}, {10, 0, 0}});
  const RollingBall ball = MakeBall(map);
  const BallRecord record = ball.Roll(400);
  const auto filter = Make(MakeStart(map, ball));
  std::size_t before = 0;
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    if (k == 2000) before = AllocationCount();
    filter->Ingest({1, record.samples[k]});
    if (k % 8 == 0) filter->Ingest({2, Magnetometer(record.truth[k + 1], record.samples[k].stamp, 0, 1, k)});
  }
  EXPECT_EQ(AllocationCount(), before);
}

/// 20 ms without samples, as when a buffer overflows, four times a second.
TEST_P(FilterKindsTest, SurvivesGaps) {
  const RouteMap map = MakeMap({{0, 0, 0}, {10, 0, 0}});
  const RollingBall ball = MakeBall(map);
  const BallRecord record = ball.Roll(400);
  const auto filter = Make(MakeStart(map, ball));
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    if (k % 100 < 8 && k > 400) continue;
    filter->Ingest({1, record.samples[k]});
    if (k % 8 == 0)
      filter->Ingest({2, Magnetometer(record.truth[k + 1], record.samples[k].stamp, 0.3e-6, 1, k)});
  }
  EXPECT_LT(AttitudeError_W(record.truth.back().q_WB, filter->nav().q_WB).norm(), 4 * kDegree);
  EXPECT_NEAR(filter->nav().chainage_m, record.truth.back().chainage_m, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FilterKindsTest, ::testing::ValuesIn(KindNames()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace piperun::estimator
