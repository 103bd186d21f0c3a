#pragma once

#include <optional>

#include "sim/bore.h"

namespace piperun::sim {

/// Where a point lies in a network: in which pipe, and next to which point of its axis.
struct NetworkSpot {
  int pipe = 0;
  std::size_t piece = 0;  ///< of the pipe's centreline
  double s_m = 0;         ///< along the pipe; beyond its ends at dead ends only
  CentrelinePoint axis;   ///< in the pipe's own drawing L
};

/// The spot of a point, and by which ends it came into another pipe.
struct SpotMove {
  NetworkSpot spot;
  /// Crossed: p in the new pipe's drawing = p in the old one's + shift. Empty: same pipe.
  struct Crossing {
    PipeEnd left;
    PipeEnd entered;
    Vector3d shift_L;
  };
  std::optional<Crossing> crossing;
};

/// The spot of `p_L` (in the drawing of `hint.pipe`), looked for from `hint` on and nowhere else: a network
/// may cross itself in the drawing. At a joint the point stays with its pipe while it is before the node and
/// inside the bore; beyond, it belongs to the arm in whose bore it lies deepest (offset over radius), among
/// those it has entered.
SpotMove FindNetworkSpot(const Bore& bore, const Vector3d& p_L, const NetworkSpot& hint);

}  // namespace piperun::sim
