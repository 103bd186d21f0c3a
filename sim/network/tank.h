#pragma once

#include "sim/network/model.h"

namespace piperun::sim {

/// Volume of water at a level, and back: V = V_min + A (level - level_min) of a cylinder, else by the curve.
double CalcTankVolume_m3(const TankNode& tank, double level_m);
double CalcTankLevel_m(const TankNode& tank, double volume_m3);
double MinTankVolume_m3(const TankNode& tank);
double MaxTankVolume_m3(const TankNode& tank);

}  // namespace piperun::sim
