#pragma once

#include "base/route.h"

namespace piperun::sim {

/// Where a point in space lies along a route.
struct RouteSpot {
  std::size_t piece = 0;
  double chainage_m = 0;
  CentrelinePoint axis;  ///< the nearest point of the pipe's axis
};

/// The spot of `p_W`, looked for from piece `hint` along the route and nowhere else: a route may cross itself
/// or close on itself. Before its first and beyond its last piece a route goes on as they do.
RouteSpot FindRouteSpot(const Route& route, const Vector3d& p_W, std::size_t hint);

}  // namespace piperun::sim
