// What contacts do to a ball, and what is told of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/ball_mass.h"
#include "sim/ball_world.h"
#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::BoreNetwork;
using testing::FindSpot;
using testing::MakeBoreLine;

constexpr double kRadius = 0.03, kBore = 0.075, kRun = kBore - kRadius, kMass = 0.18, kInertia = 4.5e-5;
constexpr double kWeight = 0.11;

BallLoad Weight(const BallInstant&) { return {{0, 0, -kWeight}, Vector3d::Zero()}; }
BallLoad None(const BallInstant&) { return {}; }

BallStart At(const BoreNetwork& line, const Vector3d& p_W, const Vector3d& v_W = Vector3d::Zero(),
             const Vector3d& w_W = Vector3d::Zero()) {
  return {{p_W, Quaterniond::Identity()}, v_W, w_W, FindSpot(line.network, 0, p_W)};
}

/// Heights above the invert at which a ball in the vertical plane of the axis turns round, from the parabola
/// through each state in flight.
std::vector<double> Bounce(double restitution, double drop_m, double acceleration, double rate_Hz,
                           int bounces) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, kInertia, 0.3};
  ball.restitution = restitution;
  BallWorld world(line.bore, ball, Rate(rate_Hz), At(line, {1, 0, -kRun + drop_m}, {0.1, 0, 0}),
                  [&](const BallInstant&) {
                    return BallLoad{{0, 0, -kMass * acceleration}, Vector3d::Zero()};
                  });
  std::vector<double> heights;
  double v_before = -1;
  while (heights.size() < static_cast<std::size_t>(bounces) && Seconds(world.state().time) < 20) {
    world.Step();
    const BallState& s = world.state();
    const double v = s.v_WB_W.z();
    if (v_before >= 0 && v < 0 && s.contacts.size() == 0) {
      heights.push_back(s.X_LB.p.z() + kRun + v * v / (2 * acceleration));
    }
    v_before = v;
  }
  return heights;
}

TEST(Restitution, HeightsOfABouncingBallGoDownByItsSquare) {
  for (const double e : {0.5, 0.8, 0.95}) {
    for (const double drop_m : {0.02, 0.0203, 0.031}) {  // which hit at different moments within a step
      const std::vector<double> heights = Bounce(e, drop_m, 0.6, 1000, 4);
      ASSERT_EQ(heights.size(), 4U);
      double expected = drop_m;
      for (const double height : heights) EXPECT_NEAR(height / (expected *= e * e), 1, 1e-9) << e;
    }
  }
}

TEST(Restitution, AnElasticBallBouncesForEver) {
  const std::vector<double> heights = Bounce(1, 0.02, 9.80665, 1000, 100);
  ASSERT_EQ(heights.size(), 100U);
  EXPECT_NEAR(heights.back() / 0.02, 1, 1e-9);
}

TEST(Restitution, DoesNotKeepABallFromComingToRest) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, kInertia, 0.3};
  ball.restitution = 0.7;
  BallWorld world(line.bore, ball, Rate(1000), At(line, {1, 0, -kRun + 0.01}), Weight);
  for (int i = 0; i < 5000; ++i) world.Step();
  EXPECT_NEAR(world.state().normal_force_N, kWeight, 1e-12);
  EXPECT_EQ(world.state().v_step_W, Vector3d::Zero());
  EXPECT_NEAR(world.state().X_LB.p.z(), -kRun, 1e-15);
}

