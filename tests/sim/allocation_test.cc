// Counts heap allocations of a stepping world. glibc only, and not where a sanitizer owns malloc.
#include <gtest/gtest.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <atomic>
#include <cstddef>

#include "sim/bore.h"
#include "sim/hydraulics.h"
#include "sim/motion.h"
#include "sim/network/simulation.h"
#include "tests/support/networks.h"
#include "tests/support/pipes.h"

namespace {
std::atomic<long> allocations{0};
}

extern "C" void* __libc_malloc(std::size_t);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace piperun::sim {
namespace {

TEST(BallInPipe, StepsWithoutAllocating) {
  const testing::PipeLine line = testing::MakePipeLine({{0, 0, 0}, {2, 0, 0}, {2, 2, 0.3}});
  const WaterProperties water = CalcWater(15);
  const Bore bore(line.network);
  const SteadyFlow flow = SolveSteadyFlow(line.network, line.route, {0.014, 5e5}, {}, water, 9.80665);
  MotionContext context;
  context.water = water;
  context.network = &line.network;
  context.route = &line.route;
  context.bore = &bore;
  context.flow = &flow.timeline;
  context.launch = {0, false};
  context.retrieve_node = 1;
  for (const MotionKind& kind : MotionKinds()) {
    if (kind.name != "ball_in_pipe") continue;
    const long at_first = allocations;
    const auto motion = kind.make(*kind.make_params(), context);
    const long before = allocations;
    EXPECT_GT(before, at_first) << "the counter counts";
    while (motion->status() == MotionStatus::kRunning) motion->Step();
    EXPECT_EQ(allocations - before, 0);
  }
}

TEST(HydraulicSolver, SolvesWithoutAllocating) {
  for (const char* name : {"town.inp", "valves.inp", "leakage.inp", "laws_dw_cmh.inp"}) {
    const HydraulicModel model = piperun::testing::ReadOwnNetwork(name);
    HydraulicSimulation simulation(model);
    const long before = allocations;
    const bool converged = simulation.Solve().converged();
    EXPECT_EQ(allocations - before, 0) << name;
    EXPECT_TRUE(converged) << name;
  }
}

}  // namespace
}  // namespace piperun::sim

#endif
