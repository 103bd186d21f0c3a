#pragma once

#include <string>

#include "base/route.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Ids stand in CSV files and messages: not empty, and without commas, quotes and control characters. Throws
/// InputError.
void RequirePlainId(const std::string& id, const std::string& key_path);

/// The network that the parameters describe. Throws InputError with key paths under "network".
Network MakeNetwork(const NetworkParams& params);

/// The route between two nodes given by id; `group` is where the keys launch and retrieve stand.
Route MakeRoute(const Network& network, const std::string& launch, const std::string& retrieve,
                const std::string& group);

}  // namespace piperun::scenarios
