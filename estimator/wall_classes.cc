#include "estimator/wall_classes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/pipe_loss.h"

namespace piperun::estimator {
namespace {

constexpr double kWidest = 1.5;
constexpr double kBeyond = std::numeric_limits<double>::infinity();

struct Wall {
  double slope_dB_m = 0;
  Stretch stretch;
};

std::vector<Wall> ListWalls(const RouteMap& map, double f_Hz) {
  std::vector<Wall> walls;
  for (const RoutePiece& piece : map.route.pieces()) {
    const double slope_dB_m = CalcAttenuation_dB_m(map.network.pipe(piece.pipe), f_Hz);
    walls.push_back({slope_dB_m, {piece.line.s_begin_m, piece.line.s_end_m()}});
  }
  walls.front().stretch.from_m = -kBeyond;
  walls.back().stretch.to_m = kBeyond;
  std::erase_if(walls, [](const Wall& wall) { return !(wall.slope_dB_m > 0); });
  return walls;
}

void AddStretch(const Stretch& stretch, std::vector<Stretch>& stretches) {
  if (!stretches.empty() && stretches.back().to_m == stretch.from_m) {
    stretches.back().to_m = stretch.to_m;
  } else {
    stretches.push_back(stretch);
  }
}

/// Of walls with least <= slope < kWidest least.
WallClass MakeClass(const std::vector<Wall>& walls, double least_dB_m) {
  WallClass wall_class;
  double most_dB_m = least_dB_m;
  for (const Wall& wall : walls) {
    if (wall.slope_dB_m < least_dB_m || wall.slope_dB_m >= kWidest * least_dB_m) continue;
    most_dB_m = std::max(most_dB_m, wall.slope_dB_m);
    AddStretch(wall.stretch, wall_class.stretches);
  }
  wall_class.slope_dB_m = std::sqrt(least_dB_m * most_dB_m);
  return wall_class;
}

}  // namespace

bool WallClass::Holds(double chainage_m, double margin_m) const {
  return std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& s) {
    return s.from_m - margin_m <= chainage_m && chainage_m < s.to_m + margin_m;
  });
}

std::vector<WallClass> ClassifyWalls(const RouteMap& map, double f_Hz) {
  const std::vector<Wall> walls = ListWalls(map, f_Hz);
  std::vector<double> slopes_dB_m;
  for (const Wall& wall : walls) slopes_dB_m.push_back(wall.slope_dB_m);
  std::sort(slopes_dB_m.begin(), slopes_dB_m.end());
  std::vector<WallClass> classes;
  double least_dB_m = 0;
  for (const double slope_dB_m : slopes_dB_m) {
    if (slope_dB_m < kWidest * least_dB_m) continue;
    least_dB_m = slope_dB_m;
    classes.push_back(MakeClass(walls, least_dB_m));
  }
  return classes;
}

}  // namespace piperun::estimator
