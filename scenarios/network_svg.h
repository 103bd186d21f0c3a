#pragma once

#include <string>
#include <vector>

#include "base/leak.h"
#include "base/route.h"
#include "sim/flow_timeline.h"

namespace piperun::scenarios {

/// What a drawing of a network shows besides its pipes.
struct NetworkSvgContent {
  std::string title;
  std::vector<RouteLeg> way;  ///< drawn as a band under its pipes
  std::vector<Leak> leaks;
};

/// A network in plan, as SVG: pipes as wide as their bores (not to scale), coloured by the speed of the water
/// at the time given, with an arrow the way it flows; reservoirs and tanks as squares; what nothing solid
/// passes dashed. Ids are written while there are few.
std::string DrawNetworkSvg(const Network& network, const sim::FlowTimeline& flow, TrueTime t,
                           const NetworkSvgContent& content);

}  // namespace piperun::scenarios
