#pragma once

namespace piperun::sim {

/// Added mass of a sphere over the mass of water it displaces, C_a, for motion along a bore that it touches:
/// the larger of
///
///   0.621                                                 along a plane it touches (potential flow)
///   3 / (2 - 1.59365 l^3 - 0.1225 l^10 - 0.113 l^20) - 1  on the axis of an open tube, l = d/D
///
/// The second is our fit, within 0.5 % of 1 + C_a, to the exact potential flow around a sphere on the axis of
/// a tube (multipoles and their images in the wall); its first term, 2/pi int_0^inf k^2 K_1(k)/I_1(k) dk, is
/// twice the image factor 0.797 of Taylor's theorem, and 1/2 (1 + 2.39 l^3) its expansion for small l, 2 %
/// low at l = 0.45 and 7 % at 0.6. The larger is the tube's from l = 0.454. A ball that touches the wall of
/// a narrow tube has more than one on its axis; how much is not known. Range: 0 < l <= 0.95.
double CalcAddedMassCoefficient(double diameter_ratio);

}  // namespace piperun::sim
