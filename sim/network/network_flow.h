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

/// The water of a network from the launch of a ball on.
struct NetworkFlow {
  FlowTimeline timeline;
  std::vector<LeakState> leaks;  ///< at the launch, in the order of LeakyModel::leaks
};

/// Hydraulic states as flow along the pipes of `network`, whose pipe i is link i of the model before leaks
/// were inserted: pipes, pumps, valves. Time zero is `launch_s` of the model's period, between two instants
/// linear. Pipes are cut into reaches where leaks are; friction factors follow from water and bore
/// (sim/pipe_flow.h), whatever head-loss law the model has. At least one step, at or before the launch.
NetworkFlow MakeNetworkFlow(const Network& network, const LeakyModel& leaky,
                            std::span<const HydraulicStep> steps, double launch_s,
                            const WaterProperties& water, double gravity_m_s2);

}  // namespace piperun::sim
