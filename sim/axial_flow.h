#pragma once

#include "sim/jet.h"

namespace piperun::sim {

/// Flow without swirl about an axis: components along it (s) and away from it (r), with their derivatives.
/// du_r/dr follows from continuity: -(du_s/ds + u_r/r).
struct AxialFlow {
  double axial_m_s = 0;
  double radial_over_r_1_s = 0;  ///< u_r / r, finite on the axis
  double d_axial_ds_1_s = 0;
  double d_axial_dr_1_s = 0;
  double d_radial_ds_1_s = 0;

  double d_radial_dr_1_s() const { return -(d_axial_ds_1_s + radial_over_r_1_s); }
};

/// One part of a Stokes stream function that is self-similar in r c(s):
///
///   Psi(s, r) = W(s) H(x),   x = r c(s)
///
/// `mean` = H/x^2, `slope` = H'/x and `shear` = (H'' - H'/x)/x, all finite on the axis.
struct StreamTerm {
  Jet weight_m3_s;  ///< W
  Jet scale_1_m;    ///< c
  double mean = 0;
  double slope = 0;
  double shear = 0;
};

/// Adds to `flow` at r what the term contributes:
///
///   u_s = 1/r dPsi/dr,   u_r = -1/r dPsi/ds
///
/// Whatever W, c and H are, the flow is divergence-free; where Psi does not vary along the wall, it is
/// tangent to the wall. Batchelor, An Introduction to Fluid Dynamics, 2.2.
void AddStreamTerm(const StreamTerm& term, double r_m, AxialFlow& flow);

}  // namespace piperun::sim
