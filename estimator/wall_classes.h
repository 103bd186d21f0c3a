#pragma once

#include <vector>

#include "estimator/estimator.h"

namespace piperun::estimator {

/// A part of a way, from one chainage to another.
struct Stretch {
  double from_m = 0, to_m = 0;
};

/// Pipes of a route whose walls take nearly as much of a sound per metre.
struct WallClass {
  double slope_dB_m = 0;           ///< geometric middle of the least and the most of them
  std::vector<Stretch> stretches;  ///< where the route runs through them, in order

  bool Holds(double chainage_m, double margin_m = 0) const;
};

/// The walls of a route by their loss at f_Hz (CalcAttenuation_dB_m), sorted into classes within which the
/// most is less than 1.5 times the least; stretches that follow one another are joined. The first begins and
/// the last ends beyond the route: a track may run past it. Pipes without loss are left out.
std::vector<WallClass> ClassifyWalls(const RouteMap& map, double f_Hz);

}  // namespace piperun::estimator
