#include "estimator/fitting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/locator_choice.h"
#include "tests/estimator/leak_sound.h"
#include "tests/estimator/walk.h"

namespace piperun::estimator {
namespace {

using testing::SoundRecord;
using testing::SoundScene;

PlacedFitting At(FittingKind kind, double chainage_m) {
  return {std::string(Name(kind)) + " X", CalcFittingPrior(kind), chainage_m};
}

double Normal_1_m(double distance_m, double sd_m) {
  return std::exp(-0.5 * distance_m * distance_m / (sd_m * sd_m)) / (sd_m * std::sqrt(2 * std::numbers::pi));
}

TEST(Fitting, WithoutFittingsTheLocatorsConfidenceStands) {
  const FittingVerdict verdict = JudgeByFittings({}, 10, 0.1, 0.87);
  EXPECT_NEAR(verdict.confidence, 0.87, 1e-12);
  EXPECT_FALSE(verdict.at);
}

TEST(Fitting, AtAValveTheOddsAreThoseOfBayesTheorem) {
  // hypotheses per metre of pipe: a leak anywhere 1e-3, a false alarm 1e-3 (1 - c)/c, the valve noisy 0.3 N,
  // the valve leaking 0.05 N, N over the place's error and the drawing's
  const double sd_m = std::sqrt(0.5 * 0.5 + 1), n = Normal_1_m(0.8, sd_m), c = 0.95;
  const double leak = 1e-3 + 0.05 * n, other = 1e-3 * (1 - c) / c + 0.3 * n;
  const FittingVerdict verdict = JudgeByFittings({At(FittingKind::kValve, 20)}, 20.8, 0.5, c);
  EXPECT_NEAR(verdict.confidence, leak / (leak + other), 1e-12);
  EXPECT_LT(verdict.confidence, 0.2);
  EXPECT_GT(verdict.confidence, 0.1);  // it may be the valve's gland that leaks: 0.05 of 0.35
  EXPECT_EQ(verdict.at, "valve X");
}

TEST(Fitting, FarFromAllFittingsNothingChanges) {
  const FittingVerdict verdict =
      JudgeByFittings({At(FittingKind::kPump, 0), At(FittingKind::kValve, 40)}, 20, 0.1, 0.9);
  EXPECT_NEAR(verdict.confidence, 0.9, 1e-9);
  EXPECT_FALSE(verdict.at);
}

TEST(Fitting, BetweenTwoItIsTheLikelierThatIsNamed) {
  const std::vector<PlacedFitting> both{At(FittingKind::kService, 10), At(FittingKind::kPump, 11)};
  EXPECT_EQ(JudgeByFittings(both, 10.5, 0.1, 0.9).at, "pump X");  // as far, noisier
  // 1.95 m of 1.96 standard deviations are still at it, 1.97 m not
  EXPECT_TRUE(JudgeByFittings({At(FittingKind::kPump, 0)}, 1.95, 0, 0.9).at);
  EXPECT_FALSE(JudgeByFittings({At(FittingKind::kPump, 0)}, 1.97, 0, 0.9).at);
}

/// A - T - B, 30 m and 20 m, with a branch at T.
RouteMap MakeTee(std::vector<Fitting> fittings) {
  const auto pipe = [](const char* id, const char* from, const char* to) {
    PipeSpec p;
    p.id = id;
    p.from = from;
    p.to = to;
    p.diameter_m = 0.15;
    p.wall_thickness_m = 0.0075;
    p.material = testing::PvcU();
    return p;
  };
  Network network({{"A", {0, 0, 0}}, {"T", {30, 0, 0}}, {"B", {50, 0, 0}}, {"C", {30, 10, 0}}},
                  {pipe("P1", "A", "T"), pipe("P2", "B", "T"), pipe("P3", "T", "C")});
  Route route(network, {{0, false}, {1, true}});
  return {std::move(network), std::move(route), std::move(fittings)};
}

TEST(Fitting, ThoseOnTheWayAndCloseBesideItArePlacedAndSoAreTees) {
  const RouteMap map = MakeTee({{FittingKind::kValve, "V1", 1, 5},    // 5 m from B, walked backwards
                                {FittingKind::kService, "S1", 2, 3},  // 3 m into the branch
                                {FittingKind::kPump, "far", 2, 8}});  // 8 m into it
  const auto placed = PlaceFittings(map.network, map.route, map.fittings);
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[0].label, "service S1");
  EXPECT_NEAR(placed[0].chainage_m, 30, 1e-12);
  EXPECT_EQ(placed[1].label, "tee T");
  EXPECT_NEAR(placed[1].chainage_m, 30, 1e-12);
  EXPECT_EQ(placed[2].label, "valve V1");
  EXPECT_NEAR(placed[2].chainage_m, 45, 1e-12);
}

TEST(Fitting, ALeakBesideAValveIsListedFlaggedAndLessSure) {
  SoundScene scene;
  scene.leaks = {{6, 12}, {17, 12}};
  EstimatorStart start;
  start.map = MakeTee({{FittingKind::kValve, "V1", 0, 6.5}});
  const auto flagged = LocatorChoice("matched_filter").Make(start);
  SoundRecord(scene, 2).Feed(*flagged, 1600);
  ASSERT_EQ(flagged->leaks().size(), 2u);
  EXPECT_EQ(flagged->leaks()[0].at, "valve V1");
  EXPECT_NEAR(flagged->leaks()[0].chainage_m, 6, 0.15);
  EXPECT_FALSE(flagged->leaks()[1].at);
  EXPECT_LT(flagged->leaks()[0].confidence, 0.2);
  EXPECT_GT(flagged->leaks()[1].confidence, 0.9);
}

}  // namespace
}  // namespace piperun::estimator
