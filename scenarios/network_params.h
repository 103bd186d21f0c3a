#pragma once

#include <string>
#include <vector>

#include "base/network.h"
#include "estimator/fitting.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Ids stand in CSV files and messages: not empty, and without commas, quotes and control characters. Throws
/// InputError.
void RequirePlainId(const std::string& id, const std::string& key_path);

/// The network that the parameters describe. Throws InputError with key paths under "network".
Network MakeNetwork(const NetworkParams& params);

/// By its name; a name that was checked when it was read.
estimator::FittingKind FittingKindOf(const std::string& name);

/// The fittings that the parameters list, on that network. Throws InputError with key paths under
/// "network.fittings" for an unknown pipe and a place beyond its end.
std::vector<estimator::Fitting> MakeFittings(const NetworkParams& params, const Network& network);

/// A node by its id; throws InputError for `key_path`, naming the nearest known id.
int ResolveNode(const Network& network, const std::string& id, const std::string& key_path);

}  // namespace piperun::scenarios
