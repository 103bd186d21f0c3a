#pragma once

#include <optional>
#include <vector>

#include "sim/network_spot.h"

namespace piperun::sim {

/// One pipe of the way a ball has taken.
struct WayLeg {
  int pipe = 0;
  bool reversed = false;  ///< entered at its `to` end
  double chainage_begin_m = 0;
  Vector3d offset_W = Vector3d::Zero();  ///< p_W = p in the pipe's drawing + offset
};

/// The way a ball has really taken through a network, and its chainage: the distance along the axes of the
/// pipes from the node of the launch. At a joint of several pipes the axis turns at the node, so a ball that
/// cuts the corner from one pipe into another gains or loses up to about a diameter of chainage at the
/// change. A pipe entered and left again by the same end is not part of the way.
class Way {
 public:
  /// Keeps a reference. The ball starts in the pipe of `launch`, whose end is where chainage counts from.
  Way(const Network& network, PipeEnd launch);

  void Cross(const SpotMove::Crossing& crossing);

  const std::vector<WayLeg>& legs() const { return legs_; }
  const WayLeg& leg() const { return legs_.back(); }
  double Chainage_m(double s_m) const { return CalcChainage_m(legs_.back(), s_m); }
  /// The first leg in a pipe, or null.
  const WayLeg* FindLeg(int pipe) const;
  double CalcChainage_m(const WayLeg& leg, double s_m) const {
    return leg.chainage_begin_m + (leg.reversed ? network_.pipe(leg.pipe).length_m - s_m : s_m);
  }

 private:
  const Network& network_;
  std::vector<WayLeg> legs_;
};

}  // namespace piperun::sim
