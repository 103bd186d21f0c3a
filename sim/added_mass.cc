#include "sim/added_mass.h"

#include <algorithm>

#include "base/check.h"
#include "sim/ball.h"

namespace piperun::sim {

double CalcAddedMassCoefficient(double diameter_ratio) {
  Demand(diameter_ratio > 0 && diameter_ratio <= kMaxDiameterRatio, "d/D lies in (0, 0.95]");
  constexpr double kTouchingAPlane = 0.621;
  const double l = diameter_ratio, l3 = l * l * l, l10 = l3 * l3 * l3 * l;
  const double on_axis = 3 / (2 - 1.59365 * l3 - 0.1225 * l10 - 0.113 * l10 * l10) - 1;
  return std::max(kTouchingAPlane, on_axis);
}

}  // namespace piperun::sim
