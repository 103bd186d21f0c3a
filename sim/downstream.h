#pragma once

#include <optional>
#include <vector>

#include "base/route.h"
#include "sim/bore.h"
#include "sim/flow_timeline.h"

namespace piperun::sim {

/// Where the water leads at one instant, through pipes that are open. Water slower than kStillWater_m_s leads
/// nowhere.
class Downstream {
 public:
  static constexpr double kStillWater_m_s = 1e-4;

  Downstream(const Bore& bore, const FlowTimeline& flow, TrueTime t);

  /// True when water comes from a pipe to `node` (with node < 0: when it flows in the pipe at all).
  bool LeadsOn(int pipe, int node) const;
  /// True when water leaves a joint through one of its arms.
  bool LeadsAway(const Joint& joint) const;
  /// True when water leaves a joint through an arm with a bore below the radius.
  bool LeadsIntoNarrower(const Joint& joint, double radius_m) const;

  /// The fastest way along the water from node to node through passable pipes with bores of at least the
  /// given radius; nothing when there is none.
  std::optional<std::vector<RouteLeg>> FindFastestWay(int from, int to, double min_radius_m) const;
  /// Down the pipe with the greatest flow at every node, to where water leads no further, no pipe is passable
  /// and wide enough, or the way closes on itself.
  std::vector<RouteLeg> FollowMainFlow(int from, double min_radius_m) const;

 private:
  /// Speed from the node into the pipe at this end; <= 0: water does not lead there.
  double SpeedInto_m_s(PipeEnd end) const;
  bool IsWay(PipeEnd end, double min_radius_m) const;

  const Bore& bore_;
  const Network& network_;
  std::vector<double> speed_m_s_;  // per pipe, at its middle
};

}  // namespace piperun::sim
