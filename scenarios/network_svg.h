#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/leak.h"
#include "base/route.h"
#include "sim/flow_timeline.h"
#include "sim/network/hydraulic_state.h"

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

/// The same for a solved EPANET model at one instant, drawn as scenarios draw it; with `from` and `to`, the
/// fastest way along the water between these nodes for a ball of the given diameter (0: the water itself).
/// Throws InputError when the file has no coordinates.
std::string DrawModelSvg(const sim::HydraulicModel& model, const sim::HydraulicState& state,
                         std::optional<int> from, std::optional<int> to, double ball_diameter_m);

}  // namespace piperun::scenarios
