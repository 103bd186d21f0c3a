#include "base/check.h"

#include <gtest/gtest.h>

namespace piperun {
namespace {

TEST(InputError, SaysPlaceKeyAndProblemInThisOrder) {
  const InputError error("-1 is not allowed", "leaks[0].s_m", "run.yaml:12");
  EXPECT_STREQ(error.what(), "run.yaml:12: leaks[0].s_m: -1 is not allowed");
  EXPECT_EQ(error.problem(), "-1 is not allowed");
  EXPECT_EQ(error.key_path(), "leaks[0].s_m");
  EXPECT_EQ(error.where(), "run.yaml:12");
}

TEST(InputError, LeavesOutWhatIsNotKnown) {
  EXPECT_STREQ(InputError("no such file").what(), "no such file");
  EXPECT_STREQ(InputError("unknown", "flow").what(), "flow: unknown");
}

TEST(DemandDeathTest, ABrokenPromiseAbortsWithItsPlace) {
  EXPECT_DEATH(Demand(false, "states come in order"),
               "check_test.cc:[0-9]+: broken promise: states come in order");
}

TEST(Demand, AKeptPromiseIsSilent) {
  testing::internal::CaptureStderr();
  Demand(true, "never printed");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace piperun
