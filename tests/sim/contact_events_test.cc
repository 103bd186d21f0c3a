#include "sim/contact_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace piperun::sim {
namespace {

constexpr double kRadius = 0.03, kMass = 0.19, kWeight = 0.11;  // the reference ball in water
constexpr double kLeastSpeed = 0.01;

StepContact MakeContact(double impulse_N_s, double closing_m_s, int feature = -1,
                        const Vector3d& normal_W = Vector3d::UnitZ()) {
  return {normal_W, impulse_N_s * normal_W, closing_m_s, feature};
}

/// Steps of a detector at a rate, with everything that it told.
class Listener {
 public:
  explicit Listener(double rate_Hz = 1000) : rate_(rate_Hz) {}

  void Step(const std::vector<StepContact>& contacts, double carried_N = kWeight) {
    StepContacts list;
    for (const StepContact& contact : contacts) list.Add(contact);
    const TrueTime now = SampleTime(step_++, rate_);
    for (const ContactEvent& event :
         detector_.Step({now, rate_.Period_s(), carried_N, {{1, 2, 3}, 4, 5, 6}}, list)) {
      events.push_back(event);
      told.push_back(now);
    }
  }
  void Rest(int steps) {
    for (int i = 0; i < steps; ++i) Step({MakeContact(kWeight * dt_s(), kWeight / kMass * dt_s())});
  }
  void Fly(int steps) {
    for (int i = 0; i < steps; ++i) Step({});
  }
  double dt_s() const { return rate_.Period_s(); }
  TrueTime now() const { return SampleTime(step_, rate_); }

  std::vector<ContactEvent> events;
  std::vector<TrueTime> told;

 private:
  Rate rate_;
  std::int64_t step_ = 0;
  ContactEventDetector detector_{kRadius, kMass, kLeastSpeed};
};

/// A ball above a floor, leapfrog. As BallWorld promises, a rigid contact makes the normal velocity -gap/dt,
/// or throws the ball back with e times its speed; a soft one presses with k x + c dx/dt >= 0 at the end of
/// the step. The closing speed is the one at which the ball comes.
struct Floor {
  double restitution = 0;
  double stiffness_N_m = 0;  // 0: rigid
  double damping_N_s_m = 0;

  void Fall(double height_m, double speed_m_s, double seconds, Listener& listener) const {
    const double dt = listener.dt_s();
    double z = height_m, v = -speed_m_s;
    for (int i = 0; i < static_cast<int>(std::lround(seconds / dt)); ++i) {
      v -= kWeight / kMass * dt;
      const double closing = std::max(0.0, -v);
      const double impulse =
          std::max(0.0, stiffness_N_m > 0 ? SoftImpulse(z, v, dt) : RigidImpulse(z, v, dt));
      v += impulse / kMass;
      z += v * dt;
      listener.Step(impulse > 0 ? std::vector{MakeContact(impulse, closing)} : std::vector<StepContact>{});
    }
  }
  double RigidImpulse(double z, double v, double dt) const {
    if (z + v * dt >= 0) return 0;
    const bool bounces = restitution > 0 && -v > kLeastSpeed;
    return kMass * (bounces ? -(1 + restitution) * v : -z / dt - v);
  }
  double SoftImpulse(double z, double v, double dt) const {
    // J = (k x + c dx/dt) dt with x = -(z + (v + J/M) dt), dx/dt = -(v + J/M)
    const double slope = (stiffness_N_m * dt + damping_N_s_m) * dt;
    return z + v * dt >= 0 ? 0 : -(stiffness_N_m * z * dt + slope * v) / (1 + slope / kMass);
  }
};

TEST(ContactEvents, RigidImpactHasTheMomentumThatItTakesWhateverTheStep) {
  const double speed = 0.1, height = 0.0123;
  const double at_wall = std::sqrt(speed * speed + 2 * kWeight / kMass * height);
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    Listener listener(rate);
    Floor{}.Fall(height, speed, 0.5, listener);
    ASSERT_EQ(listener.events.size(), 1U) << rate;
    const ContactEvent& event = listener.events[0];
    // two steps of the weight at most: one while it stops, one between the wall and the whole step
    EXPECT_NEAR(event.impulse_W_N_s.z(), kMass * at_wall, 2 * kWeight * listener.dt_s()) << rate;
    EXPECT_NEAR(event.closing_speed_m_s, at_wall, 2 * kWeight / kMass * listener.dt_s()) << rate;
    EXPECT_LE(event.duration_s, 2.5 * listener.dt_s()) << rate;
    const double fall_s = (at_wall - speed) / (kWeight / kMass);
    EXPECT_NEAR(Seconds(event.begin), fall_s, 1.5 * listener.dt_s()) << rate;
  }
}

