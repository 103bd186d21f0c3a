#pragma once

#include "acoustics/scene.h"
#include "scenarios/pipeline.h"
#include "scenarios/scenario.h"
#include "sim/bore.h"

namespace piperun::scenarios {

/// The pipes as sound sees them, at the hydraulic state of the launch. Reservoirs and tanks are open water. A
/// node of one pipe is a dead end in an EPANET file; in a network drawn pipe by pipe it is one only where no
/// water flows, else the pipe goes on beyond what is drawn. Pumps, check valves and valves that are not wide
/// open pass sound by R = 2 dP / Q at their far end; without flow they are shut. Leaks are open holes.
acoustics::AcousticNetwork MakeAcousticNetwork(const Pipeline& pipeline, const WaterProperties& water,
                                               double gravity_m_s2);

/// Pipes, leaks, background and ball of a scenario; without a pipeline (nullptr) only the last two.
acoustics::AcousticScene MakeAcousticScene(const Scenario& scenario, const WaterProperties& water,
                                           const Pipeline* pipeline, const sim::Bore* bore);

}  // namespace piperun::scenarios
