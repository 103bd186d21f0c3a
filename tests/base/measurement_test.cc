#include "base/measurement.h"

#include <gtest/gtest.h>

#include <vector>

namespace piperun {
namespace {

TEST(Measurement, HasTheStampOfWhateverItHolds) {
  const RobotTime t{Duration(123)};
  const std::vector<std::int32_t> counts{1, -1};
  EXPECT_EQ(Stamp({0, ImuSample{.stamp = t}}), t);
  EXPECT_EQ(Stamp({1, MagSample{.stamp = t}}), t);
  EXPECT_EQ(Stamp({2, PressureSample{.stamp = t}}), t);
  EXPECT_EQ(Stamp({2, TemperatureSample{.stamp = t}}), t);
  EXPECT_EQ(Stamp({3, AudioBlock{t, 16000, 1e-4, counts}}), t);
}

}  // namespace
}  // namespace piperun
