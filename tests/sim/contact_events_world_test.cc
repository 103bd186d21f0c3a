#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/ball_world.h"
#include "sim/contact_events.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using piperun::testing::BoreNetwork;
using piperun::testing::FindSpot;
using piperun::testing::MakeBoreLine;
using piperun::testing::PipeShape;

// The reference ball (60 mm, relative density 1.10) in water of 1000 kg/m3 in a 150 mm pipe.
constexpr double kRadius = 0.03, kRun = 0.075 - kRadius;
constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
constexpr double kMass = 1600 * kVolume, kWeight = 100 * kVolume * 9.80665;

/// The collisions of a ball that starts at `p_W` with `v_W`, under its weight.
std::vector<ContactEvent> Collect(const BoreNetwork& line, const TubeBall& ball, double rate_Hz,
                                  const BallStart& start, double seconds) {
  const Rate rate(rate_Hz);
  BallWorld world(line.bore, ball, rate, start, [](const BallInstant&) {
    return BallLoad{{0, 0, -kWeight}, Vector3d::Zero()};
  });
  ContactEventDetector detector(kRadius, kMass, 0.01);
  std::vector<ContactEvent> events;
  while (Seconds(world.state().time) < seconds) {
    world.Step();
    const BallState& state = world.state();
    const double carried_N = CalcCarriedForce_N(kWeight, kMass, state.spot.axis, state.X_LB.p, state.v_WB_W);
    for (const ContactEvent& event :
         detector.Step({state.time, rate.Period_s(), carried_N, {state.X_LB.p, 0, state.spot.s_m, 0}},
                       state.contacts)) {
      events.push_back(event);
    }
  }
  return events;
}

TubeBall MakeBall() {
  TubeBall ball;
  ball.radius_m = kRadius;
  ball.mass_kg = kMass;
  ball.inertia_B_kg_m2 = 0.4 * 1100 * kVolume * kRadius * kRadius;
  ball.friction = 0.5;
  return ball;
}

TEST(ContactEventsOfAWorld, ADroppedBallGivesTheWallItsMomentumWhateverTheStep) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  const Vector3d p(1, 0, 0.013 - kRun);
  const double speed = std::sqrt(0.2 * 0.2 + 2 * kWeight / kMass * 0.013);
  for (const double e : {0.0, 0.5}) {
    TubeBall ball = MakeBall();
    ball.restitution = e;
    for (const double rate : {500.0, 1000.0, 4000.0}) {
      const auto events = Collect(
          line, ball, rate,
          {{p, Quaterniond::Identity()}, {0, 0, -0.2}, Vector3d::Zero(), FindSpot(line.network, 0, p)}, 1);
      ASSERT_GE(events.size(), 1U);
      EXPECT_EQ(events.size() == 1, e == 0) << rate;
      EXPECT_NEAR(events[0].impulse_W_N_s.z(), kMass * speed * (1 + e), 2 * (1 + e) * kWeight / rate) << rate;
      EXPECT_NEAR(events[0].closing_speed_m_s, speed, 2 * kWeight / kMass / rate) << rate;
      EXPECT_NEAR((events[0].p_W - Vector3d(1, 0, -0.075)).norm(), 0, 1.5 * speed / rate) << rate;
      EXPECT_EQ(events[0].feature, -1);
    }
  }
}

TEST(ContactEventsOfAWorld, RollingAlongStraightsAndBendsHasNone) {
  const BoreNetwork line =
      MakeBoreLine({{0, 0, 0}, {2, 0, 0}, {2, 4, 0}, {6, 4, 0}}, {.bend_radius_m = 0.45});
  const Vector3d p(0.2, 0, -kRun), v(1.2, 0, 0);
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    const auto events = Collect(
        line, MakeBall(), rate,
        {{p, Quaterniond::Identity()}, v, Vector3d::UnitZ().cross(v) / kRadius, FindSpot(line.network, 0, p)},
        4);
    EXPECT_TRUE(events.empty()) << rate << " Hz, " << events.size();
  }
}

}  // namespace
}  // namespace piperun::sim
