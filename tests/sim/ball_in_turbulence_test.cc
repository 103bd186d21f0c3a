// The ball in water that fluctuates, through the motion that tells it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "sim/bore.h"
#include "sim/fluid_load.h"
#include "sim/motion.h"
#include "sim/stream_fluctuations.h"
#include "tests/support/pipes.h"
#include "tests/support/set_params.h"

namespace piperun::sim {
namespace {

using testing::MakePipeSpec;

/// A network with steady water of given mean speeds in its pipes, and a ball to launch into pipe 0.
struct Water {
  Network network;
  Bore bore;
  FlowTimeline flow;
  MotionContext context;

  Water(Network made, const std::vector<double>& speeds_m_s)
      : network(std::move(made)), bore(network), flow(MakeFlow(network, speeds_m_s)) {
    context.seed = 11;
    context.water = {20, 1000, 1e-6, 1482};
    context.network = &network;
    context.bore = &bore;
    context.flow = &flow;
  }
  Water(const Water&) = delete;
  Water& operator=(const Water&) = delete;

  static FlowTimeline MakeFlow(const Network& network, const std::vector<double>& speeds_m_s) {
    std::vector<double> areas_m2;
    FlowState state;
    for (std::size_t i = 0; i < speeds_m_s.size(); ++i) {
      const Pipe& pipe = network.pipes()[i];
      areas_m2.push_back(pipe.area_m2());
      state.pipes.push_back({{0, pipe.length_m, speeds_m_s[i] * pipe.area_m2(), 50, 50, 0.0201}});
    }
    return FlowTimeline(std::move(areas_m2), {TrueTime{}}, {std::move(state)});
  }
  std::unique_ptr<Motion> Launch(const testing::ParamValues& values) const {
    const MotionKind& kind = testing::FindKind(MotionKinds(), "ball_in_pipe");
    return kind.make(*testing::MakeParamsOf(kind, values), context);
  }
};

const testing::ParamValues kAll{{"stream.turbulence.on", true}, {"stream.swirl_switching", true}};

/// Along x to a tee at (2, 0, 0), aside along y, and up a riser at (2, 2, 0).
Network MakeTeeAndRiser() {
  return Network({{"A", {0, 0, 0}}, {"T", {2, 0, 0}}, {"B", {5, 0, 0}}, {"C", {2, 2, 3}}},
                 {MakePipeSpec("P", "A", "T"), MakePipeSpec("Q", "T", "B"),
                  MakePipeSpec("R", "T", "C", {.bend_radius_m = 0.3}, {{2, 2, 0}})});
}

/// Independent strapdown: v += q dv + g dt, p += v dt, q = q exp(dtheta).
struct Strapdown {
  Vector3d p, v;
  Quaterniond q;
  void Feed(const Vector3d& dtheta, const Vector3d& dv, const Vector3d& g, double dt) {
    v += q * dv + g * dt;
    p += v * dt;
    const double angle = dtheta.norm();
    if (angle > 0) q = (q * Quaterniond(Eigen::AngleAxisd(angle, dtheta / angle))).normalized();
  }
};

TEST(BallInTurbulence, StrapdownClosesThroughTeeAndRiser) {
  Water water(MakeTeeAndRiser(), {1, 0, 1});
  water.context.retrieve_node = 3;
  const auto motion = water.Launch(kAll);
  const Vector3d g = water.context.gravity_W;
  const double dt = 1e-3;
  Strapdown strapdown{motion->state().X_WB.p, motion->state().v_WB_W, motion->state().X_WB.q};
  Vector3d v_before = motion->state().v_step_W;
  while (motion->status() == MotionStatus::kRunning) {
    const Quaterniond q_before = motion->state().X_WB.q;
    motion->Step();
    const TruthState& state = motion->state();
    strapdown.Feed(state.dtheta_B_rad, q_before.conjugate() * (state.v_step_W - v_before - g * dt), g, dt);
    v_before = state.v_step_W;
  }
  ASSERT_EQ(motion->status(), MotionStatus::kArrived);
  const double closure_m = (strapdown.p - motion->state().X_WB.p).norm();
  EXPECT_LT(closure_m, 1e-6);
  std::printf("closure %.2g m after %.1f s\n", closure_m, Seconds(motion->state().time - TrueTime{}));
}

TEST(BallInTurbulence, RunsAreReproducedAndSeedsDiffer) {
  Water water(MakeTeeAndRiser(), {1, 0, 1});
  const auto a = water.Launch(kAll), b = water.Launch(kAll);
  for (int i = 0; i < 3000; ++i) {
    a->Step();
    b->Step();
    ASSERT_EQ(a->state().f_WB_B, b->state().f_WB_B);
  }
  water.context.run = 1;
  const auto other = water.Launch(kAll);
  for (int i = 0; i < 3000; ++i) other->Step();
  EXPECT_NE(a->state().X_WB.p, other->state().X_WB.p);
}

/// Root mean square of the specific force less gravity of the reference ball in a straight pipe, and the
/// mean of its speed, from 20 s to 90 s.
struct Ride {
  Vector3d rms_m_s2 = Vector3d::Zero();
  double speed_m_s = 0, speed_sd_m_s = 0;
};

Ride RideStraight(double rate_Hz, bool turbulence) {
  const Water water(Network({{"A", {0, 0, 0}}, {"B", {120, 0, 0}}}, {MakePipeSpec("P", "A", "B")}), {1});
  const auto motion = water.Launch({{"rate_Hz", rate_Hz}, {"stream.turbulence.on", turbulence}});
  Ride ride;
  double count = 0, speed2 = 0;
  while (motion->status() == MotionStatus::kRunning && motion->state().time < TrueTime{FromSeconds(90)}) {
    motion->Step();
    if (motion->state().time < TrueTime{FromSeconds(20)}) continue;
    const TruthState& state = motion->state();
    ride.rms_m_s2 += (state.X_WB.q * state.f_WB_B + water.context.gravity_W).cwiseAbs2();
    ride.speed_m_s += state.v_WB_W.x();
    speed2 += state.v_WB_W.x() * state.v_WB_W.x();
    ++count;
  }
  ride.rms_m_s2 = (ride.rms_m_s2 / count).cwiseSqrt();
  ride.speed_m_s /= count;
  ride.speed_sd_m_s = std::sqrt(speed2 / count - ride.speed_m_s * ride.speed_m_s);
  return ride;
}

TEST(BallInTurbulence, ReferenceBallFeelsMilligravitiesAtAnyRateSlow) {
  // estimate by hand: along the pipe sigma_s f u*/sqrt(T1 T2) = 1.18 0.56 0.0501/(0.3 0.81) = 0.137 m/s2 of
  // the water, times (rho V + m_a)/(m + m_a + I/r^2) = 0.183/0.244 for a ball that rolls: 0.10
  for (const double rate_Hz : {1000.0, 4000.0}) {
    const Ride ride = RideStraight(rate_Hz, true);
    std::printf("%g Hz: rms %.4f %.4f %.4f m/s2 = %.1f mg, speed %.4f +- %.4f m/s\n", rate_Hz,
                ride.rms_m_s2.x(), ride.rms_m_s2.y(), ride.rms_m_s2.z(), ride.rms_m_s2.norm() / 9.80665e-3,
                ride.speed_m_s, ride.speed_sd_m_s);
    EXPECT_NEAR(ride.rms_m_s2.x() / 0.10, 1, 0.2);
    EXPECT_GT(ride.rms_m_s2.norm(), 3 * 9.8e-3);
    EXPECT_LT(ride.rms_m_s2.norm(), 20 * 9.8e-3);
    EXPECT_LT(ride.speed_sd_m_s / ride.speed_m_s, 0.2) << "published: up to 20 %";
  }
  EXPECT_LT(RideStraight(1000, false).rms_m_s2.norm(), 1e-3);
}

}  // namespace
}  // namespace piperun::sim
