#include <gtest/gtest.h>

#include <cmath>

#include "base/check.h"
#include "sim/motion.h"
#include "sim/sensor.h"
#include "tests/support/set_params.h"

namespace piperun::sim {
namespace {

using testing::ParamValues;

struct Scene {
  static std::vector<PipeSpec> Pipes() {
    const WallMaterial pvc{"pvc", 3e9, 0.1, 0.4, 1400, 0};
    return {{"P1", "A", "B", 0.15, 0.005, 0.5, {{10, 0, 0}}, pvc},
            {"P2", "C", "B", 0.15, 0.005, 0.5, {}, pvc}};  // drawn against the way
  }
  Network network{{{"A", {0, 0, 0}}, {"B", {10, 6, 0}}, {"C", {10, 12, 0}}}, Pipes()};
  Route route{network, {{0, false}, {1, true}}};
  MotionContext context;

  Scene() {
    context.network = &network;
    context.route = &route;
  }
};

std::unique_ptr<Motion> MakeScripted(const ParamValues& values, const MotionContext& context) {
  const MotionKind& kind = testing::FindKind(MotionKinds(), "scripted");
  return kind.make(*testing::MakeParamsOf(kind, values), context);
}

const std::vector<double> kFarWaypoints{0, 100, -100, 50, 0,   0,   0,  //
                                        2, 101, -99,  50, 0.5, 0.2, 0,  //
                                        4, 104, -99,  51, 3,   1.5, 2,  //
                                        5, 104, -99,  51, 9,   1.5, 4,  //
                                        7, 104, -99,  51, 9,   1.5, 4,  //
                                        9, 100, -97,  50, 12,  -2,  9};

const ParamValues kRolling{{"script", std::string("rolling")},
                           {"rolling.vertices_m", std::vector<double>{0, 0, 9, 0, 9, 6, 0, 6}},
                           {"rolling.speed_m_s", 0.9},
                           {"rolling.speed_modulation", 0.15},
                           {"rolling.speed_modulation_cycles", 6.0}};

/// Runs a motion to its end with an ideal IMU at a lever arm and re-integrates its increments independently.
/// Returns the distance between the end points.
double ClosureError(Motion& motion, const Vector3d& l, double* attitude_error) {
  const SensorKind& kind = testing::FindKind(SensorKinds(), "imu");
  const auto params = testing::MakeParamsOf(kind, {{"rate_Hz", motion.rate().Hz()},
                                                   {"increments", true},
                                                   {"lever_arm_m", std::vector<double>{l.x(), l.y(), l.z()}},
                                                   {"mounting_rad", std::vector<double>{0.3, -2, 1}}});
  const Vector3d g_W(0, 0, -9.80665);
  const auto imu = kind.make(*params, {RandomStream(1, "imu0", 0), {}, g_W, motion.rate()});
  const Pose X_BS = imu->X_BS();
  const double dt = motion.rate().Period_s();

  TruthWindow window(motion.rate(), 8);
  window.Push(motion.state());
  Quaterniond q = motion.state().X_WB.q * X_BS.q;
  Vector3d p = motion.state().X_WB * l;
  Vector3d v = motion.state().v_WB_W + motion.state().X_WB.q * motion.state().w_WB_B.cross(l);
  for (std::int64_t k = 0; motion.status() == MotionStatus::kRunning; ++k) {
    motion.Step();
    window.Push(motion.state());
    const auto sample = std::get<ImuSample>(imu->Sample(k, window));
    v += q * sample.increments->dv_S_m_s + dt * g_W;
    p += dt * v;
    q = q * ExpSO3(sample.increments->dtheta_S_rad);
  }
  *attitude_error = LogSO3(q.conjugate() * motion.state().X_WB.q * X_BS.q).norm();
  return (p - motion.state().X_WB * l).norm();
}

void ExpectStepsAddUp(Motion& motion) {
  const double dt = motion.rate().Period_s();
  for (std::int64_t k = 1; motion.status() == MotionStatus::kRunning; ++k) {
    const TruthState before = motion.state();
    motion.Step();
    const TruthState& now = motion.state();
    ASSERT_EQ(now.time, SampleTime(k, motion.rate()));
    ASSERT_LT((before.X_WB.p + dt * now.v_step_W - now.X_WB.p).norm(), 2e-13) << k;
    ASSERT_LT(LogSO3((before.X_WB.q * ExpSO3(now.dtheta_B_rad)).conjugate() * now.X_WB.q).norm(), 2e-15) << k;
    ASSERT_NEAR(now.X_WB.q.norm(), 1, 1e-14);
  }
}

TEST(Scripted, TheVelocityOfAStepLeadsFromPoseToPose) {
  for (const double hertz : {1000.0, 300.0, 777.0}) {
    const auto waypoints = MakeScripted({{"script", std::string("waypoints")},
                                         {"waypoints.poses_s_m_rad", kFarWaypoints},
                                         {"rate_Hz", hertz}},
                                        {});
    ExpectStepsAddUp(*waypoints);
    ParamValues rolling = kRolling;
    rolling["rate_Hz"] = hertz;
    ExpectStepsAddUp(*MakeScripted(rolling, {}));
  }
}

TEST(Scripted, IncrementsOfAnIdealImuCloseToRounding) {
  const Vector3d l(0.006, -0.004, 0.002);
  double attitude = 0;
  const auto waypoints =
      MakeScripted({{"script", std::string("waypoints")}, {"waypoints.poses_s_m_rad", kFarWaypoints}}, {});
  EXPECT_LT(ClosureError(*waypoints, l, &attitude), 1e-10);
  EXPECT_LT(attitude, 1e-12);
  const auto rolling = MakeScripted(kRolling, {});
  EXPECT_LT(ClosureError(*rolling, l, &attitude), 1e-8);
  EXPECT_LT(attitude, 1e-11);
  Scene scene;
  const auto walk = MakeScripted(
      {{"script", std::string("walk")}, {"walk.wobble_m", 0.02}, {"walk.wobble_rad", 0.05}}, scene.context);
  EXPECT_LT(ClosureError(*walk, l, &attitude), 1e-9);
  EXPECT_LT(attitude, 1e-12);
}

TEST(Scripted, SpecificForceIsAccelerationMinusGravityInTheBall) {
  // Within a cubic piece the difference of the two steps' mean velocities is dt times the acceleration
  // between them, exactly; across one of the ten knots it is off by the jump of the jerk times dt / 6.
  const auto motion =
      MakeScripted({{"script", std::string("waypoints")}, {"waypoints.poses_s_m_rad", kFarWaypoints}}, {});
  const double dt = 1e-3;
  int across_knots = 0;
  motion->Step();
  while (motion->status() == MotionStatus::kRunning) {
    const TruthState now = motion->state();
    motion->Step();
    const Vector3d f_W = (motion->state().v_step_W - now.v_step_W) / dt + Vector3d(0, 0, 9.80665);
    const double error = (now.X_WB.q * now.f_WB_B - f_W).norm();
    across_knots += error > 1e-10;
    ASSERT_LT(error, 5e-3);
  }
  EXPECT_LE(across_knots, 2 * 10);
}

TEST(Scripted, RestsForItsDurationAndThenHasArrived) {
  const auto motion = MakeScripted({{"script", std::string("rest")},
                                    {"rest.duration_s", 0.25},
                                    {"rest.position_m", std::vector<double>{1, 2, 3}},
                                    {"rest.yaw_pitch_roll_rad", std::vector<double>{0, M_PI / 2, 0}}},
                                   {});
  int steps = 0;
  for (; motion->status() == MotionStatus::kRunning; ++steps) {
    EXPECT_LT((motion->state().f_WB_B - Vector3d(-9.80665, 0, 0)).norm(), 1e-14);  // nose down
    EXPECT_EQ(motion->state().v_WB_W, Vector3d(0, 0, 0));
    motion->Step();
  }
  EXPECT_EQ(steps, 250);
  EXPECT_EQ(motion->status(), MotionStatus::kArrived);
  EXPECT_EQ(motion->state().time, TrueTime(Duration(250'000'000)));
  EXPECT_EQ(motion->state().X_WB.p, Vector3d(1, 2, 3));
  EXPECT_FALSE(motion->state().contact);
}

TEST(Scripted, WithoutARouteTheChainageIsTheDistanceTravelled) {
  const auto motion = MakeScripted(kRolling, {});
  EXPECT_EQ(motion->state().chainage_m, 0);
  while (motion->status() == MotionStatus::kRunning) motion->Step();
  // perimeter 30, four corners of radius 0.5; chords are shorter than arcs by (v dt / R)^2 / 24
  EXPECT_NEAR(motion->state().chainage_m, 30 - 4 * (2 - M_PI / 2) * 0.5, 1e-6);
  EXPECT_EQ(motion->state().pipe, -1);
  EXPECT_TRUE(motion->state().contact);
}

TEST(Scripted, AWalkTellsWhereItIsAlongTheRoute) {
  Scene scene;
  const auto motion = MakeScripted({{"script", std::string("walk")}, {"walk.rest_s", 0.0}}, scene.context);
  EXPECT_EQ(motion->state().pipe, 0);
  EXPECT_NEAR(motion->state().chainage_m, 0, 1e-12);
  double before = 0;
  while (motion->status() == MotionStatus::kRunning) {
    motion->Step();
    const TruthState& s = motion->state();
    ASSERT_GE(s.chainage_m, before - 1e-12);
    before = s.chainage_m;
    const double second = scene.network.pipe(0).length_m;
    ASSERT_EQ(s.pipe, s.chainage_m < second ? 0 : 1);
    ASSERT_NEAR(s.s_m, s.pipe == 0 ? s.chainage_m : 6 - (s.chainage_m - second), 1e-9);
  }
  EXPECT_NEAR(before, scene.route.length_m(), 1e-9);
}

TEST(Scripted, WaterIsThatOfTheRoute) {
  Scene scene;
  const double area = scene.network.pipe(0).area_m2();
  FlowState state;
  state.pipes = {{{0, scene.network.pipe(0).length_m, 0.01, 40, 38, 0.02}}, {{0, 6, -0.01, 37, 38, 0.02}}};
  const FlowTimeline flow({area, area}, {TrueTime{}}, {state});
  scene.context.flow = &flow;
  scene.context.water = CalcWater(15);
  const auto motion = MakeScripted({{"script", std::string("walk")}, {"walk.height_m", 1.5}}, scene.context);
  // start: head 40 m at 1.5 m above the axis (z = 0)
  const double rho_g = scene.context.water.density_kg_m3 * 9.80665;
  EXPECT_NEAR(motion->state().pressure_Pa, rho_g * 38.5, 1e-6);
  EXPECT_NEAR(motion->state().water_speed_m_s, 0.01 / area, 1e-12);
  while (motion->status() == MotionStatus::kRunning) {
    motion->Step();
    const TruthState& s = motion->state();
    const Vector3d water_W = s.v_slip_W + s.v_WB_W;  // along the way, in the reversed pipe too
    ASSERT_NEAR(water_W.norm(), 0.01 / area, 1e-12);
    if (s.v_WB_W.norm() > 0.1) {
      ASSERT_NEAR(water_W.normalized().dot(s.v_WB_W.normalized()), 1, 1e-3);
    }
  }
  EXPECT_NEAR(motion->state().pressure_Pa, rho_g * 35.5, 1e-6);
  EXPECT_NEAR(motion->state().water_speed_m_s, 0.01 / area,
              1e-12);  // still along the route in the reversed pipe
}

TEST(Scripted, ALoopOnARouteStartsAtItsBeginning) {
  const WallMaterial pvc{"pvc", 3e9, 0.1, 0.4, 1400, 0};
  const PipeSpec loop{"P1", "A", "B", 0.15, 0.005, 0.5, {{10, 0, 0}, {10, 10, 0}, {0, 10, 0}}, pvc};
  const Network network({{"A", {0, 0, 0}}, {"B", {0, 0, 0}}}, {loop});
  const Route route(network, {{0, false}});
  MotionContext context;
  context.network = &network;
  context.route = &route;
  const auto motion = MakeScripted({{"script", std::string("walk")}}, context);
  EXPECT_NEAR(motion->state().chainage_m, 0, 1e-9);
  while (motion->status() == MotionStatus::kRunning) motion->Step();
  EXPECT_NEAR(motion->state().chainage_m, route.length_m(), 1e-9);
}

TEST(Scripted, IsDeterministic) {
  const auto a = MakeScripted(kRolling, {}), b = MakeScripted(kRolling, {});
  while (a->status() == MotionStatus::kRunning) {
    a->Step();
    b->Step();
    ASSERT_EQ(a->state().X_WB.p, b->state().X_WB.p);
    ASSERT_EQ(a->state().X_WB.q.coeffs(), b->state().X_WB.q.coeffs());
    ASSERT_EQ(a->state().v_step_W, b->state().v_step_W);
  }
  EXPECT_EQ(b->status(), MotionStatus::kArrived);
}

TEST(Scripted, AWalkNeedsARoute) {
  try {
    MakeScripted({{"script", std::string("walk")}}, {});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.key_path(), "script");
  }
}

}  // namespace
}  // namespace piperun::sim
