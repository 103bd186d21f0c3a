#include "scenarios/score.h"

#include <gtest/gtest.h>

namespace piperun::scenarios {
namespace {

estimator::LeakEstimate At(double chainage_m) {
  estimator::LeakEstimate e;
  e.chainage_m = chainage_m;
  return e;
}

TrueLeak Leak(const std::string& id, double chainage_m) {
  TrueLeak leak;
  leak.id = id;
  leak.chainage_m = chainage_m;
  return leak;
}

TEST(ScoreLeaks, MatchesOneToOneClosestFirst) {
  // 10.6 is closer to A (10) than 9.0 is, and must not be given to B (11.5) although it is within its radius
  const LeakScore score = ScoreLeaks({At(9.0), At(10.6)}, {Leak("A", 10), Leak("B", 11.5)}, 2);
  EXPECT_EQ(score.leaks[1].match, "A");
  EXPECT_NEAR(*score.leaks[1].error_m, 0.6, 1e-12);
  EXPECT_FALSE(score.leaks[0].match.has_value());  // 2.5 m from B
  EXPECT_EQ(score.missed, std::vector<std::string>{"B"});
  EXPECT_EQ(score.false_alarms, 1);
}

TEST(ScoreLeaks, CountsASecondReportOfALeakAsFalseAlarm) {
  const LeakScore score = ScoreLeaks({At(5.0), At(5.1)}, {Leak("A", 5.0)}, 2);
  EXPECT_EQ(score.false_alarms, 1);
  EXPECT_TRUE(score.missed.empty());
}

TEST(ScoreLeaks, FalseAlarmsAtFittingsCountApart) {
  auto valve = At(20), leaking_valve = At(5.1);
  valve.at = leaking_valve.at = "valve V1";
  const LeakScore score = ScoreLeaks({valve, leaking_valve, At(30)}, {Leak("A", 5.0)}, 2);
  EXPECT_EQ(score.false_alarms, 1);
  EXPECT_EQ(score.false_alarms_at_fittings, 1);
  EXPECT_EQ(score.leaks[1].match, "A");  // a flag loses no leak
}

TEST(ScoreLeaks, WithoutReportsMissesAll) {
  const LeakScore score = ScoreLeaks({}, {Leak("A", 5), Leak("B", 6)}, 2);
  EXPECT_EQ(score.missed.size(), 2u);
  EXPECT_EQ(score.false_alarms, 0);
}

TEST(TrackScorer, MeasuresErrorsWithoutAlignment) {
  TrackScorer scorer;
  estimator::NavState nav;
  nav.valid = true;
  nav.attitude_covariance_rad2 = Matrix3d::Identity() * 1e-4;
  const double tilt = 0.02;
  for (int i = 0; i <= 10; ++i) {
    nav.q_WB = ExpSO3({tilt, 0, 0});
    nav.p_W = {i + 0.3, 0.4, 0};
    nav.chainage_m = i + 0.1 * (i % 2 ? 1 : -1);
    scorer.Add(nav, {Quaterniond::Identity(), {static_cast<double>(i), 0, 0}, static_cast<double>(i)});
  }
  const auto score = scorer.Score();
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->attitude_rmse_deg, tilt * 180 / 3.14159265358979, 1e-9);
  EXPECT_NEAR(score->position_rmse_m, 0.5, 1e-12);  // 3-4-5
  EXPECT_NEAR(score->chainage_rmse_m, 0.1, 1e-12);
  EXPECT_NEAR(score->chainage_final_error_m, -0.1, 1e-12);  // row 10 is even
  EXPECT_NEAR(score->final_error_percent, 5, 1e-9);         // 0.5 m of 10 m
  EXPECT_NEAR(score->nees_mean, tilt * tilt / 1e-4 / 3, 1e-9);
}

TEST(TrackScorer, IgnoresRowsBeforeTheFilterIsValid) {
  TrackScorer scorer;
  scorer.Add({}, {Quaterniond::Identity(), {9, 9, 9}, 9});
  EXPECT_FALSE(scorer.Score());
}

}  // namespace
}  // namespace piperun::scenarios
