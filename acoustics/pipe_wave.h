#pragma once

#include <complex>
#include <vector>

#include "acoustics/pipe_section.h"
#include "base/network.h"
#include "base/water.h"

namespace piperun::acoustics {

/// The plane (s = 1) wave of one fluid-filled pipe below the first cut-on: its complex wavenumber
///
///   k = (omega/c_0) n(f) - i sqrt(omega nu / 2) / (a_i c_0) Re n(f),   time as exp(+i omega t),
///
/// c_0 the speed of low frequencies, n the wall's share (below), and then the laminar friction at the wall
/// (Kirchhoff). With X = 2 B/(a K_p), B = rho c_f^2, and K_p, m, eta, a of the wall's ring (pipe_section.h),
///
///   compact       n = 1 - i eta X / (2 (1 + X))
///   wall_inertia  n^2 = (1 + X/D) / (1 + X/D_0),   D = 1 + i eta - omega^2 m/K_p + K_s/K_p
///
/// D_0 = 1 + 2 G/(a K_p) at rest, K_s the soil's stiffness (soil.h). Compact is the first order in eta of the
/// other without mass and soil: Gao, Brennan, Joseph, Muggleton & Hunaidi, J. Sound Vib. 277, 133 (2004). The
/// other is Scussel, Brennan et al., Acoustics 6, 157 (2024): Muggleton, Brennan & Pinnington, J. Sound Vib.
/// 249, 939 (2002) without the axial coupling.
///
/// Worst errors of speed and loss against the full shell-fluid determinant, in air, at 0.05, 0.1 and 0.15
/// ring frequencies: compact 1.0 and 3.0 %, 2.2 and 6.0 %, 4.6 and 12.8 %; wall_inertia -, 1.7 and 4.5 %, 3.4
/// and 9.3 %. So kAuto is compact up to 0.1 and wall_inertia from 0.125 to 0.15 ring frequencies; between
/// them n goes from one to the other along a smoothstep. A pipe in soil is wall_inertia from zero on.
///
/// Above 0.15 ring frequencies n stays what it is there (a constant speed, the same loss per wavelength):
/// a continuous extrapolation that rises with frequency, and less than the true loss does. kWallInertia
/// without soil goes on to 0.5 before it is held.
struct PipeWave {
  double speed_m_s = 0;  ///< c_0
  double X = 0;          ///< 2 B/(a K_p): compliance of the wall over that of the water
  double loss_factor = 0;
  double bore_radius_m = 0;
  double area_m2 = 0;
  double kinematic_viscosity_m2_s = 0;
  double impedance_Pa_s_m3 = 0;  ///< rho c_0 / A
  double ring_frequency_Hz = 0;
  double cut_on_Hz = 0;  ///< 1.8412 c_f / (2 pi a_i): above it the plane wave is not alone
  WaveLaw law = WaveLaw::kCompact;
  double breathing_frequency_Hz = 0;                 ///< sqrt(K_p/m) / (2 pi)
  std::vector<std::complex<double>> soil_indices{};  ///< n in soil at even steps from 0 to held_from_Hz()

  /// k in rad/m. Range f >= 0.
  std::complex<double> Wavenumber_rad_m(double f_Hz) const;
  /// omega / Re k; of f = 0: c_0.
  double Speed_m_s(double f_Hz) const;
  /// alpha = -Im k in Np/m. A level falls by 8.686 alpha dB/m.
  double Attenuation_Np_m(double f_Hz) const;
  /// Zc = rho omega / (A Re k).
  double CharacteristicImpedance_Pa_s_m3(double f_Hz) const;
  /// Above it n is held; infinite of the compact law, whose n is the same everywhere.
  double held_from_Hz() const;

  friend bool operator==(const PipeWave&, const PipeWave&) = default;

 private:
  std::complex<double> CalcIndex(double f_Hz) const;
};

/// The wave of a pipe. Throws InputError as CalcWallRing and RequireSoil do, for the compact law in soil, and
/// for a soil in which the wave cannot be told.
PipeWave CalcPipeWave(const PipeSection& section, const WaterProperties& water);

/// The same of a wall of one layer, in air, by the compact law.
PipeWave CalcPipeWave(double bore_diameter_m, double wall_thickness_m, const WallMaterial& wall,
                      const WaterProperties& water);

}  // namespace piperun::acoustics