TEST(Restitution, LeavesACurvedWallAtItsShareOfTheNormalSpeed) {
  // straight flight in a pipe without friction: at every impact the angle to the wall's normal is the same,
  // cos(alpha) = v_n/v, and only v_n is lost
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {50, 0, 0}});
  TubeBall ball{kRadius, kMass, kInertia, 0};
  ball.restitution = 0.8;
  const double v_t = 0.2, v_n = 0.3, rate_Hz = 8000;
  // from the wall at its lowest point, leaving it with v_n inwards and v_t along y
  BallWorld world(line.bore, ball, Rate(rate_Hz), At(line, {1, 0, -kRun}, {0.5, v_t, v_n}), None);
  double normal = v_n;
  int impacts = 0;
  for (int i = 0; i < 3 * rate_Hz; ++i) {
    world.Step();
    for (const StepContact& contact : world.state().contacts) {
      if (contact.closing_speed_m_s < 0.02) continue;
      EXPECT_NEAR(contact.closing_speed_m_s / normal, 1, 5e-3) << impacts;
      EXPECT_NEAR(contact.impulse_W_N_s.norm() / (1.8 * kMass * normal), 1, 5e-3) << impacts;
      normal *= 0.8;
      ++impacts;
    }
  }
  EXPECT_GE(impacts, 4);
  EXPECT_NEAR(world.state().v_WB_W.x(), 0.5, 1e-12);
}

TEST(Contact, ImpulsesAreWhatLoadsDoNotExplain) {
  // impacts, sliding, rolling and resistance in a pipe with bends
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {3, 0, 0}, {3, 3, 1}});
  TubeBall ball{kRadius, kMass, kInertia, 0.4, 3e-4, 3e-4, 0.5};
  const Vector3d force(0.05, 0.02, -kWeight);
  BallWorld world(line.bore, ball, Rate(1000), At(line, {0.1, 0.01, -0.03}, {0.5, 0.3, 0.1}, {3, -2, 7}),
                  [&](const BallInstant&) {
                    return BallLoad{force, Vector3d::Zero()};
                  });
  int touched = 0;
  for (int i = 0; i < 4000; ++i) {
    world.Step();
    const BallState& s = world.state();
    Vector3d sum = Vector3d::Zero();
    double normal = 0;
    for (const StepContact& contact : s.contacts) {
      sum += contact.impulse_W_N_s;
      normal += contact.impulse_W_N_s.dot(contact.normal_W);
      EXPECT_NEAR(contact.normal_W.norm(), 1, 1e-14);
      // Coulomb, along two axes
      const Vector3d n = contact.normal_W;
      const double along = contact.impulse_W_N_s.dot(n);
      EXPECT_LT((contact.impulse_W_N_s - along * n).norm(), 0.4 * std::sqrt(2) * along * (1 + 1e-12));
      ++touched;
    }
    ASSERT_LT((kMass * s.a_WB_W * 1e-3 - force * 1e-3 - sum).norm(), 1e-15);
    ASSERT_NEAR(normal, 1e-3 * s.normal_force_N, 1e-16);
  }
  EXPECT_GT(touched, 2000);
}

TEST(Contact, ClosingSpeedIsThatOfTheImpactAndNoneWhileFollowing) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  const double drop_m = 0.0207, a = kWeight / kMass;
  BallWorld world(line.bore, {kRadius, kMass, kInertia, 0.3}, Rate(1000), At(line, {1, 0, -kRun + drop_m}),
                  Weight);
  double largest = 0;
  for (int i = 0; i < 1000; ++i) {
    world.Step();
    for (const StepContact& contact : world.state().contacts) {
      largest = std::max(largest, contact.closing_speed_m_s);
    }
  }
  EXPECT_NEAR(largest / std::sqrt(2 * a * drop_m), 1, 1e-9);
  for (int i = 0; i < 100; ++i) {
    world.Step();
    ASSERT_EQ(world.state().contacts.size(), 1U);
    EXPECT_EQ(world.state().contacts.begin()->closing_speed_m_s, 0);
    EXPECT_EQ(world.state().contacts.begin()->feature, -1);
  }
}

TEST(Contact, FollowingACurvedWallClosesNothing) {
  // rocking at up to 0.9 m/s around the pipe: the wall curves away by 18 mm/s a step
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  BallWorld world(line.bore, {kRadius, kMass, kInertia, 0.5}, Rate(1000),
                  At(line, {1, 0, -kRun}, {0, 0.9, 0}), [](const BallInstant&) {
                    return BallLoad{{0, 0, -4}, Vector3d::Zero()};
                  });
  int followed = 0;  // at every step, up to 45 degrees and back
  for (int i = 0; i < 300; ++i) {
    world.Step();
    for (const StepContact& contact : world.state().contacts) {
      EXPECT_EQ(contact.closing_speed_m_s, 0) << i;
      ++followed;
    }
  }
  EXPECT_EQ(followed, 300);
}

