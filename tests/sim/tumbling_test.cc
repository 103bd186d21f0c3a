#include "sim/tumbling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace piperun::sim {
namespace {

struct Tumble {
  Quaterniond q = Quaterniond::Identity();
  Vector3d momentum_W;
  double energy_J = 0;  // of the last half step
};

/// Torque-free from the attitude E.
Tumble TumbleFor(const RotaryInertia& inertia, const Vector3d& w, double seconds, double dt) {
  Tumble out;
  Tumbling body(inertia, out.q, w);
  const auto steps = std::llround(seconds / dt);
  for (long long i = 0; i < steps; ++i) {
    body.Kick(Vector3d::Zero(), out.q, dt);
    out.q = (ExpSO3(dt * body.w_kicked_W()) * out.q).normalized();
    body.Finish(Vector3d::Zero(), true);
  }
  out.momentum_W = body.momentum_W();
  out.energy_J = 0.5 * body.momentum_W().dot(body.w_kicked_W());
  return out;
}

Matrix3d Diagonal(double x, double y, double z) { return Vector3d(x, y, z).asDiagonal(); }

TEST(Tumbling, SymmetricTopPrecessesAsEulerSays) {
  // I1 = I2: the axis turns about L at L/I1, the body about its axis at (1 - I3/I1) w3 besides
  const double i1 = 4e-5, i3 = 6e-5;
  const Vector3d w(6, 0, 20), L(i1 * w.x(), 0, i3 * w.z());
  const double seconds = 2;
  const Quaterniond exact =
      ExpSO3(seconds * L / i1) * ExpSO3(Vector3d(0, 0, seconds * (1 - i3 / i1) * w.z()));
  const Tumble coarse = TumbleFor(Diagonal(i1, i1, i3), w, seconds, 1e-3);
  const Tumble fine = TumbleFor(Diagonal(i1, i1, i3), w, seconds, 5e-4);
  const double coarse_rad = LogSO3(exact.conjugate() * coarse.q).norm();
  const double fine_rad = LogSO3(exact.conjugate() * fine.q).norm();
  EXPECT_LT(coarse_rad, 2e-3);  // (w dt)^2/24 of 40 rad, times the anisotropy
  EXPECT_GT(std::log2(coarse_rad / fine_rad), 1.9);
}

/// Euler's equations with Runge and Kutta's fourth order at 20 us; error below 1e-10 rad in a second.
Quaterniond IntegrateEuler(const Vector3d& moments, Vector3d w_B, double seconds) {
  const auto rate = [&](const Vector3d& w) {
    return Vector3d(moments.cwiseProduct(w).cross(w).cwiseQuotient(moments));
  };
  Quaterniond q = Quaterniond::Identity();
  const double h = 2e-5;
  const auto steps = std::llround(seconds / h);
  for (long long i = 0; i < steps; ++i) {
    const Vector3d k1 = rate(w_B), k2 = rate(w_B + h / 2 * k1), k3 = rate(w_B + h / 2 * k2),
                   k4 = rate(w_B + h * k3);
    const Vector3d w_mid = w_B + h / 2 * k2;
    const Vector3d w_end = w_B + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    // fourth order of the rotation vector: Simpson's mean, and the commutator of its ends
    q = q * ExpSO3(h / 6 * (w_B + 4 * w_mid + w_end) + h * h / 12 * w_B.cross(w_end));
    w_B = w_end;
  }
  return q;
}

TEST(Tumbling, AsymmetricBodyConvergesToEulersEquationsWithSecondOrder) {
  const Vector3d moments(3e-5, 4e-5, 6e-5), w(1, 15, 2);  // near the unstable axis: it flips over
  const Quaterniond exact = IntegrateEuler(moments, w, 1);
  const auto error = [&](double dt) {
    return LogSO3(exact.conjugate() * TumbleFor(Matrix3d(moments.asDiagonal()), w, 1, dt).q).norm();
  };
  const double coarse = error(1e-3), fine = error(5e-4);
  EXPECT_GT(std::log2(coarse / fine), 1.9);
  EXPECT_LT(fine, 2e-3);
}

TEST(Tumbling, KeepsMomentumToRoundingAndEnergyToSecondOrder) {
  const Matrix3d inertia = Diagonal(3e-5, 4e-5, 6e-5);
  const Vector3d w(1, 15, 2), L = inertia * w;
  const double energy = 0.5 * w.dot(L);
  const Tumble coarse = TumbleFor(inertia, w, 100, 1e-3), fine = TumbleFor(inertia, w, 100, 5e-4);
  EXPECT_EQ(coarse.momentum_W, L);
  EXPECT_LT(std::abs(coarse.energy_J / energy - 1), 1e-4);
  EXPECT_LT(std::abs(fine.energy_J / energy - 1), 2.5e-5);
}

TEST(Tumbling, TurningAVectorIsExactForSmallAngles) {
  // (Exp(theta) - E) x = theta x x + theta x (theta x x)/2 + O(theta^3)
  const Vector3d theta(1e-9, -2e-9, 3e-9), x(0.3, 0.1, -0.2);
  const Vector3d series = theta.cross(x) + 0.5 * theta.cross(theta.cross(x));
  EXPECT_LT((CalcTurnedBy(theta, x) - series).norm(), 1e-15 * series.norm());
}

TEST(RotaryInertia, TurnsMomentumIntoRateAndBackByItsTensor) {
  Matrix3d inertia;
  inertia << 5e-5, 3e-6, -2e-6, 3e-6, 4e-5, 1e-6, -2e-6, 1e-6, 6e-5;
  const RotaryInertia rotary(inertia);
  const Matrix3d R = ExpSO3({0.3, -0.7, 1.1}).toRotationMatrix();
  const Vector3d w(3, -4, 5);
  const Vector3d L = R * inertia * R.transpose() * w;
  EXPECT_LT((rotary.Momentum(R, w) - L).norm(), 1e-15 * L.norm());
  EXPECT_LT((rotary.Rate(R, L) - w).norm(), 1e-14 * w.norm());
  EXPECT_FALSE(rotary.isotropic());
  EXPECT_NEAR(rotary.R_BI().determinant(), 1, 1e-14);
  const Matrix3d again = rotary.R_BI() * rotary.moments_kg_m2().asDiagonal() * rotary.R_BI().transpose();
  EXPECT_LT((again - inertia).norm(), 1e-15 * inertia.norm());
}

}  // namespace
}  // namespace piperun::sim