TEST(ContactEvents, ReboundAddsItsMomentum) {
  const double speed = 0.2, height = 0.02, e = 0.5;
  const double at_wall = std::sqrt(speed * speed + 2 * kWeight / kMass * height);
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    Listener listener(rate);
    Floor{.restitution = e}.Fall(height, speed, 0.3, listener);
    ASSERT_GE(listener.events.size(), 1U) << rate;
    EXPECT_NEAR(listener.events[0].impulse_W_N_s.z(), kMass * at_wall * (1 + e),
                2 * (1 + e) * kWeight * listener.dt_s())
        << rate;
  }
}

TEST(ContactEvents, SoftImpactLastsHalfAPeriodOfItsSpring) {
  // x'' = -k x/M: half a period pi sqrt(M/k), peak v sqrt(k M), and the weight on top
  const double speed = 0.2, k = 2000;
  for (const double rate : {1000.0, 4000.0}) {
    Listener listener(rate);
    Floor{.stiffness_N_m = k}.Fall(0.01, std::sqrt(speed * speed - 2 * kWeight / kMass * 0.01), 0.2,
                                   listener);
    ASSERT_EQ(listener.events.size(), 1U) << rate;
    const ContactEvent& event = listener.events[0];
    const double half_period = std::numbers::pi * std::sqrt(kMass / k);
    // the implicit spring damps by omega dt/2 per radian: 16 % of the rebound at 1 kHz, 4 % at 4 kHz
    const double damping = std::numbers::pi / 2 * std::sqrt(k / kMass) * listener.dt_s();
    const double impulse = 2 * kMass * speed + kWeight * half_period;
    EXPECT_NEAR(event.impulse_W_N_s.z(), impulse, damping * kMass * speed + 0.01 * impulse) << rate;
    EXPECT_NEAR(event.peak_force_N, speed * std::sqrt(k * kMass) + kWeight,
                damping * speed * std::sqrt(k * kMass))
        << rate;
    EXPECT_NEAR(event.duration_s, half_period, 2 * listener.dt_s()) << rate;
  }
}

TEST(ContactEvents, SoftImpactEndsWhenItsForceHasFallenToWhatCarriesTheBall) {
  // critically damped, M x'' = W - F, F = k x + 2 omega M x':  x = g/omega^2 + (A + B t) exp(-omega t)
  const double k = 2000, speed = 0.15, omega = std::sqrt(k / kMass), g = kWeight / kMass;
  const double A = -g / (omega * omega), B = speed - g / omega;
  const auto speed_at = [&](double t) { return (B - omega * (A + B * t)) * std::exp(-omega * t); };
  const auto force_at = [&](double t) {
    return kWeight + kMass * omega * (2 * B - omega * (A + B * t)) * std::exp(-omega * t);
  };
  const double least_N = 2 * kWeight + kMass * kLeastSpeed / 0.1;
  for (const double rate : {1000.0, 4000.0}) {
    Listener listener(rate);
    Floor{.stiffness_N_m = k, .damping_N_s_m = 2 * std::sqrt(k * kMass)}.Fall(0, speed, 1, listener);
    ASSERT_EQ(listener.events.size(), 1U) << rate;
    const ContactEvent& event = listener.events[0];
    const double T = event.duration_s, dt = listener.dt_s();
    EXPECT_GT(force_at(T - 2 * dt), least_N) << rate;
    EXPECT_LT(force_at(T + 2 * dt), least_N) << rate;
    // first order in the step: omega dt of the momentum
    EXPECT_NEAR(event.impulse_W_N_s.z(), kMass * (speed - speed_at(T)) + kWeight * T,
                omega * dt * kMass * speed)
        << rate;
  }
}

