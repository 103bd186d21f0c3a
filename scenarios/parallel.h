#pragma once

#include <atomic>
#include <functional>

namespace piperun::scenarios {

/// Calls `work(i)` for i in [0, count) on `jobs` threads (0: as many as there are cores), each index once, in
/// any order: results belong into a place of their index. `progress` hears the fraction done, on the calling
/// thread. The first exception of a worker is thrown on when all have stopped; Interrupted when `stop` is
/// set.
void RunParallel(int count, int jobs, const std::atomic<bool>* stop, const std::function<void(int)>& work,
                 const std::function<void(double)>& progress);

}  // namespace piperun::scenarios
