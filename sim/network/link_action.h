#pragma once

#include "sim/network/hydraulic_state.h"
#include "sim/network/link_law.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// Carries out a simple control: a status fixes a valve (no setting any more) and runs or stops a pump; a
/// setting lets a valve control again. True when anything changed.
bool ApplyControl(const LinkAction& action, const HydraulicModel& model, const LinkLaws& laws,
                  HydraulicState& state);

/// Is the link already as the action wants it?
bool IsInEffect(const LinkAction& action, const HydraulicModel& model, const HydraulicState& state);

/// The same while heads are still being sought: a pump or valve already at the setting is left as it is.
bool ApplyPressureControl(const LinkAction& action, const HydraulicModel& model, HydraulicState& state);

/// Carries out an action of a rule. True when anything changed.
bool ApplyRule(const LinkAction& action, const HydraulicModel& model, const LinkLaws& laws,
               HydraulicState& state);

/// Sets a pump's speed or a valve's setting, with the status that follows from it.
void ApplySetting(int link, double setting, const HydraulicModel& model, const LinkLaws& laws,
                  HydraulicState& state);

}  // namespace piperun::sim
