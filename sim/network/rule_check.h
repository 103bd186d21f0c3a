#pragma once

#include <cstdint>
#include <span>

#include "sim/network/hydraulic_state.h"
#include "sim/network/link_law.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// What rules may look at.
struct RuleContext {
  const HydraulicModel& model;
  const HydraulicState& state;
  std::span<const double> tank_volume_m3;
  std::int64_t begin_s = 0;  ///< first second of the interval since the last look
  std::int64_t now_s = 0;
};

/// Do a rule's premises hold? AND and OR are taken from left to right, as EPANET takes them.
bool HoldsRule(const Rule& rule, const RuleContext& context);

/// Looks at all rules and carries out the actions of those that fire, the one of highest priority on each
/// link. True when anything changed.
bool FireRules(const RuleContext& context, const LinkLaws& laws, HydraulicState& state);

}  // namespace piperun::sim
