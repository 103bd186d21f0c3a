#pragma once

#include "sim/drag.h"

namespace piperun::sim {

/// Drag coefficient of a sphere that rolls down a smooth plane in still liquid, times Re, from its terminal
/// speed V: C_D = (4/3) (SG - 1) g d sin(slope) / V^2, so that it holds every resistance of the water.
///
///   C_D = 322/Re                                                            Re < 10
///   log C_D = 3.02 - 1.89 L + 0.411 L^2 - 0.033 L^3,   L = log Re (to 10)   Re < 2e4
///   C_D = 0.74                                                              above
///
/// Jan & Chen, J. Hydraul. Res. 35, 689 (1997), from memory; the branches are joined where they meet (the
/// last at Re = 1.98e4). 3 to 4 times the free sphere's at Re 1e2 to 1e3, 1.6 times above 2e4. Range: any Re
/// >= 0; taken to hold up to the drag crisis at 2e5.
double CalcRollingDragTimesReynolds(const Reynolds& reynolds);

/// What the wall that a sphere touches adds to its free C_D Re, where the water's torque on its spin is
/// reckoned by itself with the factor k_spin (CalcSpinTorqueTimesReynolds):
///
///   Re dC_D = max(0, Re C_D,rolling - k_spin/(2 pi) (C_w Re_w)(2 Re) - Re C_D,free)
///
/// A ball rolling at V spins with V/r: Re_w = 2 Re, and the torque T weighs on it as a force T/r, which is
/// k_spin C_w / pi in terms of C_D. So this ball rolls down a plane as those of Jan & Chen did.
double CalcContactDragTimesReynolds(const Reynolds& reynolds, double free_drag_times_reynolds,
                                    double spin_factor);

/// How much of the wall's effect on drag and lift a ball feels at a gap from it: (r / (r + gap))^3, as the
/// leading term of its image in potential flow falls. 1 at contact. A choice: no measurements are known.
double CalcWallNearness(double gap_m, double radius_m);

}  // namespace piperun::sim
