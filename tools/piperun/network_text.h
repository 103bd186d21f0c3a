#pragma once

#include <string>

#include "scenarios/network_report.h"

namespace piperun::tools {

/// What a person reads about a network: its size, how good the solution is, its nodes and links, and over a
/// period one line per instant. Tables longer than a screen are cut and say so, unless `whole`.
std::string DescribeNetwork(const sim::HydraulicModel& model, const scenarios::NetworkSolution& solution,
                            bool whole);

}  // namespace piperun::tools
