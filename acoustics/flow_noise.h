#pragma once

#include <cmath>

#include "base/water.h"

namespace piperun::acoustics {

/// Scales of the turbulent flow along the wall of a bore.
struct WallFlow {
  double edge_speed_m_s = 0;   ///< Ue = 1.2 U
  double thickness_m = 0;      ///< delta = a, the bore radius
  double wall_shear_Pa = 0;    ///< tau_w
  double timescale_ratio = 0;  ///< R_T = (delta / Ue) / (nu / u_tau^2)
};

/// Developed flow of bulk speed U > 0 in a smooth bore: tau_w = lambda rho U^2 / 8 with Blasius' lambda =
/// 0.3164 Re^(-1/4), which is within 2 % of Haaland's smooth law for Re of 4e3 to 1e5 and 5 % at 2e5. Below
/// 4e3 it is kept as a smooth extrapolation: a ball drifting that closely meets eddies of the main flow, not
/// a laminar one, and what it hears of them lies below its own noise above a few hertz.
WallFlow CalcWallFlow(double speed_m_s, double bore_radius_m, const WaterProperties& water);

/// Point pressure spectrum under a turbulent boundary layer (Goody, AIAA J. 42, 1788 (2004)):
///   Phi(omega) Ue / (tau_w^2 delta) = 3 x^2 / ((x^0.75 + 0.5)^3.7 + (1.1 R_T^-0.57 x)^7),  x = omega delta /
///   Ue.
/// Returned one-sided in hertz, S(f) = 2 pi Phi(2 pi f), in Pa^2/Hz. Fitted for R_T of 20 to 7000. Range f >=
/// 0.
double CalcWallPressurePsd(const WallFlow& flow, double f_Hz);

/// Averaging over a hydrophone face of radius r: 1 / (1 + omega r / Uc)^2 with the convection speed
/// Uc = 0.7 Ue; a fit to Corcos, J. Acoust. Soc. Am. 35, 192 (1963). Eddies smaller than the face cancel.
double CalcFaceAveraging(const WallFlow& flow, double face_radius_m, double f_Hz);

/// Speed at which the eddies pass a ball: |U - v| + 0.1 |U|, slip plus the turbulence that carries it.
inline double CalcEddySpeed(double slip_speed_m_s, double water_speed_m_s) {
  return slip_speed_m_s + 0.1 * std::abs(water_speed_m_s);
}

}  // namespace piperun::acoustics