TEST(ContactEvents, RestingIsNone) {
  for (const double rate : {100.0, 1000.0, 4000.0}) {
    Listener listener(rate);
    listener.Rest(1000);
    listener.Fly(20);
    EXPECT_TRUE(listener.events.empty()) << rate;
  }
}

TEST(ContactEvents, FollowingABendIsNoneWhereverItsBeginningFallsInAStep) {
  // 2 m/s around 0.3 m: the wall takes 13 mm/s a step at 1 kHz, beyond the least speed
  const double lateral_m_s2 = 4 / 0.3;
  for (const double rate : {200.0, 1000.0, 4000.0}) {
    for (const double share : {0.1, 0.5, 0.9, 0.999}) {
      Listener listener(rate);
      listener.Rest(50);
      const auto follow = [&](double part, double carried_N) {
        const double speed = (part * lateral_m_s2 + kWeight / kMass) * listener.dt_s();
        listener.Step({MakeContact(kMass * speed, speed)}, carried_N);
      };
      follow(share, kWeight);  // still on the straight at the middle of this step
      for (int i = 0; i < 300; ++i) follow(1, kWeight + kMass * lateral_m_s2);
      listener.Rest(50);
      EXPECT_TRUE(listener.events.empty()) << rate << " Hz, " << share;
    }
  }
}

TEST(ContactEvents, ChatterWithinFiveMillisecondsIsOneEvent) {
  Listener listener;
  for (int i = 0; i < 3; ++i) {
    listener.Step({MakeContact(0.01, 0.05)});
    listener.Fly(4);
  }
  listener.Fly(10);
  ASSERT_EQ(listener.events.size(), 1U);
  EXPECT_NEAR(listener.events[0].impulse_W_N_s.z(), 0.03, 1e-15);
  EXPECT_NEAR(listener.events[0].duration_s, 0.011, 1e-12);
  EXPECT_NEAR(listener.events[0].peak_force_N, 10, 1e-12);
}

TEST(ContactEvents, ReboundBeyondFiveMillisecondsIsAnEventOfItsOwn) {
  Listener listener;
  listener.Step({MakeContact(0.02, 0.1)});
  listener.Fly(6);
  listener.Step({MakeContact(0.01, 0.05)});
  listener.Fly(6);
  ASSERT_EQ(listener.events.size(), 2U);
  EXPECT_EQ(listener.events[0].begin, SampleTime(0, Rate(1000)));
  EXPECT_EQ(listener.events[1].begin, SampleTime(7, Rate(1000)));
  EXPECT_EQ(listener.events[1].closing_speed_m_s, 0.05);
}

TEST(ContactEvents, TwoFeaturesAtOnceAreTwoEvents) {
  Listener listener;
  listener.Step({MakeContact(0.02, 0.1, 3), MakeContact(0.01, 0.05, 7)});
  listener.Fly(6);
  ASSERT_EQ(listener.events.size(), 2U);
  EXPECT_EQ(listener.events[0].feature, 3);
  EXPECT_EQ(listener.events[1].feature, 7);
  EXPECT_NEAR(listener.events[1].impulse_W_N_s.z(), 0.01, 1e-15);
}

TEST(ContactEvents, NormalsFartherApartThan45DegreesAreTwoEvents) {
  for (const double degrees : {44.0, 46.0}) {
    Listener listener;
    const double angle = degrees * std::numbers::pi / 180;
    listener.Step(
        {MakeContact(0.02, 0.1), MakeContact(0.02, 0.1, -1, {std::sin(angle), 0, std::cos(angle)})});
    listener.Fly(6);
    ASSERT_EQ(listener.events.size(), degrees < 45 ? 1U : 2U);
    // in one event the forces of one step add up as vectors
    const double sum_N = degrees < 45 ? 40 * std::cos(angle / 2) : 20;
    EXPECT_NEAR(listener.events[0].peak_force_N, sum_N, 1e-9);
  }
}

