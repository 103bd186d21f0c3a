#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/pipe_wave.h"

namespace piperun::acoustics {

/// Index of the leg that holds `chainage_m`; the first and the last leg go on beyond the route's ends.
std::size_t FindLeg(const std::vector<AcousticLeg>& legs, double chainage_m);

/// Length in metres of the part of leg `i` that lies between two chainages, in either order. The parts of
/// all legs add up to the distance.
double CalcPathInLeg(const std::vector<AcousticLeg>& legs, std::size_t i, double from_m, double to_m);

/// Loss of the plane wave on its way between two chainages: the integral of alpha(f) in Np. The pressure
/// falls to exp(-loss), the power to exp(-2 loss). The wave runs both ways alike and passes from leg to leg
/// as if their impedances matched: transmission, reflections, branches and the near field within a diameter
/// of the hole belong to a field of the whole network and are not in it.
double CalcPathLoss_Np(const std::vector<AcousticLeg>& legs, double from_m, double to_m, double f_Hz);

}  // namespace piperun::acoustics
