#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "tests/acoustics/scenes.h"

namespace {
std::atomic<std::int64_t> allocations{0};
}  // namespace

// not inlined: g++ 12 takes an inlined pair of these for a mismatch
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace piperun::acoustics {
namespace {

TEST(Hydrophone, RenderingDoesNotAllocate) {
  AcousticScene scene = MakeQuietScene(MakePvcWave());
  scene.ambient = {};
  scene.network =
      MakeNetwork({{0, 1, 2, MakePvcWave()}, {1, 2, 3, MakeIronWave()}, {2, 3, 400, MakePvcWave()}});
  AddLeak(scene, {2, 5}, MakeJet(1e-5, 1e-3));
  Hydrophone hydrophone({}, scene, RandomStream(1, "hydrophone0", 0));
  // from pipe to pipe, with slip speeds over two decades, so that flow noise is tabulated anew again and
  // again
  const Hydrophone::ListenerAt listener = [](TrueTime t) {
    const double s_m = Seconds(t);
    const PipePlace place = s_m < 2   ? PipePlace{0, s_m}
                            : s_m < 5 ? PipePlace{1, s_m - 2}
                                      : PipePlace{2, s_m - 5};
    return ListenerState{place.pipe, place.s_m, 0.5, 0.005 * std::exp(4.6 * std::abs(std::sin(Seconds(t)))),
                         kPvcBore_m / 2};
  };
  std::vector<std::int32_t> block(1600);
  const std::int64_t before = allocations;
  for (int i = 0; i < 100; ++i) hydrophone.Render(listener, block);
  EXPECT_EQ(allocations - before, 0);
}

TEST(Hydrophone, RenderingKnocksDoesNotAllocate) {
  Hydrophone hydrophone({}, MakeQuietScene(MakePvcWave()), RandomStream(1, "hydrophone0", 0));
  for (int i = 0; i < 200; ++i) hydrophone.Add({TrueTime(std::chrono::milliseconds(7 * i)), 0.02, 0.02});
  const Hydrophone::ListenerAt listener = StillAt(12);
  std::vector<std::int32_t> block(1600);
  const std::int64_t before = allocations;
  for (int i = 0; i < 20; ++i) hydrophone.Render(listener, block);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace piperun::acoustics
