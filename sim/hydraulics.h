#pragma once

#include <span>
#include <vector>

#include "base/leak.h"
#include "base/network.h"
#include "base/route.h"
#include "base/water.h"
#include "sim/flow_timeline.h"

namespace piperun::sim {

/// What is given at the first node of a route.
struct InletCondition {
  double flow_m3_s = 0;
  double pressure_Pa = 0;  ///< gauge, on the axis
};

struct SteadyFlow {
  FlowTimeline timeline;
  std::vector<LeakState> leaks;  ///< one per leak, in the order given
};

/// Steady flow along a route in series: head falls by Darcy-Weisbach friction, each leak takes its orifice
/// flow Q = Cd A sqrt(2 dp / rho). Throws InputError (keys "flow...", "leaks[i]...") when a leak takes more
/// than flows, pressure at a leak is not positive, or the water column would part. Pipes beside the route
/// hold still water under the head of the node they hang on (not a number where no water connects). Losses of
/// bends and fittings are left out.
SteadyFlow SolveSteadyFlow(const Network& network, const Route& route, const InletCondition& inlet,
                           std::span<const Leak> leaks, const WaterProperties& water, double gravity_m_s2);

}  // namespace piperun::sim
