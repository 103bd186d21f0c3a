#include "sim/added_mass.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace piperun::sim {
namespace {

constexpr int kTerms = 12;

/// 2/pi int k^(n+m) K_1(k)/I_1(k) dk / (n! m!) for odd n and m, by midpoints: how the wall's image of one
/// multipole appears in another.
Eigen::MatrixXd CalcImages() {
  constexpr double kStep = 0.02;
  Eigen::MatrixXd images = Eigen::MatrixXd::Zero(kTerms, kTerms);
  for (double k = 0.5 * kStep; k < 120; k += kStep) {
    const double density =
        2 / std::numbers::pi * kStep * std::cyl_bessel_k(1.0, k) / std::cyl_bessel_i(1.0, k);
    Eigen::VectorXd power(kTerms);  // k^n / n!
    for (int i = 0; i < kTerms; ++i) {
      power(i) = std::exp((2 * i + 1) * std::log(k) - std::lgamma(2 * i + 2.0));
    }
    images += density * power * power.transpose();
  }
  return images;
}

/// C_a of a sphere on the axis of a tube, exact potential flow. phi = sum B_n (P_n/r^(n+1) + sum A_nm r^m
/// P_m), n and m odd; A_nm from 1/r = 2/pi int K_0(k rho) cos(kz) dk, differentiated n times, plus the image
/// K_1/I_1 I_0(k rho) that makes the wall (radius 1) impermeable. On the sphere dphi/dr = cos(theta).
double SolveAddedMass(double l) {
  static const Eigen::MatrixXd images = CalcImages();
  Eigen::MatrixXd matrix(kTerms, kTerms);
  for (int i = 0; i < kTerms; ++i) {
    for (int j = 0; j < kTerms; ++j) {
      const int m = 2 * i + 1, n = 2 * j + 1;
      const double a = ((i + j) % 2 ? -1 : 1) * images(i, j);
      matrix(i, j) = m * a * std::pow(l, m + n + 1) / (n + 1) - (i == j ? 1 : 0);
    }
  }
  const Eigen::VectorXd b = matrix.partialPivLu().solve(Eigen::VectorXd::Unit(kTerms, 0));
  return -1.5 * b(0) - 1;  // B_1 = b l^3/2, C_a = -(3 B_1/l^3 + 1)
}

TEST(AddedMass, OnTheAxisOfATubeIsPotentialFlows) {
  for (const double l : {0.5, 0.7, 0.8, 0.9, 0.95}) {
    EXPECT_NEAR((1 + CalcAddedMassCoefficient(l)) / (1 + SolveAddedMass(l)), 1, 5e-3) << l;
  }
  // the published expansion, 1/2 (1 + 2.39 l^3), and its next term, 1/2 3 (0.797 l^3)^2, for a small sphere
  EXPECT_NEAR(SolveAddedMass(0.2), 0.5 * (1 + 2.39 * 0.008) + 1.5 * 0.797 * 0.797 * 6.4e-5, 1e-5);
}

TEST(AddedMass, OfASmallBallIsThatAlongAPlaneItTouches) {
  for (const double l : {0.01, 0.1, 0.4, 0.45}) EXPECT_EQ(CalcAddedMassCoefficient(l), 0.621) << l;
  EXPECT_GT(CalcAddedMassCoefficient(0.46), 0.621);
}

}  // namespace
}  // namespace piperun::sim
