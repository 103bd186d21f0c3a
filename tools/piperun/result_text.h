#pragma once

#include <string>

#include "scenarios/run.h"

namespace piperun::tools {

/// What a user wants to read of a run: the leaks as they are and as each filter puts them, and the tracks.
std::string DescribeResult(const scenarios::RunResult& result);

}  // namespace piperun::tools
