#pragma once

#include <utility>
#include <vector>

#include "base/route.h"

namespace piperun::testing {

/// One pipe from A through `vertices` to B, and the route through it.
struct PipeLine {
  Network network;
  Route route;
};

struct PipeShape {
  double diameter_m = 0.15;
  double bend_radius_m = 0.3;
  double roughness_m = 0;
};

inline PipeLine MakePipeLine(const std::vector<Vector3d>& points, const PipeShape& shape = {}) {
  PipeSpec pipe;
  pipe.id = "P";
  pipe.from = "A";
  pipe.to = "B";
  pipe.diameter_m = shape.diameter_m;
  pipe.wall_thickness_m = 0.007;
  pipe.bend_radius_m = shape.bend_radius_m;
  pipe.vertices_m.assign(points.begin() + 1, points.end() - 1);
  pipe.material = {"test", 3.5e9, 0.05, 0.4, 1400, shape.roughness_m};
  Network network({{"A", points.front()}, {"B", points.back()}}, {pipe});
  Route route = FindRoute(network, 0, 1);
  return {std::move(network), std::move(route)};
}

}  // namespace piperun::testing
