#pragma once

#include <chrono>

#include "scenarios/run.h"
#include "scenarios/run_folder.h"

namespace piperun::scenarios {

using WallTime = std::chrono::steady_clock::time_point;

/// For wall_s, the one use of a clock.
inline WallTime StartWatch() { return std::chrono::steady_clock::now(); }

/// Completes a run folder: hashes its files, writes run.json and gives it its final name.
void Seal(RunFolder& folder, WallTime begin, RunResult& result);

}  // namespace piperun::scenarios
