// Balls whose mass lies off their centre, against equations of motion written down and integrated here.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
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

constexpr double kRadius = 0.03, kBore = 0.075, kRun = kBore - kRadius, kGravity = 9.80665;
constexpr double kMass = 0.13, kAdded = 0.07, kDisplaced = 0.113, kOffset = 0.004;
constexpr double kNetWeight = (kMass - kDisplaced) * kGravity;

/// Heavy below its centre, unequal moments about axes of the ball.
BallParams Params() {
  BallParams ball;
  ball.radius_m = kRadius;
  ball.given_mass_kg = kMass;
  ball.center_of_mass_B_m = {0, 0, -kOffset};
  ball.inertia_kg_m2 = {5e-5, 0, 0, 0, 4e-5, 0, 0, 0, 6e-5};
  return ball;
}

TubeBall Ball(double friction) {
  const BallMass mass = CalcBallMass(Params(), kAdded);
  TubeBall ball{kRadius, mass.mass_kg, mass.inertia_B_kg_m2, friction};
  ball.p_BM_B = mass.p_BM_B;
  return ball;
}

/// Weight at the centre of mass, buoyancy at the centre.
BallLoadFunction Weight(const Vector3d& gravity) {
  return [gravity](const BallInstant& ball) {
    const Vector3d p_BC = ball.q_WB * Params().center_of_mass_B_m;
    return BallLoad{(kMass - kDisplaced) * gravity, p_BC.cross(kMass * gravity)};
  };
}

/// One degree of freedom x: J(x) x'' + J'(x) x'^2/2 + V'(x) = 0.
struct Oscillator {
  std::function<double(double)> inertia, inertia_slope, potential_slope;
};