TEST(SpinningResistance, StopsABallThatSpinsOnTheInvert) {
  // about the vertical: alpha = b_sp N / I, and then it stays
  const double length = 2e-4, spin = 6;
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, kInertia, 0.4, 3e-4, length};
  BallWorld world(line.bore, ball, Rate(1000), At(line, {1, 0, -kRun}, Vector3d::Zero(), {0, 0, spin}),
                  Weight);
  const double alpha = length * kWeight / kInertia;
  for (int i = 0; i < 5000; ++i) world.Step();
  EXPECT_NEAR((spin - world.state().w_WB_W.z()) / (5 * alpha), 1, 1e-12);
  for (int i = 0; i < 10000; ++i) world.Step();
  EXPECT_NEAR(world.state().w_WB_W.norm(), 0, 1e-14);
  EXPECT_NEAR(world.state().v_WB_W.norm(), 0, 1e-14);
}

TEST(SpinningResistance, OfAnUnevenBallTakesItsMomentAboutTheNormal) {
  // principal axes off the normal, but free of others: about z of the tensor with Ixy alone
  Matrix3d inertia;
  inertia << 5e-5, 1e-5, 0, 1e-5, 4e-5, 0, 0, 0, 6e-5;
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, inertia, 0.4, 0, 2e-4};
  BallWorld world(line.bore, ball, Rate(1000), At(line, {1, 0, -kRun}, Vector3d::Zero(), {0, 0, 6}), Weight);
  for (int i = 0; i < 5000; ++i) world.Step();
  EXPECT_NEAR((6 - world.state().w_WB_W.z()) / (5 * 2e-4 * kWeight / 6e-5), 1, 1e-9);
}

TEST(RollingResistance, OfAnUnevenBallIsThatOfItsLength) {
  // rolls about its principal axis y: a = b N / (r (M + I_y/r^2))
  const Matrix3d inertia = Vector3d(5e-5, 4e-5, 6e-5).asDiagonal();
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, inertia, 0.4, 3e-4};
  BallWorld world(line.bore, ball, Rate(1000), At(line, {0.1, 0, -kRun}, {1, 0, 0}, {0, 1 / kRadius, 0}),
                  Weight);
  for (int i = 0; i < 2000; ++i) world.Step();
  const double a = 3e-4 * kWeight / (kRadius * (kMass + 4e-5 / (kRadius * kRadius)));
  EXPECT_NEAR((1 - world.state().v_WB_W.x()) / (2 * a), 1, 1e-9);
}

TEST(RollingResistance, HoldsAnUnevenBallAtRest) {
  Matrix3d inertia;
  inertia << 5e-5, 1e-5, 0, 1e-5, 4e-5, -5e-6, 0, -5e-6, 6e-5;
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, inertia, 0.4, 6e-4, 6e-4};
  const double push = 0.9 * 0.02 * kWeight;
  BallWorld world(line.bore, ball, Rate(1000), At(line, {1, 0, -kRun}), [&](const BallInstant&) {
    return BallLoad{{push, 0, -kWeight}, Vector3d::Zero()};
  });
  for (int i = 0; i < 1000; ++i) world.Step();
  EXPECT_NEAR(world.state().v_WB_W.norm(), 0, 1e-9);
}

/// A ball without weight flies onto the invert and comes back: how fast, how long it was pressed, and what
/// was told of it.
struct SoftImpact {
  double restitution = 0;
  double duration_s = 0;
  std::vector<double> closing_m_s;
};

constexpr double kFoamSpeed_m_s = 0.3;

