#pragma once

#include <vector>

#include "sim/network/hydraulic_state.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// Junctions of the parts of a network that have run empty: no open way leads there from a reservoir, a tank
/// or a node that water is fed into (a negative demand), but one leads out: a demand, a leak or an emitter. A
/// part with no way out is no such part: its water stands under whatever pressure was shut in.
std::vector<bool> FindDrained(const HydraulicModel& model, const HydraulicState& state);

/// Takes back the demands of the junctions that are drained, which the equations would serve through closed
/// links. Returns the junctions where there was one; the state then has to be solved again.
std::vector<int> DropDrainedDemands(const std::vector<bool>& drained, HydraulicState& state);

/// Puts zero gauge pressure (head = elevation) and zero flow where water has run out; the equations leave a
/// trickle through closed links there. What is connected to a drained junction carries nothing.
void SettleDrained(const HydraulicModel& model, const std::vector<bool>& drained, HydraulicState& state);

}  // namespace piperun::sim
