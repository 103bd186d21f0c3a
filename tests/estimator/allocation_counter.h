#pragma once

#include <cstddef>

namespace piperun::estimator::testing {

/// How often this program has called operator new.
std::size_t AllocationCount();

}  // namespace piperun::estimator::testing
