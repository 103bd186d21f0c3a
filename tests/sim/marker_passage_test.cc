#include "sim/marker_passage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace piperun::sim {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(1);

/// Squared distance at t of something that passes at `v`, `h` away, at t_0.
double CalcDistance2(double t_s, double v, double h, double t0_s) {
  return h * h + v * v * (t_s - t0_s) * (t_s - t0_s);
}

TEST(PassageDetector, FindsTheVertexBetweenTwoSteps) {
  for (const double t0_s : {3.0, 3.00023, 3.00049, 3.0005, 3.00077}) {
    PassageDetector detector(2);
    std::optional<Passage> passage;
    for (int k = 0; k < 8000 && !passage; ++k) {
      passage = detector.Step(TrueTime(k * kStep), CalcDistance2(1e-3 * k, 0.6, 1.2, t0_s));
    }
    ASSERT_TRUE(passage);
    // a parabola through three of its points: rounding of d^2 over its curvature, and of the nanosecond
    EXPECT_NEAR(Seconds(passage->time), t0_s, 1e-8);
    EXPECT_NEAR(passage->distance_m, 1.2, 1e-12);
  }
}

TEST(PassageDetector, HearsNothingBeyondItsRange) {
  PassageDetector detector(1.1);
  for (int k = 0; k < 8000; ++k) {
    EXPECT_FALSE(detector.Step(TrueTime(k * kStep), CalcDistance2(1e-3 * k, 0.6, 1.2, 3)));
  }
  EXPECT_FALSE(detector.End());
}

TEST(PassageDetector, AVisitThatIsGoingOnAtTheEndCountsItsClosestStep) {
  PassageDetector detector(2);
  for (int k = 0; k <= 2000; ++k) {
    EXPECT_FALSE(detector.Step(TrueTime(k * kStep), CalcDistance2(1e-3 * k, 0.6, 1.2, 3)));
  }
  const auto passage = detector.End();
  ASSERT_TRUE(passage);
  EXPECT_EQ(passage->time, TrueTime(2000 * kStep));
  EXPECT_FALSE(detector.End());
}

TEST(PassageDetector, NoClosestApproachLiesBetweenTwoPipesThatDoNotMeet) {
  // by at 1.2 m, away to 1.9 m; then twenty metres jump in and out, as from one drawing into another
  PassageDetector detector(2);
  for (int k = 0; k <= 5400; ++k) {
    EXPECT_FALSE(detector.Step(TrueTime(k * kStep), CalcDistance2(1e-3 * k, 0.6, 1.2, 3)));
  }
  EXPECT_FALSE(detector.Step(TrueTime(5401 * kStep), 1.8 * 1.8));
  detector.Jump();
  const auto passage = detector.Step(TrueTime(5402 * kStep), 400);
  ASSERT_TRUE(passage);
  EXPECT_NEAR(Seconds(passage->time), 3, 1e-8);
  EXPECT_NEAR(passage->distance_m, 1.2, 1e-12);
}

TEST(PassageDetector, EveryVisitIsAPassageOfItsOwn) {
  PassageDetector detector(1.5);
  std::vector<double> times_s;
  for (int k = 0; k < 30000; ++k) {  // to and fro below the receiver: 2 sin(t), past it at k pi
    const double x = 2 * std::sin(1e-3 * k);
    if (const auto p = detector.Step(TrueTime(k * kStep), 1 + x * x)) times_s.push_back(Seconds(p->time));
  }
  ASSERT_EQ(times_s.size(), 10U);  // at 0 (the start), pi .. 9 pi; out of range again before 30 s
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    EXPECT_NEAR(times_s[i], static_cast<double>(i) * std::numbers::pi,
                1e-6);  // d^2 is no parabola: its fourth order
  }
}

}  // namespace
}  // namespace piperun::sim
