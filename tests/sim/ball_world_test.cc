#include "sim/ball_world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/pipes.h"

namespace piperun::sim {
namespace {

using testing::BoreNetwork;
using testing::FindSpot;
using testing::MakeBoreLine;

// The reference ball (60 mm, SG 1.10) in water of 1000 kg/m3 in a 150 mm pipe, with added mass 0.5.
constexpr double kRadius = 0.03, kBore = 0.075, kRun = kBore - kRadius;
constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
constexpr double kMass = 1100 * kVolume, kInertial = kMass + 500 * kVolume;
constexpr double kInertia = 0.4 * kMass * kRadius * kRadius;
constexpr double kRolling = kInertial + kInertia / (kRadius * kRadius);  // m + m_a + I/r^2
constexpr double kGravity = 9.80665;
constexpr double kWeight = (kMass - 1000 * kVolume) * kGravity;  // in water

TubeBall Ball(double friction = 0.5, double rolling_length_m = 0) {
  return {kRadius, kInertial, kInertia, friction, rolling_length_m};
}

BallLoad Weight(const BallInstant&) { return {{0, 0, -kWeight}, Vector3d::Zero()}; }

BallStart At(const BoreNetwork& line, const Vector3d& p_W, const Vector3d& v_W = Vector3d::Zero(),
             const Vector3d& w_W = Vector3d::Zero()) {
  return {{p_W, Quaterniond::Identity()}, v_W, w_W, FindSpot(line.network, 0, p_W)};
}

void RunSteps(BallWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) world.Step();
}

TEST(BallWorld, FreeFallIsTheLeapfrogParabola) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 100}, {0, 0, 0}});
  BallWorld world(line.bore, Ball(), Rate(1000), At(line, {0, 0, 99}, {0.01, 0, 0}), Weight);
  RunSteps(world, 1000);
  const double a = kWeight / kInertial;
  EXPECT_NEAR(world.state().X_LB.p.z(), 99 - 0.5 * a, 1e-11);
  EXPECT_NEAR(world.state().v_WB_W.z(), -a, 1e-12);
  EXPECT_NEAR(world.state().X_LB.p.x(), 0.01, 1e-13);
  EXPECT_EQ(world.state().normal_force_N, 0);
}

TEST(BallWorld, RollsDownAnInclineWithAddedMassAndRotaryInertia) {
  // a = (m - rho V) g sin(slope) / (m + m_a + I/r^2)
  const double slope = 0.1;
  const Vector3d t(std::cos(slope), 0, -std::sin(slope)), up(std::sin(slope), 0, std::cos(slope));
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, 50 * t});
  BallWorld world(line.bore, Ball(), Rate(1000), At(line, -kRun * up), Weight);
  RunSteps(world, 5000);
  const double a = kWeight * std::sin(slope) / kRolling;
  EXPECT_NEAR(world.state().v_WB_W.dot(t) / (5 * a), 1, 1e-10);
  EXPECT_NEAR(world.state().X_LB.p.dot(t) / (0.5 * a * 25), 1, 1e-10);
  EXPECT_NEAR(world.state().w_WB_W.y() * kRadius / world.state().v_WB_W.norm(), 1, 1e-10);
  EXPECT_NEAR(world.state().normal_force_N, kWeight * std::cos(slope), 1e-9);
}

TEST(BallWorld, SlidesDownASteepInclineWithCoulombFriction) {
  // tan(slope) > mu (1 + (m + m_a) r^2 / I): it slides, a = W (sin - mu cos)/(m + m_a)
  const double slope = 0.9, mu = 0.1;
  const Vector3d t(std::cos(slope), 0, -std::sin(slope)), up(std::sin(slope), 0, std::cos(slope));
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, 50 * t});
  BallWorld world(line.bore, Ball(mu), Rate(1000), At(line, -kRun * up), Weight);
  RunSteps(world, 2000);
  const double a = kWeight * (std::sin(slope) - mu * std::cos(slope)) / kInertial;
  EXPECT_NEAR(world.state().v_WB_W.dot(t) / (2 * a), 1, 1e-10);
  EXPECT_NEAR(world.state().w_WB_W.y() / (2 * mu * kWeight * std::cos(slope) * kRadius / kInertia), 1, 1e-10);
}

TEST(BallWorld, SlidingTurnsIntoRollingAtTheSpeedThatAngularMomentumGives) {
  // about the contact: (m + m_a) v0 = (m + m_a + I/r^2) v
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {50, 0, 0}});
  BallWorld world(line.bore, Ball(0.3), Rate(1000), At(line, {0, 0, -kRun}, {1, 0, 0}), Weight);
  RunSteps(world, 3000);
  EXPECT_NEAR(world.state().v_WB_W.x(), kInertial / kRolling, 1e-9);
  EXPECT_NEAR(world.state().w_WB_W.y() * kRadius, kInertial / kRolling, 1e-9);
}

