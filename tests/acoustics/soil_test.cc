#include "acoustics/soil.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr Soil kSand{53e6, 20e6, 2000};         // waves of 200 and 100 m/s
constexpr Soil kStiffClay{4.5e9, 180e6, 2000};  // 1539 and 300 m/s

TEST(Soil, AtRestHoldsLikeALongHoleUnderPressure) {
  // Lame: u = p r / (2 G) around a cylindrical hole in an elastic space
  for (const Soil& soil : {kSand, kStiffClay}) {
    const Complex K = CalcSoilStiffness_Pa_m(soil, 0.08, 2 * pi * 0.01, 2 * pi * 0.01 / 400);
    EXPECT_NEAR(K.real() / (2 * soil.shear_modulus_Pa / 0.08), 1, 1e-6);
    EXPECT_NEAR(K.imag() / K.real(), 0, 1e-6);
  }
}

TEST(Soil, OfShortWavesIsTheImpedanceOfAPlaneWave) {
  // a pipe wave far faster than both: k = 0, and r many wavelengths: i omega rho c_d
  const double omega = 2 * pi * 1e6, c_d = std::sqrt((53e6 + 20e6 * 4 / 3) / 2000);
  const Complex K = CalcSoilStiffness_Pa_m(kSand, 0.08, omega, 0);
  EXPECT_NEAR(K.imag() / (omega * 2000 * c_d), 1, 1e-3);
  EXPECT_NEAR(K.real() / K.imag(), 0, 2e-3);
}

/// Power radiated per metre and squared radial displacement, over 2 pi: energy flux far away of the two
/// potentials phi = A H0(kappa_d r) and psi = B H1(kappa_s r), 2 rho omega^3 (|A|^2 + |B|^2), of which only
/// waves that travel outward count; A and B from u_r = 1 and no shear stress at r.
double CalcRadiatedPower(const Soil& soil, double r, double omega, double k) {
  const double G = soil.shear_modulus_Pa, rho = soil.density_kg_m3;
  const double kd2 = rho * omega * omega / (soil.bulk_modulus_Pa + 4 * G / 3), ks2 = rho * omega * omega / G;
  const double kappa_s = std::sqrt(ks2 - k * k);
  const auto hankel1 = [](double x) {
    return std::hypot(std::cyl_bessel_j(1.0, x), std::cyl_neumann(1.0, x));
  };
  const double slope = std::abs(2 * k * k - ks2) / ks2;  // A d/dr H0 for u_r = 1
  const double B = 2 * k * slope / (std::abs(2 * k * k - ks2) * hankel1(kappa_s * r));
  double A = 0;
  if (kd2 > k * k) A = slope / (std::sqrt(kd2 - k * k) * hankel1(std::sqrt(kd2 - k * k) * r));
  return rho * omega * omega * omega * (A * A + B * B) / pi;
}

TEST(Soil, TakesFromThePipeWhatItRadiates) {
  struct Case {
    Soil soil;
    double c_m_s;
  };
  // in sand both waves leave the pipe, in clay the shear wave alone
  for (const Case& c : {Case{kSand, 413}, Case{kStiffClay, 540}}) {
    for (const double f_Hz : {50.0, 200.0, 500.0, 1500.0}) {
      const double omega = 2 * pi * f_Hz, k = omega / c.c_m_s, r = 0.08;
      const double taken = 0.5 * omega * CalcSoilStiffness_Pa_m(c.soil, r, omega, k).imag() * r;
      EXPECT_NEAR(taken / CalcRadiatedPower(c.soil, r, omega, k), 1, 1e-9) << f_Hz;
    }
  }
}

TEST(Soil, OfFastWavesTakesNothing) {
  // a pipe wave slower than both waves of the soil radiates neither
  EXPECT_EQ(CalcSoilStiffness_Pa_m(kStiffClay, 0.08, 2 * pi * 500, 2 * pi * 500 / 250).imag(), 0);
}

TEST(Soil, RefusesAGroundThatIsNone) {
  EXPECT_THROW(RequireSoil({0, 20e6, 2000}), InputError);
  EXPECT_THROW(RequireSoil({53e6, -1, 2000}), InputError);
  EXPECT_THROW(RequireSoil({53e6, 20e6, NAN}), InputError);
}

}  // namespace
}  // namespace piperun::acoustics
