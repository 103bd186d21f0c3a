#pragma once

#include <vector>

#include "base/network.h"
#include "base/water.h"

namespace piperun::acoustics {

/// The plane (s = 1) wave of one fluid-filled pipe below the first cut-on.
struct PipeWave {
  double speed_m_s = 0;
  double X = 0;              ///< 2 B a / (E h)
  double loss_factor = 0;
  double bore_radius_m = 0;
  double area_m2 = 0;
  double kinematic_viscosity_m2_s = 0;
  double impedance_Pa_s_m3 = 0;  ///< rho c / A
  double ring_frequency_Hz = 0;
  double cut_on_Hz = 0;  ///< 1.8412 c_f / (2 pi a): above it the plane wave is not alone

  /// alpha = (omega/c) eta X / (2 (1 + X)) + sqrt(omega nu / 2) / (a_i c), in Np/m.
  double Attenuation_Np_m(double f_Hz) const;
};

/// Korteweg's speed with wall loss and laminar wall viscosity (the compact form; valid below 0.1 ring
/// frequency within 2.2 % in speed and 6 % in attenuation).
PipeWave CalcPipeWave(double bore_diameter_m, double wall_thickness_m, const WallMaterial& wall,
                      const WaterProperties& water);

/// A stretch of the route with one wave.
struct AcousticLeg {
  double chainage_begin_m = 0;
  double length_m = 0;
  PipeWave wave;
};

}  // namespace piperun::acoustics