TEST(BallWorld, RollingResistanceDeceleratesByItsLength) {
  // a = b N / (r (m + m_a + I/r^2)), in any direction along the pipe
  for (const double crr : {0.002, 0.02}) {
    const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {30, 40, 0}});
    const Vector3d t(0.6, 0.8, 0), axis(-0.8, 0.6, 0);
    BallWorld world(line.bore, Ball(0.5, crr * kRadius), Rate(1000),
                    At(line, {0, 0, -kRun}, 1.2 * t, 1.2 / kRadius * axis), Weight);
    RunSteps(world, 2000);
    const double a = crr * kWeight / kRolling;
    EXPECT_NEAR((1.2 - world.state().v_WB_W.dot(t)) / (2 * a), 1, 1e-9) << crr;
  }
}

TEST(BallWorld, RollingResistanceHoldsABallAtRest) {
  // pushed with less than b N / r it stays; with more it rolls with the difference
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {50, 0, 0}});
  const double limit = 0.02 * kWeight;
  const auto push = [&](double force) {
    BallWorld world(line.bore, Ball(0.5, 0.02 * kRadius), Rate(1000), At(line, {0, 0, -kRun}),
                    [force](const BallInstant&) {
                      return BallLoad{{force, 0, -kWeight}, Vector3d::Zero()};
                    });
    RunSteps(world, 1000);
    return world.state().v_WB_W.x();
  };
  EXPECT_NEAR(push(0.9 * limit), 0, 1e-8);
  EXPECT_NEAR(push(1.5 * limit), 0.5 * limit / kRolling, 1e-8);
}

TEST(BallWorld, RollingForwardHardlyDampsRocking) {
  // the resisting torque opposes the rolling velocity: of its size b N only w_x / |w| acts on a slow rocking
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {50, 0, 0}});
  const double v = 1, rock = 0.02, crr = 0.01;
  BallWorld world(line.bore, Ball(0.5, crr * kRadius), Rate(1000),
                  At(line, {0, 0, -kRun}, {v, rock, 0}, {-rock / kRadius, v / kRadius, 0}), Weight);
  RunSteps(world, 1000);
  // linear damping c = crr W / (M v) for the sideways speed, half of it on the amplitude: exp(-c t/2) = 0.88
  // in the mean over the slowing run; plain Coulomb friction would have stopped it after 0.02/(crr W/M) =
  // 0.37 s
  const double mechanical =
      std::hypot(world.state().v_WB_W.y(), world.state().X_LB.p.y() * std::sqrt(kWeight / (kRolling * kRun)));
  const double c = crr * kWeight / kRolling / v;
  EXPECT_NEAR(mechanical / rock, std::exp(-0.5 * c), 0.01);
}

/// Period of rocking with amplitude a: (2 pi/w0) / AGM(1, cos(a/2)), w0^2 = W/((m + m_a + I/r^2)(R - r)).
double RockingPeriod(double amplitude) {
  double a = 1, b = std::cos(amplitude / 2);
  for (int i = 0; i < 8; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * std::numbers::pi / std::sqrt(kWeight / (kRolling * kRun)) / a;
}

/// Times at which the ball passes the lowest line, by cubic Hermite roots between steps; and the largest
/// angle.
struct Rocking {
  std::vector<double> crossings_s;
  double last_amplitude_rad = 0;
};

Rocking RockFor(double seconds, double amplitude, double rate_Hz) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
  const Vector3d start(1, kRun * std::sin(amplitude), -kRun * std::cos(amplitude));
  BallWorld world(line.bore, Ball(), Rate(rate_Hz), At(line, start), Weight);
  Rocking rocking;
  double y = start.y(), v = 0, largest = 0;
  const double dt = 1 / rate_Hz;
  for (std::int64_t k = 1; Seconds(SampleOffset(k, Rate(rate_Hz))) < seconds; ++k) {
    world.Step();
    const double y_new = world.state().X_LB.p.y(), v_new = world.state().v_WB_W.y();
    if (y * y_new < 0) {
      double s = y / (y - y_new);  // Newton on the Hermite cubic
      for (int i = 0; i < 5; ++i) {
        const double c0 = y, c1 = v * dt, c2 = 3 * (y_new - y) - (2 * v + v_new) * dt,
                     c3 = 2 * (y - y_new) + (v + v_new) * dt;
        s -= (c0 + s * (c1 + s * (c2 + s * c3))) / (c1 + s * (2 * c2 + s * 3 * c3));
      }
      rocking.crossings_s.push_back((static_cast<double>(k) - 1 + s) * dt);
      rocking.last_amplitude_rad = largest;
      largest = 0;
    }
    y = y_new;
    v = v_new;
    largest = std::max(largest, std::abs(std::atan2(y, -world.state().X_LB.p.z())));
  }
  return rocking;
}

