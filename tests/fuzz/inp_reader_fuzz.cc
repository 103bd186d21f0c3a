// Whatever the bytes are, the reader gives a model or an InputError, and a small model can be solved.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/check.h"
#include "sim/network/inp_reader.h"
#include "sim/network/simulation.h"

namespace {

constexpr int kMostNodes = 200;
constexpr int kMostInstants = 5;

void SolveSome(piperun::sim::HydraulicModel model) {
  model.options.max_trials = 20;
  model.options.extra_trials = 0;
  piperun::sim::HydraulicSimulation simulation(model);
  for (int i = 0; i < kMostInstants; ++i) {
    simulation.Solve();
    if (!simulation.Advance()) return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    auto model = piperun::sim::ReadInp({reinterpret_cast<const char*>(data), size}, "fuzz.inp");
    if (model.node_count() <= kMostNodes) SolveSome(std::move(model));
  } catch (const piperun::InputError&) {  // what a reader is for
  }
  return 0;
}