/// x and x' after `seconds`: Runge and Kutta, fourth order, 10 us.
std::array<double, 2> Integrate(const Oscillator& o, double x, double v, double seconds) {
  const auto acceleration = [&](double x1, double v1) {
    return -(0.5 * o.inertia_slope(x1) * v1 * v1 + o.potential_slope(x1)) / o.inertia(x1);
  };
  const double h = 1e-5;
  const auto steps = std::llround(seconds / h);
  for (long long i = 0; i < steps; ++i) {
    const double a1 = acceleration(x, v), v2 = v + h / 2 * a1;
    const double a2 = acceleration(x + h / 2 * v, v2), v3 = v + h / 2 * a2;
    const double a3 = acceleration(x + h / 2 * v2, v3), v4 = v + h * a3;
    const double a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return {x, v};
}

/// Rolling along the invert of a pipe that falls by `slope`, x the angle turned, 0 with the mass below:
/// point mass m_a at B, m and I_y at C,
///   J = m_a r^2 + m (r^2 - 2 r c cos x + c^2) + I_y
///   V = -m g c cos(x + slope) - (m - rho V) g sin(slope) r x
Oscillator Rolling(double slope) {
  const double r = kRadius, c = kOffset;
  return {[=](double x) { return kAdded * r * r + kMass * (r * r - 2 * r * c * std::cos(x) + c * c) + 4e-5; },
          [=](double x) { return 2 * kMass * r * c * std::sin(x); },
          [=](double x) {
            return kMass * kGravity * c * std::sin(x + slope) - kNetWeight * std::sin(slope) * r;
          }};
}

/// Rocking across the pipe without slip, x the angle of the centre around the axis; the ball turns by
/// -x (R - r)/r, so that the mass lies at psi = psi0 - x (R - r)/r from below, chi = x - psi, L = R - r:
///   J = m_a L^2 + m L^2 (1 - 2 c/r cos(chi) + c^2/r^2) + I_x L^2/r^2
///   V = -(m - rho V) g L cos x - m g c cos(psi)
Oscillator RockingAcross(double psi0) {
  const double r = kRadius, c = kOffset, L = kRun, k = 1 + L / r;
  const auto psi = [=](double x) { return psi0 - x * L / r; };
  return {[=](double x) {
            return kAdded * L * L +
                   kMass * L * L * (1 - 2 * c / r * std::cos(k * x - psi0) + c * c / (r * r)) +
                   5e-5 * L * L / (r * r);
          },
          [=](double x) { return 2 * kMass * L * L * c / r * std::sin(k * x - psi0) * k; },
          [=](double x) {
            return kNetWeight * L * std::sin(x) - kMass * kGravity * c * std::sin(psi(x)) * L / r;
          }};
}

/// Angle turned about y after rolling for `seconds` along x, from the centre's way; gravity is tilted instead
/// of the pipe.
double RollAlong(double slope, double angle, double rate, double seconds, double rate_Hz) {
  const BoreNetwork line = MakeBoreLine({{-50, 0, 0}, {50, 0, 0}});
  const Vector3d p(0, 0, -kRun), w(0, rate, 0);
  const BallStart start{{p, ExpSO3({0, angle, 0})}, {kRadius * rate, 0, 0}, w, FindSpot(line.network, 0, p)};
  BallWorld world(line.bore, Ball(3), Rate(rate_Hz), start,
                  Weight(kGravity * Vector3d(std::sin(slope), 0, -std::cos(slope))));
  const auto steps = std::llround(seconds * rate_Hz);
  for (long long i = 0; i < steps; ++i) world.Step();
  EXPECT_NEAR(world.state().X_LB.p.z(), -kRun, 1e-7);
  EXPECT_NEAR(world.state().X_LB.p.y(), 0, 1e-9);
  return angle + world.state().X_LB.p.x() / kRadius;
}

void ExpectSecondOrder(const std::function<double(double)>& at_rate_Hz, double exact, double tolerance) {
  const double coarse = std::abs(at_rate_Hz(1000) - exact), fine = std::abs(at_rate_Hz(2000) - exact);
  EXPECT_LT(coarse, tolerance);
  EXPECT_GT(std::log2(coarse / fine), 1.9) << coarse << " and " << fine;
}

TEST(EccentricBall, RollsToAndFroAsLagrangeSays) {
  const double exact = Integrate(Rolling(0), 1.2, 0, 2.3)[0];
  ExpectSecondOrder([](double rate_Hz) { return RollAlong(0, 1.2, 0, 2.3, rate_Hz); }, exact, 2e-4);
}

TEST(EccentricBall, RollsToAndFroWithItsPeriod) {
  // small swings: omega^2 = m g c / (m_a r^2 + m (r - c)^2 + I_y); quarter periods at zero angle
  const double inertia =
      kAdded * kRadius * kRadius + kMass * (kRadius - kOffset) * (kRadius - kOffset) + 4e-5;
  const double period_s = 2 * std::numbers::pi / std::sqrt(kMass * kGravity * kOffset / inertia);
  EXPECT_NEAR(RollAlong(0, 1e-3, 0, period_s, 10000) / 1e-3, 1, 1e-4);
  EXPECT_NEAR(RollAlong(0, 1e-3, 0, 0.25 * period_s, 10000) / 1e-3, 0, 2e-3);
  EXPECT_NEAR(RollAlong(0, 1e-3, 0, 0.5 * period_s, 10000) / 1e-3, -1, 1e-4);
}

TEST(EccentricBall, RollsOnUnevenlyDownASlope) {
  const double slope = 0.1, exact = Integrate(Rolling(slope), 0.3, 12, 2)[0];
  ASSERT_GT(exact, 19);  // three turns and more
  ExpectSecondOrder([&](double rate_Hz) { return RollAlong(slope, 0.3, 12, 2, rate_Hz); }, exact, 2e-3);
}

TEST(EccentricBall, RocksAcrossThePipeAsLagrangeSays) {
  const double x0 = 0.6, psi0 = 0.4;
  const double exact = Integrate(RockingAcross(psi0), x0, 0, 1.7)[0];
  const auto simulate = [&](double rate_Hz) {
    const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {5, 0, 0}});
    const Vector3d p(1, kRun * std::sin(x0), -kRun * std::cos(x0));
    const double psi = psi0 - x0 * kRun / kRadius;  // about x, from below towards y
    const BallStart start{
        {p, ExpSO3({psi, 0, 0})}, Vector3d::Zero(), Vector3d::Zero(), FindSpot(line.network, 0, p)};
    BallWorld world(line.bore, Ball(3), Rate(rate_Hz), start, Weight({0, 0, -kGravity}));
    for (long long i = 0; i < std::llround(1.7 * rate_Hz); ++i) world.Step();
    return std::atan2(world.state().X_LB.p.y(), -world.state().X_LB.p.z());
  };
  ExpectSecondOrder(simulate, exact, 1e-4);
}

