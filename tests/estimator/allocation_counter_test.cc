#include "tests/estimator/allocation_counter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

namespace {

std::atomic<std::size_t> g_allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace piperun::estimator::testing {

std::size_t AllocationCount() { return g_allocations; }

TEST(AllocationCounter, SeesAnAllocation) {
  const std::size_t before = AllocationCount();
  const std::unique_ptr<int> p(new int(7));
  EXPECT_EQ(AllocationCount(), before + 1) << *p;
}

}  // namespace piperun::estimator::testing
