#include "base/time.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/support/any.h"

namespace piperun {
namespace {

TEST(Rate, KeepsMicroHertzExactly) {
  EXPECT_EQ(Rate(333.333333).micro_Hz(), 333'333'333);
  EXPECT_EQ(Rate(1e-6).micro_Hz(), 1);
  EXPECT_DOUBLE_EQ(Rate(400).Period_s(), 0.0025);
  EXPECT_EQ(Rate(400), Rate(400.0000001));
}

TEST(RateDeathTest, OutsideItsRangeAborts) {
  EXPECT_DEATH(Rate(0), "a rate lies between");
  EXPECT_DEATH(Rate(-1), "a rate lies between");
  EXPECT_DEATH(Rate(2e9), "a rate lies between");
  EXPECT_DEATH(Rate(std::nan("")), "a rate lies between");
}

TEST(SampleTime, IsExactWhenThePeriodIsWholeNanoseconds) {
  EXPECT_EQ(SampleTime(0, Rate(1000)).time_since_epoch().count(), 0);
  EXPECT_EQ(SampleTime(1, Rate(1000)).time_since_epoch().count(), 1'000'000);
  EXPECT_EQ(SampleTime(86'400'000'000, Rate(1000)).time_since_epoch(), std::chrono::days(1000));
}

// 1/44100 s = 22675.73696.. ns, worked out by hand
TEST(SampleTime, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(SampleOffset(1, Rate(44100)).count(), 22676);
  EXPECT_EQ(SampleOffset(2, Rate(44100)).count(), 45351);
  EXPECT_EQ(SampleOffset(3, Rate(44100)).count(), 68027);
  EXPECT_EQ(SampleOffset(44100, Rate(44100)).count(), 1'000'000'000);
  EXPECT_EQ(SampleOffset(-1, Rate(44100)).count(), -22676);
}

// 1e9 samples at 333.333333 Hz: 1e9 * 1e6/333333333 s = 3000000.003000000003 s
TEST(SampleTime, DoesNotDriftOverABillionSamples) {
  EXPECT_EQ(SampleOffset(1'000'000'000, Rate(333.333333)).count(), 3'000'000'003'000'000);
}

RC_GTEST_PROP(SampleTime, IsWithinHalfANanosecondOfTheRationalTime, ()) {
  const auto k = any::Integer<std::int64_t>(-1'000'000'000, 1'000'000'000);
  const Rate rate(any::Between(1, 100'000));
  // |ns * micro_Hz - k * 1e15| <= micro_Hz / 2, in integers
  const __int128 error = static_cast<__int128>(SampleOffset(k, rate).count()) * rate.micro_Hz() -
                         static_cast<__int128>(k) * 1'000'000'000'000'000;
  RC_ASSERT((error < 0 ? -error : error) * 2 <= rate.micro_Hz());
}

TEST(SampleTimeDeathTest, BeyondTheRangeOfNanosecondsAborts) {
  EXPECT_DEATH(SampleOffset(10'000'000'000, Rate(1e-6)), "64-bit nanoseconds");
}

TEST(FromSeconds, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(FromSeconds(1.25).count(), 1'250'000'000);
  EXPECT_EQ(FromSeconds(-0.1).count(), -100'000'000);
  EXPECT_EQ(FromSeconds(4e-10).count(), 0);
  EXPECT_DOUBLE_EQ(Seconds(FromSeconds(12.5)), 12.5);
}

TEST(FromSecondsDeathTest, NotANumberAborts) {
  EXPECT_DEATH(FromSeconds(std::nan("")), "64-bit nanoseconds");
}

TEST(ClockModel, AFastClockIsAheadByOffsetAndDrift) {
  const ClockModel clock{.offset = std::chrono::milliseconds(250), .drift_ppm = 20};
  // after one hour 20 ppm are 72 ms
  EXPECT_EQ(clock.ToRobot(TrueTime(std::chrono::hours(1))).time_since_epoch(),
            std::chrono::hours(1) + std::chrono::milliseconds(250 + 72));
  EXPECT_EQ(ClockModel{}.ToRobot(TrueTime(Duration(12345))).time_since_epoch().count(), 12345);
}

RC_GTEST_PROP(ClockModel, ToTrueInvertsToRobotWithinOneNanosecond, ()) {
  const auto day = Duration(std::chrono::days(1)).count();
  ClockModel clock;
  clock.offset = Duration(any::Integer(-day, day));
  clock.drift_ppm = any::Between(-200, 200);
  const std::int64_t ns = any::Integer(-day, day);
  RC_ASSERT(std::abs((clock.ToTrue(clock.ToRobot(TrueTime(Duration(ns)))).time_since_epoch().count() - ns)) <=
            1);
  RC_ASSERT(
      std::abs((clock.ToRobot(clock.ToTrue(RobotTime(Duration(ns)))).time_since_epoch().count() - ns)) <= 1);
}

}  // namespace
}  // namespace piperun
