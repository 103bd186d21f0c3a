#pragma once

#include <algorithm>
#include <cstdint>

#include "sim/truth.h"

namespace piperun::sim {

/// Calls visit(a, b, from, to, n) for every step n, from state a to state b, of which the part from `from` to
/// `to` lies inside (begin, end].
template <class Visit>
void ForEachStep(const TruthWindow& window, TrueTime begin, TrueTime end, const Visit& visit) {
  bool done = false;
  for (std::int64_t n = window.StepAt(begin) + 1; !done; ++n) {
    const TruthState& a = window.at(n - 1);
    const TruthState& b = window.at(n);
    const double step_s = Seconds(b.time - a.time);
    const double from = std::max(0.0, Seconds(begin - a.time) / step_s);
    const double to = std::min(1.0, Seconds(end - a.time) / step_s);
    visit(a, b, from, to, n);
    done = b.time >= end;
  }
}

}  // namespace piperun::sim
