#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/check.h"
#include "sim/rolling_script.h"
#include "sim/speed_profile.h"
#include "sim/walk_script.h"
#include "sim/waypoint_script.h"
#include "sim/yaw_pitch_roll.h"

namespace piperun::sim {
namespace {

constexpr double kPi = std::numbers::pi;

/// w_WB_B by a centred difference of the attitude.
Vector3d DifferenceRate(const Script& script, double t, double h) {
  return LogSO3(script.Eval(t - h).X_WB.q.conjugate() * script.Eval(t + h).X_WB.q) / (2 * h);
}

void ExpectConsistentKinematics(const Script& script, double t) {
  const double h = 1e-4;
  const ScriptPoint a = script.Eval(t - h), b = script.Eval(t + h), p = script.Eval(t);
  EXPECT_LT(((b.X_WB.p - a.X_WB.p) / (2 * h) - p.v_WB_W).norm(), 3e-6) << t;
  EXPECT_LT(((b.v_WB_W - a.v_WB_W) / (2 * h) - p.a_WB_W).norm(), 1e-4) << t;
  EXPECT_LT((DifferenceRate(script, t, h) - p.w_WB_B).norm(), 2e-5) << t;
}

bool NearKnot(const Script& script, double t) {
  for (const double knot : script.knots_s()) {
    if (std::abs(knot - t) < 2e-4) return true;
  }
  return false;
}

std::string KeyOfError(const std::function<void()>& make) {
  try {
    make();
  } catch (const InputError& e) {
    return e.key_path();
  }
  return "no error";
}

// --- angles -----------------------------------------------------------------------------------------------

TEST(YawPitchRoll, TurnsInTheStatedOrder) {
  // yaw 90: nose north; pitch -90 would point it up: with pitch 90 nose down
  EXPECT_LT((CalcAttitude({kPi / 2, 0, 0}) * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((CalcAttitude({kPi / 2, kPi / 2, 0}) * Vector3d::UnitX() + Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((CalcAttitude({kPi / 2, 0, kPi / 2}) * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-15);
}

TEST(YawPitchRoll, BodyRateIsThatOfTheAttitude) {
  const Vector3d angles(0.7, -1.2, 2.5), rates(0.9, 1.7, -0.4);
  const double h = 1e-5;
  const Vector3d difference =
      LogSO3(CalcAttitude(angles - h * rates).conjugate() * CalcAttitude(angles + h * rates)) / (2 * h);
  EXPECT_LT((CalcBodyRate(angles, rates) - difference).norm(), 1e-9);
}

// --- speed profile ----------------------------------------------------------------------------------------

TEST(SpeedProfile, CoversItsDistanceSmoothly) {
  const SpeedProfile profile(10, 2, 1.5);
  EXPECT_DOUBLE_EQ(profile.duration_s(), 6.5);
  EXPECT_NEAR(profile.Eval(1.5).s_m, 0.5 * 2 * 1.5, 1e-14);  // the ramp is symmetric
  EXPECT_NEAR(profile.Eval(0.75).v_m_s, 1, 1e-14);
  EXPECT_NEAR(profile.Eval(0.75).a_m_s2, 1.875 * 2 / 1.5, 1e-14);  // peak of the minimum-jerk polynomial
  EXPECT_EQ(profile.Eval(6.5).s_m, 10);
  EXPECT_EQ(profile.Eval(6.5).v_m_s, 0);
  const double h = 1e-5;
  for (double t = 0.05; t < 6.5; t += 0.1) {
    const PathPoint a = profile.Eval(t - h), b = profile.Eval(t + h), p = profile.Eval(t);
    EXPECT_NEAR((b.s_m - a.s_m) / (2 * h), p.v_m_s, 1e-8);
    EXPECT_NEAR((b.v_m_s - a.v_m_s) / (2 * h), p.a_m_s2, 1e-8);
  }
  for (const double t : {1.5, 5.0})
    EXPECT_NEAR(profile.Eval(t - 1e-9).a_m_s2, profile.Eval(t + 1e-9).a_m_s2, 1e-12);
}

// --- waypoints --------------------------------------------------------------------------------------------

WaypointParams SomeWaypoints() {
  return {{0, 0, 0, 1, 0,   0,   0,    //
           2, 1, 0, 1, 0.5, 0,   0.2,  //
           3, 1, 0, 1, 2,   0.1, 0.2,  // turns on the spot
           5, 1, 0, 1, 2,   0.1, 0.2,  // stands
           7, 2, 3, 0, 8,   1.5, -1,   //
           8, 2, 4, 0, 8,   1.7, -2}};
}

TEST(WaypointScript, PassesThroughItsPoses) {
  const WaypointParams params = SomeWaypoints();
  const WaypointScript script(params);
  EXPECT_EQ(script.duration_s(), 8);
  for (std::size_t i = 0; i < params.poses_s_m_rad.size(); i += 7) {
    const double* row = &params.poses_s_m_rad[i];
    const ScriptPoint p = script.Eval(row[0]);
    EXPECT_LT((p.X_WB.p - Vector3d(row[1], row[2], row[3])).norm(), 1e-14);
    EXPECT_LT(LogSO3(p.X_WB.q.conjugate() * CalcAttitude({row[4], row[5], row[6]})).norm(), 1e-14);
  }
}

TEST(WaypointScript, StopsAreTrueStops) {
  const WaypointScript script(SomeWaypoints());
  for (const double t : {2.0, 2.5, 3.0, 4.0, 4.999}) {
    EXPECT_EQ(script.Eval(t).v_WB_W, Vector3d(0, 0, 0)) << t;
    EXPECT_EQ(script.Eval(t).X_WB.p, Vector3d(1, 0, 1)) << t;
  }
  EXPECT_GT(script.Eval(2.5).w_WB_B.norm(), 1);
  for (const double t : {3.0, 4.0, 4.999}) EXPECT_EQ(script.Eval(t).w_WB_B, Vector3d(0, 0, 0)) << t;
}

TEST(WaypointScript, GivesConsistentKinematics) {
  const WaypointScript script(SomeWaypoints());
  for (double t = 0.0131; t < 8; t += 0.0397) {
    if (!NearKnot(script, t)) ExpectConsistentKinematics(script, t);
  }
}

TEST(WaypointScript, HasNoJumpInVelocityRateOrAcceleration) {
  const WaypointScript script(SomeWaypoints());
  for (const double t : script.knots_s()) {
    const ScriptPoint a = script.Eval(std::nextafter(t, -1)), b = script.Eval(t);
    EXPECT_LT((a.v_WB_W - b.v_WB_W).norm(), 1e-13);
    EXPECT_LT((a.a_WB_W - b.a_WB_W).norm(), 1e-12);
    EXPECT_LT((a.w_WB_B - b.w_WB_B).norm(), 1e-12);
    // angular acceleration: one-sided differences agree to the jump of its derivative times the step
    if (t < 1e-3 || t > 8 - 1e-3) continue;
    const double h = 1e-5;
    const Vector3d before = (b.w_WB_B - script.Eval(t - h).w_WB_B) / h;
    const Vector3d after = (script.Eval(t + h).w_WB_B - b.w_WB_B) / h;
    EXPECT_LT((after - before).norm(), 2e-3) << t;
  }
}

TEST(WaypointScript, RefusesImpossibleTables) {
  const std::string key = "waypoints.poses_s_m_rad";
  EXPECT_EQ(KeyOfError([] { WaypointScript(WaypointParams{}); }), key);
  EXPECT_EQ(KeyOfError([] { WaypointScript(WaypointParams{{0, 0, 0, 0, 0, 0, 0}}); }), key);
  EXPECT_EQ(KeyOfError([] {
              WaypointScript(WaypointParams{{1, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0}});
            }),
            key);
  EXPECT_EQ(KeyOfError([] {
              WaypointScript(WaypointParams{{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}});
            }),
            key);
}

// --- rolling ----------------------------------------------------------------------------------------------

constexpr double kBallRadius_m = 0.03;

RollingParams SomeLoop() {
  RollingParams p;
  p.vertices_m = {0, 0, 8, 0, 8, 3, 5, 3, 5, 6, 0, 6};  // an L: five left turns, one right
  p.corner_radius_m = 0.5;
  p.speed_m_s = 0.6;
  p.speed_modulation = 0.15;
  p.speed_modulation_cycles = 9;
  p.plane_z_m = 2;
  p.yaw_pitch_roll_rad = {0.4, 0.2, -0.7};
  return p;
}

TEST(RollingScript, ClosesAndHasTheLengthOfARoundedPolygon) {
  const RollingScript script(SomeLoop(), kBallRadius_m);
  // perimeter 28, six corners: each replaces 2 r by pi r / 2
  EXPECT_NEAR(script.length_m(), 28 - 6 * (2 - kPi / 2) * 0.5, 1e-13);
  const ScriptPoint start = script.Eval(0), end = script.Eval(script.duration_s());
  EXPECT_LT((start.X_WB.p - Vector3d(4, 0, 2 + kBallRadius_m)).norm(), 1e-15);
  EXPECT_LT((end.X_WB.p - start.X_WB.p).norm(), 1e-13);
  EXPECT_EQ(end.v_WB_W, Vector3d(0, 0, 0));
  EXPECT_LT(LogSO3(start.X_WB.q.conjugate() * CalcAttitude({0.4, 0.2, -0.7})).norm(), 1e-15);
}

TEST(RollingScript, NeitherSlipsNorPivots) {
  const RollingScript script(SomeLoop(), kBallRadius_m);
  double fastest = 0;
  for (double t = 0; t < script.duration_s(); t += 0.0173) {
    const ScriptPoint p = script.Eval(t);
    const Vector3d w_W = p.X_WB.q * p.w_WB_B;
    const Vector3d contact_velocity = p.v_WB_W + w_W.cross(Vector3d(0, 0, -kBallRadius_m));
    // 0.7 m/s turned into B and back: some tens of roundings of 1e-16
    EXPECT_LT(contact_velocity.norm(), 1e-14) << t;
    EXPECT_LT((kBallRadius_m * w_W.cross(Vector3d::UnitZ()) - p.v_WB_W).norm(), 1e-14) << t;
    EXPECT_NEAR(w_W.z(), 0, 1e-13) << t;
    EXPECT_EQ(p.X_WB.p.z(), 2 + kBallRadius_m);
    fastest = std::max(fastest, p.v_WB_W.norm());
  }
  EXPECT_NEAR(fastest, 0.6 * 1.15, 1e-3);
}

TEST(RollingScript, GivesConsistentKinematics) {
  const RollingScript script(SomeLoop(), kBallRadius_m);
  for (double t = 0.0131; t < script.duration_s() - 0.1; t += 0.0797) {
    if (!NearKnot(script, t)) ExpectConsistentKinematics(script, t);
  }
}

/// Turns the ball round the loop by the midpoint rule of the exponential map and compares the end attitudes.
double MidpointAttitudeError(const Script& script, int n) {
  const double dt = script.duration_s() / n;
  Quaterniond q = script.Eval(0).X_WB.q;
  for (int i = 0; i < n; ++i) q = q * ExpSO3(dt * script.Eval((i + 0.5) * dt).w_WB_B);
  return LogSO3(q.conjugate() * script.Eval(script.duration_s()).X_WB.q).norm();
}

TEST(RollingScript, AttitudeIsTheIntegralOfTheRate) {
  // the rule is of second order: its error must vanish as 1 / n^2 on the closed form, and on nothing else
  const RollingScript script(SomeLoop(), kBallRadius_m);
  const double coarse = MidpointAttitudeError(script, 100'000), fine = MidpointAttitudeError(script, 200'000);
  EXPECT_NEAR(coarse / fine, 4, 0.02);
  EXPECT_LT(fine, 1e-5);
}

TEST(RollingScript, RestsBeforeAndAfter) {
  RollingParams p = SomeLoop();
  p.rest_s = 3;
  const RollingScript script(p, kBallRadius_m);
  for (const double t : {0.0, 2.9, script.duration_s() - 2.9, script.duration_s()}) {
    EXPECT_EQ(script.Eval(t).v_WB_W.norm(), 0) << t;
    EXPECT_EQ(script.Eval(t).w_WB_B.norm(), 0) << t;
  }
  EXPECT_GT(script.Eval(3.2).v_WB_W.norm(), 0);
}

TEST(RollingScript, RefusesImpossibleLoops) {
  const auto key = [](auto change) {
    RollingParams p = SomeLoop();
    change(p);
    return KeyOfError([&] { RollingScript(p, kBallRadius_m); });
  };
  EXPECT_EQ(key([](RollingParams& p) { p.vertices_m = {0, 0, 1, 1}; }), "rolling.vertices_m");
  EXPECT_EQ(key([](RollingParams& p) { p.corner_radius_m = 2; }), "rolling.vertices_m");
  EXPECT_EQ(key([](RollingParams& p) { p.acceleration_time_s = 60; }), "rolling.acceleration_time_s");
}

// --- walk -------------------------------------------------------------------------------------------------

/// 10 m east, 8 m north round a bend of 0.5 m, 6 m east again.
Route BentRoute() {
  WallMaterial pvc;
  pvc.name = "pvc", pvc.young_modulus_Pa = 3e9, pvc.density_kg_m3 = 1400;
  PipeSpec pipe{"P1", "A", "B", 0.15, 0.005, 0.5, {{10, 0, 0}, {10, 8, 0}}, pvc};
  static const Network network({{"A", {0, 0, 0}}, {"B", {16, 8, 0}}}, {pipe});
  return Route(network, {{0, false}});
}

TEST(WalkScript, FollowsTheRouteAtItsHeight) {
  const Route route = BentRoute();
  WalkParams params;
  params.height_m = 1.2;
  const WalkScript script(params, route);
  double farthest = 0;
  for (double t = 0; t < script.duration_s(); t += 0.0103) {
    const Vector3d p = script.Eval(t).X_WB.p - Vector3d(0, 0, 1.2);
    double nearest = 1;
    for (const RoutePiece& piece : route.pieces()) {
      const double s = std::clamp(FindNearest(piece.line, p), piece.line.s_begin_m, piece.line.s_end_m());
      nearest = std::min(nearest, (EvalCentreline(piece.line, s).p_W - p).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, 2e-4);
  EXPECT_LT((script.Eval(script.duration_s()).X_WB.p - Vector3d(16, 8, 1.2)).norm(), 1e-12);
}

TEST(WalkScript, StopsAfterEveryLeg) {
  const Route route = BentRoute();
  WalkParams params;
  params.leg_length_m = 8;  // route of 23.14 m: three legs of 7.71 m
  params.stop_s = 3;
  params.rest_s = 1;
  const WalkScript script(params, route);
  const double leg_s = route.length_m() / 3 + 1;  // at 1 m/s, one second of ramps
  EXPECT_NEAR(script.duration_s(), 3 * leg_s + 2 * 3 + 2 * 1, 1e-12);
  for (int stop = 1; stop <= 2; ++stop) {
    const double begin = 1 + stop * leg_s + (stop - 1) * 3;
    for (const double t : {begin + 1e-9, begin + 1.5, begin + 3 - 1e-9}) {
      const ScriptPoint p = script.Eval(t);
      EXPECT_EQ(p.v_WB_W, Vector3d(0, 0, 0)) << t;
      EXPECT_EQ(p.w_WB_B, Vector3d(0, 0, 0)) << t;
      EXPECT_LT((p.X_WB.p - Vector3d(0, 0, 1) - route.Eval(stop * route.length_m() / 3).p_W).norm(), 1e-12);
    }
    EXPECT_GT(script.Eval(begin - 0.5).v_WB_W.norm(), 0.1);
    EXPECT_GT(script.Eval(begin + 3.5).v_WB_W.norm(), 0.1);
  }
}

TEST(WalkScript, HeadsAlongTheStraightsAndTurnsSmoothly) {
  const WalkScript script(WalkParams{}, BentRoute());
  const auto yaw = [&](double t) {
    const Vector3d nose = script.Eval(t).X_WB.q * Vector3d::UnitX();
    EXPECT_NEAR(nose.z(), 0, 1e-15);
    return std::atan2(nose.y(), nose.x());
  };
  EXPECT_NEAR(yaw(0), 0, 1e-14);
  EXPECT_NEAR(yaw(6), 0, 1e-9);
  EXPECT_NEAR(yaw(script.duration_s()), 0, 1e-9);
  double most = 0, fastest = 0;
  for (double t = 0; t < script.duration_s(); t += 0.01) {
    most = std::max(most, yaw(t));
    fastest = std::max(fastest, std::abs(script.Eval(t).w_WB_B.z()));
  }
  EXPECT_NEAR(most, kPi / 2, 1e-3);
  // a quarter turn over an arc of 0.79 m, averaged over 1 m, at 1 m/s: below v / R = 2 rad/s, above 90 deg
  // / 1.8 s
  EXPECT_LT(fastest, 2);
  EXPECT_GT(fastest, kPi / 2 / 1.8);
}

TEST(WalkScript, WobblesOnlyWhileWalking) {
  WalkParams params;
  params.wobble_m = 0.02;
  params.wobble_rad = 0.05;
  const WalkScript script(params, BentRoute());
  EXPECT_EQ(script.Eval(1).X_WB.p.z(), 1);
  double low = 2, high = 0;
  for (double t = 4; t < 8; t += 0.001) {
    low = std::min(low, script.Eval(t).X_WB.p.z());
    high = std::max(high, script.Eval(t).X_WB.p.z());
  }
  EXPECT_NEAR(high, 1.02, 2e-5);
  EXPECT_NEAR(low, 0.98, 2e-5);
}

TEST(WalkScript, GivesConsistentKinematics) {
  WalkParams params;
  params.wobble_m = 0.02;
  params.wobble_rad = 0.05;
  const WalkScript script(params, BentRoute());
  for (double t = 0.0131; t < script.duration_s() - 0.1; t += 0.0797) {
    if (!NearKnot(script, t)) ExpectConsistentKinematics(script, t);
  }
}

TEST(WalkScript, RefusesLegsTooShortForItsSpeed) {
  WalkParams params;
  params.leg_length_m = 0.5;
  const Route route = BentRoute();
  EXPECT_EQ(KeyOfError([&] { WalkScript(params, route); }), "walk.acceleration_time_s");
}

TEST(WalkScript, RefusesAVerticalRoute) {
  PipeSpec riser{"P1", "A", "B", 0.15, 0.005, 0.5, {}, {"pvc", 3e9, 0.1, 0.4, 1400, 0}};
  const Network network({{"A", {0, 0, 0}}, {"B", {0, 0, 20}}}, {riser});
  const Route route(network, {{0, false}});
  EXPECT_EQ(KeyOfError([&] { WalkScript(WalkParams{}, route); }), "walk.turn_time_s");
}

}  // namespace
}  // namespace piperun::sim