double MeanPeriod(const Rocking& rocking) {
  const auto& t = rocking.crossings_s;
  return 2 * (t.back() - t.front()) / static_cast<double>(t.size() - 1);
}

TEST(BallWorld, RocksWithThePeriodOfTheEllipticIntegral) {
  const double amplitude = std::numbers::pi / 6;
  const Rocking rocking = RockFor(100, amplitude, 1000);
  EXPECT_NEAR(MeanPeriod(rocking) / RockingPeriod(amplitude), 1, 1e-6);
  EXPECT_NEAR(rocking.last_amplitude_rad / amplitude, 1, 1e-5);
}

TEST(BallWorld, RockingConvergesWithSecondOrder) {
  const double amplitude = std::numbers::pi / 6, exact = RockingPeriod(amplitude);
  const double coarse = MeanPeriod(RockFor(20, amplitude, 100)) / exact - 1;
  const double fine = MeanPeriod(RockFor(20, amplitude, 200)) / exact - 1;
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2, 0.1);
}

TEST(BallWorld, StraightRollAnywhereHasNoSpuriousSpecificForce) {
  // far from the origin, at an odd angle, in a long pipe; friction, rolling resistance and drag at work
  const Vector3d from(412.3, -230.7, 61.9);
  const BoreNetwork line = MakeBoreLine({from, from + Vector3d(80, 61, -7)});
  for (const double rate : {1000.0, 4000.0}) {
    const CentrelinePoint axis = line.network.pipe(0).Eval(0);
    const Vector3d up = (Vector3d::UnitZ() - axis.tangent_W.z() * axis.tangent_W).normalized();
    BallWorld world(line.bore, Ball(0.5, 0.01 * kRadius), Rate(rate), At(line, axis.p_W - kRun * up),
                    [&](const BallInstant& ball) {
                      const Vector3d u = axis.tangent_W - ball.v_WB_W;
                      return BallLoad{0.6 * u.norm() * u - Vector3d(0, 0, kWeight), -1e-5 * ball.w_WB_W};
                    });
    RunSteps(world, static_cast<int>(10 * rate));
    // the smooth part is a parabola over neighbouring samples: what a third difference leaves is jitter
    std::vector<Vector3d> a;
    for (int i = 0; i < 20000; ++i) {
      world.Step();
      a.push_back(world.state().a_WB_W);
    }
    double sum = 0;
    for (std::size_t i = 3; i < a.size(); ++i) {
      sum += (a[i] - 3 * a[i - 1] + 3 * a[i - 2] - a[i - 3]).squaredNorm() / 20;  // 1 + 9 + 9 + 1
    }
    const double jitter = std::sqrt(sum / static_cast<double>(a.size() - 3));
    EXPECT_LT(jitter, 1e-10) << rate << " Hz";
    RecordProperty("jitter_m_s2_" + std::to_string(int(rate)) + "_Hz",
                   std::to_string(jitter * 1e12) + "e-12");
  }
}

TEST(BallWorld, ClimbsTheOuterWallOfABendByTheBalanceOfForces) {
  // Steady rolling around a horizontal bend at the angle phi up the wall:
  //   (m + m_a + I/r^2) v^2/rho cos(phi) = W sin(phi) + (rho V + m_a) u^2/rho cos(phi),  rho = R_c + (R-r)
  //   sin(phi)
  // I/r^2: the wall's friction that turns the spin axis pushes outwards. Here with u = v, as in water.
  const double v = 1, bend_radius = 0.45;
  const double carried = kInertial - 0.1 * 1000 * kVolume;  // rho V + m_a
  double phi = 0;
  for (int i = 0; i < 50; ++i) {
    phi = std::atan((kRolling - carried) * v * v / (bend_radius + kRun * std::sin(phi)) / kWeight);
  }
  const double rho = bend_radius + kRun * std::sin(phi);
  const BoreNetwork line =
      MakeBoreLine({{0, 0, 0}, {0.45, 0, 0}, {0.45, 5, 0}}, {.bend_radius_m = bend_radius});
  ASSERT_EQ(line.network.pipe(0).centreline.size(),
            2U);  // it begins with the bend, turning left about (0, 0.45)
  const Vector3d outward(0, -1, 0);
  const Vector3d n = -std::sin(phi) * outward + std::cos(phi) * Vector3d::UnitZ();
  const Vector3d p(0, -kRun * std::sin(phi), -kRun * std::cos(phi)), velocity(v, 0, 0);
  BallWorld world(line.bore, Ball(0.9), Rate(1000), At(line, p, velocity, n.cross(velocity) / kRadius),
                  [&](const BallInstant& ball) {
                    const Vector3d to_centre = Vector3d(0, bend_radius, ball.p_LB.z()) - ball.p_LB;
                    return BallLoad{carried * v * v / rho * to_centre.normalized() - Vector3d(0, 0, kWeight),
                                    Vector3d::Zero()};
                  });
  double largest = 0;
  while (world.state().spot.piece == 0) {
    const Vector3d d = world.state().X_LB.p - world.state().spot.axis.p_W;
    const double angle = std::atan2(-d.dot(world.state().spot.axis.curvature_W.normalized()), -d.z());
    largest = std::max(largest, std::abs(angle - phi));
    world.Step();
  }
  EXPECT_GT(phi, 0.4);
  EXPECT_LT(largest, 2e-4);
  EXPECT_NEAR(world.state().v_WB_W.norm(), v, 1e-4);
}

