#pragma once

#include <vector>

#include "base/leak.h"
#include "base/route.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// The leaks that a scenario lists. Throws InputError ("leaks[i]...") for ids used twice, pipes that do not
/// exist, places beyond a pipe's ends and holes wider than the bore.
std::vector<Leak> MakeListedLeaks(const Scenario& scenario, const Network& network);

/// The leaks that a scenario draws by seed and run: uniform over the length of the planned way (or of all
/// passable pipes), diameters log-uniform; ids R1, R2 and so on in the order drawn. Places closer to another
/// leak or to an end of the pipe than the least spacing are drawn again. Throws InputError when there is no
/// room.
std::vector<Leak> DrawLeaks(const Scenario& scenario, const Network& network,
                            const std::vector<RouteLeg>& plan, const std::vector<Leak>& listed);

}  // namespace piperun::scenarios
