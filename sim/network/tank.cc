#include "sim/network/tank.h"

#include <numbers>

#include "sim/network/head_loss.h"

namespace piperun::sim {
namespace {

double Area_m2(const TankNode& tank) { return std::numbers::pi * tank.diameter_m * tank.diameter_m / 4; }

Curve SwapAxes(const Curve& curve) {
  Curve swapped;
  for (const CurvePoint& point : curve) swapped.push_back({point.y, point.x});
  return swapped;
}

}  // namespace

double MinTankVolume_m3(const TankNode& tank) {
  if (!tank.volume_curve.empty()) return InterpolateCurve(tank.volume_curve, tank.min_level_m);
  return tank.min_volume_m3 > 0 ? tank.min_volume_m3 : Area_m2(tank) * tank.min_level_m;
}

double MaxTankVolume_m3(const TankNode& tank) { return CalcTankVolume_m3(tank, tank.max_level_m); }

double CalcTankVolume_m3(const TankNode& tank, double level_m) {
  if (!tank.volume_curve.empty()) return InterpolateCurve(tank.volume_curve, level_m);
  return MinTankVolume_m3(tank) + Area_m2(tank) * (level_m - tank.min_level_m);
}

double CalcTankLevel_m(const TankNode& tank, double volume_m3) {
  if (!tank.volume_curve.empty()) return InterpolateCurve(SwapAxes(tank.volume_curve), volume_m3);
  return tank.min_level_m + (volume_m3 - MinTankVolume_m3(tank)) / Area_m2(tank);
}

}  // namespace piperun::sim