SoftImpact HitSoftly(const ContactCompliance& foam, double rate_Hz) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, kInertia, 0};
  ball.compliance = foam;
  BallWorld world(line.bore, ball, Rate(rate_Hz), At(line, {1, 0, -kRun + 1e-3}, {0, 0, -kFoamSpeed_m_s}),
                  None);
  SoftImpact impact;
  while (world.state().v_WB_W.z() < 0 || world.state().contacts.size() > 0) {
    world.Step();
    for (const StepContact& contact : world.state().contacts) {
      impact.duration_s += 1 / rate_Hz;
      if (contact.closing_speed_m_s > 0) impact.closing_m_s.push_back(contact.closing_speed_m_s);
    }
  }
  impact.restitution = world.state().v_WB_W.z() / kFoamSpeed_m_s;
  return impact;
}

/// x'' + 2 zeta w x' + w^2 x = 0 from x = 0 until k x + c x' = 0: with w_d = w sqrt(1 - zeta^2),
///   T = atan2(2 zeta sqrt(1 - zeta^2), 2 zeta^2 - 1)/w_d,
///   e = -x'(T)/x'(0), x' = x'(0) exp(-zeta w t) (cos(w_d t) - zeta/sqrt(1 - zeta^2) sin(w_d t)).
SoftImpact SolveSoftImpact(const ContactCompliance& foam) {
  const double w = std::sqrt(foam.stiffness_N_m / kMass), zeta = foam.damping_N_s_m / (2 * kMass * w);
  const double root = std::sqrt(1 - zeta * zeta), w_d = w * root;
  const double t = std::atan2(2 * zeta * root, 2 * zeta * zeta - 1) / w_d;
  const double rate = std::exp(-zeta * w * t) * (std::cos(w_d * t) - zeta / root * std::sin(w_d * t));
  return {-rate, t, {kFoamSpeed_m_s}};
}

TEST(FoamContact, IsADampedOscillatorThatDoesNotPull) {
  // An impact may start anywhere within a step: of the spring's first push at most k v dt^2/4 is missed, of
  // the damper's c v dt/2.
  for (const double damping : {0.0, 5.0, 20.0}) {
    const ContactCompliance foam{4000, damping};
    const SoftImpact exact = SolveSoftImpact(foam);
    for (const double rate_Hz : {1000.0, 2000.0, 4000.0, 8000.0}) {
      const SoftImpact found = HitSoftly(foam, rate_Hz);
      const double dt = 1 / rate_Hz, w_dt = CalcContactFrequency_rad_s(4000, kMass) * dt;
      EXPECT_NEAR(found.restitution, exact.restitution, 0.25 * w_dt * w_dt + 0.5 * damping * dt / kMass)
          << damping << " N s/m, " << rate_Hz << " Hz";
      EXPECT_NEAR(found.duration_s, exact.duration_s, 1.01 * dt);
      ASSERT_EQ(found.closing_m_s.size(), 1U);
      EXPECT_NEAR(found.closing_m_s[0], kFoamSpeed_m_s, 1e-12);
    }
  }
}

TEST(FoamContact, TooStiffForTheStepStopsTheBallWithoutGainingEnergy) {
  for (const double stiffness : {1e6, 1e7, 1e9}) {
    const SoftImpact found = HitSoftly({stiffness, 0}, 1000);
    EXPECT_LT(found.restitution, 1) << stiffness;
    EXPECT_GE(found.restitution, 0) << stiffness;
  }
}

TEST(FoamContact, CarriesABallAtItsSag) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  TubeBall ball{kRadius, kMass, kInertia, 0.3};
  ball.compliance = {4000, 20};
  BallWorld world(line.bore, ball, Rate(1000), At(line, {1, 0, -kRun}), Weight);
  for (int i = 0; i < 2000; ++i) world.Step();
  EXPECT_NEAR(world.state().X_LB.p.z(), -kRun - kWeight / 4000, 1e-13);
  EXPECT_NEAR(world.state().normal_force_N, kWeight, 1e-10);
}

}  // namespace
}  // namespace piperun::sim
