#pragma once

#include <string>

#include "base/route.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// The network that the parameters describe. Throws InputError with key paths under "network".
Network MakeNetwork(const NetworkParams& params);

/// The route between two nodes given by id; `group` is where the keys launch and retrieve stand.
Route MakeRoute(const Network& network, const std::string& launch, const std::string& retrieve,
                const std::string& group);

}  // namespace piperun::scenarios
