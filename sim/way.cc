#include "sim/way.h"

#include <algorithm>

#include "base/check.h"

namespace piperun::sim {
namespace {

PipeEnd EntryOf(const WayLeg& leg) { return {leg.pipe, leg.reversed}; }
PipeEnd ExitOf(const WayLeg& leg) { return {leg.pipe, !leg.reversed}; }

}  // namespace

Way::Way(const Network& network, PipeEnd launch) : network_(network) {
  legs_.reserve(64);
  legs_.push_back({launch.pipe, launch.at_to, 0, Vector3d::Zero()});
}

void Way::Cross(const SpotMove::Crossing& crossing) {
  const WayLeg from = legs_.back();
  Demand(from.pipe == crossing.left.pipe, "a ball leaves the pipe it is in");
  WayLeg next{crossing.entered.pipe, crossing.entered.at_to, from.chainage_begin_m,
              from.offset_W - crossing.shift_L};
  if (crossing.left == EntryOf(from)) {
    legs_.pop_back();
    if (!legs_.empty() && ExitOf(legs_.back()) == crossing.entered) return;  // back where it came from
  } else {
    next.chainage_begin_m += network_.pipe(from.pipe).length_m;
  }
  legs_.push_back(next);
}

const WayLeg* Way::FindLeg(int pipe) const {
  const auto found =
      std::find_if(legs_.begin(), legs_.end(), [&](const WayLeg& leg) { return leg.pipe == pipe; });
  return found == legs_.end() ? nullptr : &*found;
}

}  // namespace piperun::sim
