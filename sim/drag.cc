#include "sim/drag.h"

#include <cmath>
#include <numbers>

namespace piperun::sim {

double CalcDragTimesReynolds(double reynolds) {
  return 24 * (1 + 0.150 * std::pow(reynolds, 0.681)) + 0.407 * reynolds * reynolds / (reynolds + 8710);
}

double CalcDragCoefficient(double reynolds) { return CalcDragTimesReynolds(reynolds) / reynolds; }

double CalcWallFactor(double diameter_ratio, double reynolds) {
  const double k = 0.041 * std::pow(reynolds, 0.524);
  const double l0 = (0.283 + 1.2 * k) / (1 + k);
  const double p =
      reynolds <= 35 ? 1.44 + 0.5466 * std::pow(reynolds, 0.434) : 2.3 + 37.3 * std::pow(reynolds, -0.8686);
  return (1 - std::pow(diameter_ratio, p)) / (1 + std::pow(diameter_ratio / l0, p));
}

double CalcSpinTorqueTimesReynolds(double spin_reynolds) {
  if (spin_reynolds <= 32) return 64 * std::numbers::pi;
  return 12.9 * std::sqrt(spin_reynolds) + 128.4;
}

}  // namespace piperun::sim
