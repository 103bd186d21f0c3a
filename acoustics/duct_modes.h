#pragma once

#include <vector>

namespace piperun::acoustics {

/// A mode of the pressure in a round pipe with a rigid wall besides the plane wave, J_m(j' r/a) cos(m theta),
/// j' a zero of J_m' above 0.
struct DuctMode {
  int m = 0;
  double root = 0;  ///< j': k a at its cut-on
  /// Phi(a)^2 where the cosine is 1: of a source in the wall. Phi is the mode over its root mean square in
  /// the cross-section, so Phi(a)^2 = e_m / (1 - m^2/j'^2), e_0 = 1, else 2.
  double at_source = 0;

  /// Phi(r)^2, mean over the angle: J_m(j' r/a)^2 / (J_m(j')^2 (1 - m^2/j'^2)). Its mean over the
  /// cross-section is 1. Range 0 <= r/a <= 1.
  double CalcShape(double r_over_a) const;
};

inline constexpr double kLargestRoot = 40;

/// All modes with j' <= kLargestRoot, by j': (1, 1) at 1.8412 first, then (2, 1) at 3.0542, (0, 1) at 3.8317.
const std::vector<DuctMode>& DuctModes();

}  // namespace piperun::acoustics
