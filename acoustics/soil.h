#pragma once

#include <complex>

namespace piperun::acoustics {

/// The ground around a buried pipe: an elastic space without losses of its own.
struct Soil {
  double bulk_modulus_Pa = 0;
  double shear_modulus_Pa = 0;  ///< G
  double density_kg_m3 = 0;

  friend bool operator==(const Soil&, const Soil&) = default;
};

/// Outward radial stress on the soil over the radial displacement of a cylindrical hole of radius r that
/// slides along it without friction, both going as exp(i omega t - i k z), in Pa/m:
///
///   K_s = G {2/r - [(2 k^2 - k_s^2)^2 g(k_d^2 - k^2) + 4 k^2 (k_s^2 - k^2) g(k_s^2 - k^2)] / k_s^2},
///   g(q) = H0(sqrt(q) r) / (sqrt(q) H1(sqrt(q) r)) for q > 0,  K0(sqrt(-q) r) / (sqrt(-q) K1(sqrt(-q) r))
///   else,
///
/// k_d = omega / sqrt((B + 4G/3)/rho) and k_s = omega / sqrt(G/rho) of the soil's two waves, H of the second
/// kind: a wave slower than the pipe's is radiated (Im K_s > 0), a faster one clings to the pipe. From the
/// displacement potentials of an elastic space, as Muggleton, Brennan & Pinnington, J. Sound Vib. 249, 939
/// (2002) load a pipe. At rest it is 2 G/r, with a radiated part that grows with frequency.
/// Range: omega > 0; k real, so for pipe waves that lose little per wavelength.
std::complex<double> CalcSoilStiffness_Pa_m(const Soil& soil, double radius_m, double omega_rad_s,
                                            double k_rad_m);

/// Throws InputError for a modulus or density that is not a positive number.
void RequireSoil(const Soil& soil);

}  // namespace piperun::acoustics
