#include "acoustics/soil.h"

#include <cmath>
#include <string>

#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr double kFarEvanescent = 600;  // K0 and K1 underflow beyond; their ratio is 1 within 1e-3

/// Hankel function of the second kind: what runs outward with exp(i omega t).
Complex CalcHankel(double order, double x) {
  return {std::cyl_bessel_j(order, x), -std::cyl_neumann(order, x)};
}

/// g(q) of the docstring, q other than 0.
Complex CalcRadialRatio_m(double q_1_m2, double radius_m) {
  const double kappa_1_m = std::sqrt(std::abs(q_1_m2)), x = kappa_1_m * radius_m;
  if (q_1_m2 > 0) return CalcHankel(0, x) / (kappa_1_m * CalcHankel(1, x));
  if (x > kFarEvanescent) return 1 / kappa_1_m;
  return std::cyl_bessel_k(0.0, x) / (kappa_1_m * std::cyl_bessel_k(1.0, x));
}

void RequirePositive(double value, const std::string& key) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; it must be a finite number > 0", key);
}

}  // namespace

std::complex<double> CalcSoilStiffness_Pa_m(const Soil& soil, double radius_m, double omega_rad_s,
                                            double k_rad_m) {
  const double G = soil.shear_modulus_Pa, inertia = soil.density_kg_m3 * omega_rad_s * omega_rad_s;
  const double k2 = k_rad_m * k_rad_m, ks2 = inertia / G, kd2 = inertia / (soil.bulk_modulus_Pa + 4 * G / 3);
  const double twist = 2 * k2 - ks2;
  const Complex dilatation = twist * twist * CalcRadialRatio_m(kd2 - k2, radius_m);
  const Complex shear = 4 * k2 * (ks2 - k2) * CalcRadialRatio_m(ks2 - k2, radius_m);
  return G * (2 / radius_m - (dilatation + shear) / ks2);
}

void RequireSoil(const Soil& soil) {
  RequirePositive(soil.bulk_modulus_Pa, "soil.bulk_modulus_Pa");
  RequirePositive(soil.shear_modulus_Pa, "soil.shear_modulus_Pa");
  RequirePositive(soil.density_kg_m3, "soil.density_kg_m3");
}

}  // namespace piperun::acoustics
