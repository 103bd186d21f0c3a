#pragma once

#include <string>

#include "base/network.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Ids stand in CSV files and messages: not empty, and without commas, quotes and control characters. Throws
/// InputError.
void RequirePlainId(const std::string& id, const std::string& key_path);

/// The network that the parameters describe. Throws InputError with key paths under "network".
Network MakeNetwork(const NetworkParams& params);

/// A node by its id; throws InputError for `key_path`, naming the nearest known id.
int ResolveNode(const Network& network, const std::string& id, const std::string& key_path);

}  // namespace piperun::scenarios
