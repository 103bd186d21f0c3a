#pragma once

#include <string>

#include "scenarios/network_report.h"

namespace piperun::tools {

/// Which links the ball asked about passes, and where water takes it.
std::string DescribeBallWays(const sim::HydraulicModel& model, const sim::HydraulicState& state,
                             const scenarios::BallQuestion& question, bool whole);

}  // namespace piperun::tools
