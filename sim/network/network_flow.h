#pragma once

#include <span>
#include <vector>

#include "base/leak.h"
#include "base/network.h"
#include "base/water.h"
#include "sim/flow_timeline.h"
#include "sim/network/pipe_leak.h"
#include "sim/network/simulation.h"

namespace piperun::sim {

/// The instants of an extended period as a timeline whose zero is `launch_s` of the period.
///
/// Pipe i of `network` is link i of the model the leaks were put into: pipes, pumps, valves in order. Pipes
/// are cut at their leaks; pumps and valves are one reach. Heads are those of the nodes; in closed links and
/// at nodes without supply they mean nothing. Friction factors follow from flow, bore and roughness of the
/// network's pipes by CalcFrictionFactor, whatever head loss law the model has: they tell the shear at the
/// ball, not the fall of the heads. Bores are the network's, too; where they differ from the model's, flows
/// are right and velocities are the network's.
///
/// Throws InputError: no instant, instants that end before the launch ("flow.launch_time_s"), a roughness
/// above 0.05 bores ("network.pipes").
FlowTimeline MakeFlowTimeline(const LeakyModel& leaky, std::span<const HydraulicStep> steps,
                              std::int64_t launch_s, const Network& network, const WaterProperties& water);

/// Flow and pressure of each leak `t` after the launch, in the order of LeakyModel::leaks: linear between
/// instants like the timeline.
std::vector<LeakState> CalcLeakStates(const LeakyModel& leaky, std::span<const HydraulicStep> steps,
                                      std::int64_t launch_s, TrueTime t, const WaterProperties& water,
                                      double gravity_m_s2);

}  // namespace piperun::sim