TEST(ContactEvents, StrikingABallThatAlreadyRestsIsAnEvent) {
  Listener listener;
  listener.Rest(20);
  listener.Step({MakeContact(0.03 + kWeight * 1e-3, 0.15)});
  listener.Rest(20);
  ASSERT_EQ(listener.events.size(), 1U);
  EXPECT_EQ(listener.events[0].begin, SampleTime(20, Rate(1000)));
  EXPECT_NEAR(listener.events[0].impulse_W_N_s.z(), 0.03 + kWeight * 1e-3, 1e-15);
}

TEST(ContactEvents, TouchedWhereItBegan) {
  Listener listener;
  listener.Step({MakeContact(0.02, 0.1, -1, Vector3d::UnitY())});
  listener.Fly(6);
  ASSERT_EQ(listener.events.size(), 1U);
  const ContactEvent& event = listener.events[0];
  EXPECT_NEAR((event.p_W - Vector3d(1, 2 - kRadius, 3)).norm(), 0, 1e-15);
  EXPECT_EQ(event.pipe, 4);
  EXPECT_EQ(event.s_m, 5);
  EXPECT_EQ(event.chainage_m, 6);
}

TEST(ContactEvents, AreToldWithinTheirDelayEvenWhenTheyGoOn) {
  for (const double rate : {100.0, 1000.0, 10000.0}) {
    Listener listener(rate);
    listener.Fly(3);
    for (int i = 0; i < static_cast<int>(rate); ++i) listener.Step({MakeContact(0.02, 0.1)});
    listener.Fly(static_cast<int>(rate));
    ASSERT_GE(listener.events.size(), 9U);
    double impulse = 0;
    for (std::size_t i = 0; i < listener.events.size(); ++i) {
      EXPECT_LE(listener.told[i], listener.events[i].begin + kContactEventDelay) << rate;
      EXPECT_LE(listener.events[i].duration_s, Seconds(kContactEventDelay) + 1e-12);
      impulse += listener.events[i].impulse_W_N_s.z();
    }
    EXPECT_NEAR(impulse, 0.02 * rate, 1e-9 * rate);
  }
}

TEST(ContactEvents, NoneIsLostWhenManyAreOpenAtOnce) {
  Listener listener(10000);
  const int features = 24;  // within 1.2 ms
  for (int i = 0; i < features; i += 2) {
    listener.Step({MakeContact(0.01, 0.1, i), MakeContact(0.01, 0.1, i + 1)});
  }
  listener.Fly(100);
  std::vector<int> seen;
  for (const ContactEvent& event : listener.events) seen.push_back(event.feature);
  std::sort(seen.begin(), seen.end());
  ASSERT_EQ(seen.size(), static_cast<std::size_t>(features));
  for (int i = 0; i < features; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
}

TEST(CarriedForce, IsWeightOnTheInvertAndTheCentripetalForcesOnTop) {
  const CentrelinePoint straight{Vector3d(1, 2, 3), Vector3d::UnitX(), Vector3d::Zero()};
  const Vector3d p = straight.p_W - 0.045 * Vector3d::UnitZ();
  EXPECT_NEAR(CalcCarriedForce_N(kWeight, kMass, straight, p, {1, 0, 0}), kWeight, 1e-15);
  // rocking past the invert at 0.3 m/s; running into the wall makes no such force
  EXPECT_NEAR(CalcCarriedForce_N(kWeight, kMass, straight, p, {1, 0.3, -0.2}), kWeight + kMass * 0.09 / 0.045,
              1e-12);
  const CentrelinePoint bend{straight.p_W, straight.tangent_W, Vector3d::UnitY() / 0.3};
  EXPECT_NEAR(CalcCarriedForce_N(kWeight, kMass, bend, p, {2, 0, 0}), kWeight + kMass * 4 / 0.3, 1e-12);
}

}  // namespace
}  // namespace piperun::sim
