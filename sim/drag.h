#pragma once

#include <cmath>
#include <string_view>

namespace piperun::sim {

/// A Reynolds number with its natural logarithm: most laws need it, and it costs as much as they do.
struct Reynolds {
  double value = 0;
  double log = 0;  ///< -infinity at rest

  Reynolds(double number) : value(number), log(std::log(number)) {}  // NOLINT: a number is what it is
  Reynolds(double number, double logarithm) : value(number), log(logarithm) {}
};

/// Drag coefficients C_D of a free smooth sphere, Re = |u_rel| d / nu, log to base 10:
///
///   brown_lawler       24/Re (1 + 0.150 Re^0.681) + 0.407 / (1 + 8710/Re)               Re < 2e5
///   clift_gauvin       24/Re (1 + 0.152 Re^0.677) + 0.417 / (1 + 5070 Re^-0.94)         Re < 2e5
///   clift_gauvin_1970  24/Re (1 + 0.15 Re^0.687) + 0.42 / (1 + 42500 Re^-1.16)          Re < 3e5
///   clift_grace_weber  ten segments, below                                              Re < 1e6
///   morrison           24/Re + 2.6 (Re/5) / (1 + (Re/5)^1.52)
///                      + 0.411 X^-7.94 / (1 + X^-8) + Re^0.8/461000, X = Re/263000      Re < 1e6
///   barati_high        8e-6 ((Re/6530)^2 + tanh Re - 8 log Re)
///                      - 0.4119 exp(-2.08e43 / (Re + Re^2)^4)
///                      - 2.1344 exp(-(log(Re^2 + 10.7563)^2 + 9.9867) / Re)
///                      + 0.1357 exp(-((Re/1620)^2 + 10370) / Re)
///                      - 8.5e-3 (2 log tanh tanh Re - 2825.7162) / Re + 2.4795          Re < 1e6
///
/// Sources: Brown & Lawler, J. Environ. Eng. 129, 222 (2003), from memory; Clift & Gauvin, Proc. Chemeca 70,
/// 14 (1970), the refit as printed by Barati et al., the original from memory; Clift, Grace & Weber, Bubbles,
/// Drops, and Particles (1978), table 5.2; Morrison, An Introduction to Fluid Mechanics (2013); Barati,
/// Salehi Neyshabouri & Ahmadi, Powder Technol. 257, 11 (2014).
///
/// Clift, Grace & Weber, with L = log Re:
///
///   Re <    0.01    24/Re + 3/16
///   Re <   20       24/Re (1 + 0.1315 Re^(0.82 - 0.05 L))
///   Re <  260       24/Re (1 + 0.1935 Re^0.6305)
///   Re < 1500       log C_D =  1.6435 - 1.1242 L + 0.1558 L^2
///   Re <    1.2e4   log C_D = -2.4571 + 2.5558 L - 0.9295 L^2 + 0.1049 L^3
///   Re <    4.4e4   log C_D = -1.9181 + 0.6370 L - 0.0636 L^2
///   Re <    3.38e5  log C_D = -4.3390 + 1.5809 L - 0.1546 L^2
///   Re <    4e5     29.78 - 5.3 L
///   Re <    1e6     0.10 L - 0.49       reprints have 0.19 L, which would jump by 0.5 at 4e5
///   above           0.19 - 8e4/Re       from memory; meets its neighbour at 1e6
///
/// Neighbouring segments do not meet (by 21 % at 4e5, by up to 0.8 % elsewhere): below each limit a segment
/// goes over into the next by a cubic step, over the last 5 % of Re. Below Re = 0.01 Barati's formula, which
/// grows without bounds at rest, is a straight line C_D Re to Stokes' 24.
enum class DragLaw { kBrownLawler, kCliftGauvin, kCliftGauvin1970, kCliftGraceWeber, kMorrison, kBaratiHigh };

/// How a law is called and how far it goes.
struct DragLawInfo {
  DragLaw law;
  std::string_view key;    ///< in scenarios
  std::string_view name;   ///< of its authors
  double max_reynolds;     ///< up to which it was fitted
  double crisis_reynolds;  ///< where C_D begins to fall into the drag crisis; infinite: it has none
};

const DragLawInfo& FindDragLaw(DragLaw law);
/// By its key; aborts on a key that ForceParams does not offer.
const DragLawInfo& FindDragLaw(std::string_view key);

/// C_D Re, which is finite at rest: 24 (Stokes). Range: any Re >= 0; beyond the law's own it is what the
/// formula gives.
double CalcDragTimesReynolds(DragLaw law, const Reynolds& reynolds);

/// C_D itself. Range: Re > 0.
double CalcDragCoefficient(DragLaw law, const Reynolds& reynolds);

/// A law for a surface: rough spheres (roughness from 1e-3 of the diameter) and foam-covered ones pass into
/// their crisis early and come out of it with a C_D near 0.4 (Achenbach, J. Fluid Mech. 65, 113 (1974)). For
/// them C_D is held, from where the law begins to fall, at its value there: a modelling choice.
struct SphereDrag {
  DragLaw law = DragLaw::kBrownLawler;
  bool crisis = true;  ///< the surface is smooth

  double TimesReynolds(const Reynolds& reynolds) const;
};

/// Torque coefficient of a spinning sphere times its spin Reynolds number, C_w Re_w, finite at rest:
///
///   T = 1/2 rho r^5 C_w |w| w,   Re_w = d^2 |w| / nu (on the diameter),
///   C_w Re_w = 64 pi (Re_w <= 32, Stokes: T = 8 pi mu r^3 w),   12.9 sqrt(Re_w) + 128.4 above.
///
/// Dennis, Singh & Ingham, J. Fluid Mech. 101, 257 (1980), fitted for 20 < Re_w < 4e3; the two branches meet
/// within 0.2 %, and with Re_w on the diameter the high end is the boundary layer law 6.45 / sqrt(r^2 w / nu)
/// of Sawatzki, Acta Mech. 9, 159 (1970), used to Re_w ~ 2e5. Turbulent above, where it is too small.
double CalcSpinTorqueTimesReynolds(double spin_reynolds);

}  // namespace piperun::sim
