#pragma once

#include "base/leak.h"
#include "base/params.h"

namespace piperun::acoustics {

/// The jet through a hole, as every kind of leak sound begins with it.
struct JetParams {
  double relative_fluctuation = 2e-3;
  double flow_exponent = 0;
  double pressure_exponent = 0;
  double strouhal = 0.15;

  void Visit(ParamVisitor& v);
};

/// Whether water leaves the hole: a leak without outflow is silent.
inline bool IsFlowing(const LeakState& state) { return state.flow_m3_s > 0 && state.pressure_drop_Pa > 0; }

/// U = sqrt(2 dP / rho), the speed of a jet. Range dP >= 0.
double CalcJetSpeed_m_s(double pressure_drop_Pa, double water_density_kg_m3);

/// Spectrum of a turbulent jet's volume-velocity fluctuation, one-sided, in (m3/s)^2/Hz:
///   S_q(f) = (eps Q)^2 g(f),  g(f) = (1 + (f/fc)^2)^(-5/4) / (1.198 fc),  integral of g = 1,
///   fc = St U / d,  eps = eps0 (dP / 3 bar)^b (Q / 1 L/min)^a.
/// An engineering model: the corner agrees in order with the 1-4 kHz of small holes in a petrol line (Eckert
/// & Maresca, EPA/600/A-93/095), the tail of -25 dB/decade with hydrophone records of a 152 mm PVC rig
/// (-20 to -24 dB/decade, 0.5-3 kHz). No calibrated in-pipe source level of a water leak is published: eps0
/// is uncertain by 15 dB either way. a = -0.5, b = 1.25 gives the dipole-like p^2 ~ Q dP^2.5.
class JetSpectrum {
 public:
  /// Without flow, or pressure to drive it, the jet is silent.
  JetSpectrum(const JetParams& params, double hole_diameter_m, const LeakState& state,
              double water_density_kg_m3);

  /// S_q(f). Range f >= 0.
  double operator()(double f_Hz) const;

 private:
  double corner_Hz_ = 1;
  double plateau_ = 0;  // (m3/s)^2/Hz; zero: silent
};

}  // namespace piperun::acoustics