/// Kinetic and potential energy from what a state tells; velocities at the instant.
double CalcEnergy_J(const BallState& s) {
  const Vector3d r = s.X_LB.q * Params().center_of_mass_B_m;
  const Vector3d w_B = s.X_LB.q.conjugate() * s.w_WB_W, v_C = s.v_WB_W + s.w_WB_W.cross(r);
  return 0.5 * kAdded * s.v_WB_W.squaredNorm() + 0.5 * kMass * v_C.squaredNorm() +
         0.5 * w_B.dot(Params().Inertia_B_kg_m2() * w_B) + kNetWeight * s.X_LB.p.z() +
         kMass * kGravity * r.z();
}

TEST(EccentricBall, KeepsItsEnergyWhereNothingRubs) {
  // tumbling and sliding in a smooth pipe, held to its wall by a strong side flow's worth of gravity
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {50, 0, 0}});
  const Vector3d p(1, kRun * std::sin(0.5), -kRun * std::cos(0.5));
  const BallStart start{{p, ExpSO3({0.3, -0.2, 0.5})}, {0.3, 0, 0}, {4, 2, -3}, FindSpot(line.network, 0, p)};
  const auto largest_change = [&](double rate_Hz) {
    BallWorld world(line.bore, Ball(0), Rate(rate_Hz), start, Weight({0, 0, -kGravity}));
    double largest = 0;
    world.Step();
    const double energy = CalcEnergy_J(world.state());
    for (long long i = 0; i < std::llround(20 * rate_Hz); ++i) {
      world.Step();
      largest = std::max(largest, std::abs(CalcEnergy_J(world.state()) - energy));
    }
    return largest;
  };
  const double swing = kMass * kGravity * kOffset;  // what goes to and fro
  EXPECT_LT(largest_change(1000) / swing, 1e-4);
}

TEST(EccentricBall, StepsLeadFromPoseToPose) {
  // p = p_before + v_step dt and R = R_before Exp(dtheta), whatever the ball does
  const BoreNetwork line = MakeBoreLine({{0, 0, 0}, {3, 0, 0}, {3, 3, 0.5}});
  const Vector3d p(0.1, 0.01, -kRun + 2e-3);
  const BallStart start{
      {p, ExpSO3({0.3, -0.2, 0.5})}, {2, 0.1, 0}, {4, 25, -3}, FindSpot(line.network, 0, p)};
  TubeBall ball = Ball(0.4);
  ball.rolling_length_m = 3e-4;
  ball.spinning_length_m = 3e-4;
  ball.restitution = 0.3;
  BallWorld world(line.bore, ball, Rate(1000), start, Weight({0, 0, -kGravity}));
  Pose before = world.state().X_LB;
  for (int i = 0; i < 6000; ++i) {
    world.Step();
    const BallState& s = world.state();
    ASSERT_LT((s.X_LB.p - before.p - 1e-3 * s.v_step_W).norm(), 2e-15);
    ASSERT_LT(LogSO3((before.q * ExpSO3(s.dtheta_B_rad)).conjugate() * s.X_LB.q).norm(), 1e-15);
    before = s.X_LB;
  }
  EXPECT_GT(before.p.x(), 2.9);
}

TEST(EccentricBall, HasNoSpuriousSpecificForceFarFromTheOrigin) {
  // the same ball, once near the origin and once far away: once the first contact has taken up the rounding
  // of the start, only that of the steps may differ
  for (const double rate_Hz : {1000.0, 4000.0}) {
    const auto run = [&](const Vector3d& from) {
      const BoreNetwork line = MakeBoreLine({from, from + Vector3d(40, 0, 0)});
      const Vector3d p = from + Vector3d(1, 0, -kRun);
      const BallStart start{{p, ExpSO3({0, 0.7, 0})}, {0.3, 0, 0}, {0, 10, 0}, FindSpot(line.network, 0, p)};
      BallWorld world(line.bore, Ball(0.5), Rate(rate_Hz), start, Weight({0, 0, -kGravity}));
      std::vector<Vector3d> a;
      for (int i = 0; i < int(rate_Hz); ++i) {
        world.Step();
        a.push_back(world.state().a_WB_W);
      }
      return a;
    };
    const auto near = run(Vector3d::Zero()), far = run({412, -230, 61});
    double largest = 0;
    for (std::size_t i = 10; i < near.size(); ++i) largest = std::max(largest, (near[i] - far[i]).norm());
    EXPECT_LT(largest, 1e-8) << rate_Hz;
    RecordProperty("largest_m_s2_" + std::to_string(int(rate_Hz)) + "_Hz",
                   std::to_string(largest * 1e12) + "e-12");
  }
}

}  // namespace
}  // namespace piperun::sim
