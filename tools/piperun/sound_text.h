#pragma once

#include <string>

#include "scenarios/scenario.h"

namespace piperun::tools {

/// How the pipes of a scenario carry sound: speed, loss, ring frequency and first cut-on of each. Tables
/// longer than a screen are cut and say so, unless `whole`.
std::string DescribeSound(const scenarios::Scenario& scenario, bool whole);

/// The same as CSV, all pipes.
std::string WriteSoundCsv(const scenarios::Scenario& scenario);

}  // namespace piperun::tools
