#include "sim/rolling_drag.h"

#include <algorithm>
#include <numbers>

namespace piperun::sim {

double CalcRollingDragTimesReynolds(const Reynolds& reynolds) {
  constexpr double kCreeping = 322.1069;  // the cubic's own value at Re = 10
  constexpr double kDeveloped = 0.74;
  if (reynolds.value <= 10) return kCreeping;
  if (reynolds.value >= 2e4) return kDeveloped * reynolds.value;
  const double x = std::numbers::log10e * reynolds.log;
  const double log_drag = 3.02 + x * (-1.89 + x * (0.411 - x * 0.033));
  return std::max(kDeveloped, std::exp(log_drag / std::numbers::log10e)) * reynolds.value;
}

double CalcContactDragTimesReynolds(const Reynolds& reynolds, double free_drag_times_reynolds,
                                    double spin_factor) {
  const double spin = spin_factor / (2 * std::numbers::pi) * CalcSpinTorqueTimesReynolds(2 * reynolds.value);
  return std::max(0.0, CalcRollingDragTimesReynolds(reynolds) - spin - free_drag_times_reynolds);
}

double CalcWallNearness(double gap_m, double radius_m) {
  const double x = radius_m / (radius_m + gap_m);
  return x * x * x;
}

}  // namespace piperun::sim