TEST(BallWorld, PassesThroughItsOwnCrossingAsIfItWereAlone) {
  // a figure of eight in one plane: the second passage of the crossing looks like any straight
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, -2, 0}});
  const Vector3d v(1, 0, 0);
  BallWorld world(line.bore, Ball(), Rate(1000),
                  At(line, {0.5, 0, -kRun}, v, Vector3d::UnitZ().cross(v) / kRadius), Weight);
  double largest = 0, crossing = line.network.pipe(0).length_m - 2;
  while (world.state().spot.s_m < crossing + 0.5) {
    if (world.state().spot.s_m > crossing - 0.5) {
      const Vector3d d = world.state().X_LB.p - world.state().spot.axis.p_W;
      EXPECT_NEAR(d.norm(), kRun, 1e-9);
      largest = std::max(largest, world.state().a_WB_W.norm());
    }
    world.Step();
  }
  EXPECT_LT(largest, 2.5);  // rocking after the bends: at most W/M sin + v^2/(R - r), far from a bump's 100
  EXPECT_NEAR(world.state().X_LB.p.x(), 2, 0.05);
}

TEST(BallWorld, ClosedLoopEndsWhereItBeganWithoutMeetingItsStart) {
  const BoreNetwork line =
      MakeBoreLine({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0}}, {.bend_radius_m = 1});
  const Vector3d v(0.5, 0, 0);
  BallWorld world(line.bore, Ball(), Rate(1000),
                  At(line, {0, 0, -kRun}, v, Vector3d::UnitZ().cross(v) / kRadius), Weight);
  while (world.state().spot.s_m < line.network.pipe(0).length_m && Seconds(world.state().time) < 60)
    world.Step();
  EXPECT_GE(world.state().spot.s_m, line.network.pipe(0).length_m);
  EXPECT_EQ(world.state().spot.piece, line.network.pipe(0).centreline.size() - 1);
  EXPECT_NEAR(world.state().X_LB.p.x(), 0, kRun + 1e-9);
}

TEST(BallWorld, StopsAtTheWallWhenTheStepIsLong) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {50, 0, 0}});
  BallWorld world(line.bore, Ball(), Rate(100), At(line, {0, 0, 0}, {0, 2, 3}), Weight);
  double farthest = 0;
  for (int i = 0; i < 500; ++i) {
    world.Step();
    farthest = std::max(farthest, (world.state().X_LB.p - world.state().spot.axis.p_W).norm());
  }
  EXPECT_LT(farthest, kRun + 1e-6);
}

TEST(BallWorld, TwoWorldsGiveTheSameBits) {
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {3, 0, 0}, {3, 3, 1}});
  const auto run = [&] {
    BallWorld world(line.bore, Ball(0.4, 3e-4), Rate(1000), At(line, {0, 0.01, -kRun + 1e-3}),
                    [](const BallInstant& b) {
                      return BallLoad{0.5 * (b.spot.axis.tangent_W - b.v_WB_W) - Vector3d(0, 0, kWeight),
                                      -1e-5 * b.w_WB_W};
                    });
    RunSteps(world, 5000);
    return world.state();
  };
  const BallState a = run(), b = run();
  EXPECT_EQ(a.X_LB.p, b.X_LB.p);
  EXPECT_EQ(a.X_LB.q.coeffs(), b.X_LB.q.coeffs());
  EXPECT_EQ(a.v_step_W, b.v_step_W);
  EXPECT_EQ(a.w_WB_W, b.w_WB_W);
}

}  // namespace
}  // namespace piperun::sim
