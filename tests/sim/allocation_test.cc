// Counts heap allocations of a stepping world. glibc only, and not where a sanitizer owns malloc.
#include <gtest/gtest.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <atomic>
#include <cstddef>

#include "sim/ball_world.h"
#include "sim/bore.h"
#include "sim/hydraulics.h"
#include "sim/motion.h"
#include "sim/network/simulation.h"
#include "tests/support/features.h"
#include "tests/support/imu_scene.h"
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

TEST(BallAtFeature, StepsOverEveryKindWithoutAllocating) {
  testing::BoreNetwork line = testing::MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  testing::AddFeatures(line.bore, "joint", {{"s_m", 1.0}, {"offset_m", 0.001}});
  testing::AddFeatures(line.bore, "weld_bead", {{"s_m", 1.6}, {"height_m", 0.001}});
  testing::AddFeatures(line.bore, "service_hole", {{"s_m", 2.0}, {"clock_rad", 3.1}});
  testing::AddFeatures(line.bore, "gate_valve", {{"s_m", 2.5}, {"opening_m", 0.08}});
  testing::AddFeatures(line.bore, "scale", {{"s_m", 3.3}, {"height_m", 0.001}, {"height_sd_m", 0.0}});
  const Vector3d at(0.5, 0, -0.045);
  BallWorld world(line.bore, {0.03, 0.18, 4.5e-5, 0.4, 3e-4}, Rate(1000),
                  {{at, Quaterniond::Identity()},
                   Vector3d::Zero(),
                   Vector3d::Zero(),
                   testing::FindSpot(line.network, 0, at)},
                  [](const BallInstant& ball) {
                    return BallLoad{Vector3d(0.5 - 0.5 * ball.v_WB_W.x(), 0, -0.11), Vector3d::Zero()};
                  });
  const long before = allocations;
  while (world.state().X_LB.p.x() < 4 && Seconds(world.state().time) < 60) world.Step();
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GE(world.state().X_LB.p.x(), 4);
}

TEST(Imu, SamplesWithoutAllocating) {
  for (const char* digital : {"none", "boxcar", "low_pass_2"}) {
    const auto imu = testing::MakeImu({{"increments", true},
                                       {"gyro.filter.digital", std::string(digital)},
                                       {"gyro.noise_rad_s_sqrtHz", 1e-3},
                                       {"gyro.bias_instability_rad_s", 1e-3},
                                       {"gyro.quantisation_rad", 1e-6},
                                       {"accel.gauss_markov_sd_m_s2", 1e-3},
                                       {"sampling.jitter_s", 1e-4},
                                       {"sampling.loss_probability", 0.1},
                                       {"sampling.duplicate_probability", 0.1}});
    long before = 0;
    testing::Play(testing::Spinning({0, 20, 1}), *imu, Rate(1000), 400,
                  [&](std::int64_t k, const auto&, auto&) {
                    if (k == 0) before = allocations;
                  });
    EXPECT_GT(before, 0) << "the counter counts";
    EXPECT_EQ(allocations - before, 0) << digital;
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
