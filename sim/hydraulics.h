#pragma once

#include <span>
#include <string>
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

/// Head that is lost to something else than friction along straight pipe.
struct LocalLosses {
  /// K per pipe of the network, h = K U^2/(2 g), spread evenly along the pipe; empty: none.
  std::vector<double> pipe_coefficients{};
  bool bends = false;  ///< sim/bend_loss.h, spread evenly along each bend
};

struct SteadyFlow {
  FlowTimeline timeline;
  std::vector<LeakState> leaks;         ///< one per leak, in the order given
  std::vector<std::string> warnings{};  ///< laws used beyond their range, a sentence each
};

/// Steady flow along a route in series: head falls by Darcy-Weisbach friction, each leak takes its orifice
/// flow Q = Cd A sqrt(2 dp / rho). Local losses lower the head besides; a bend is a reach of its own, along
/// which its loss is spread. Throws InputError (keys "flow...", "leaks[i]...") when a leak takes more
/// than flows, pressure at a leak is not positive, or the water column would part. Pipes beside the route
/// hold still water under the head of the node they hang on (not a number where no water connects).
SteadyFlow SolveSteadyFlow(const Network& network, const Route& route, const InletCondition& inlet,
                           std::span<const Leak> leaks, const WaterProperties& water, double gravity_m_s2,
                           const LocalLosses& losses = {});

}  // namespace piperun::sim
