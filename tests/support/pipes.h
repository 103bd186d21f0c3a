#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/route.h"
#include "sim/network_spot.h"

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

inline PipeSpec MakePipeSpec(const std::string& id, const std::string& from, const std::string& to,
                             const PipeShape& shape = {}, const std::vector<Vector3d>& vertices = {}) {
  PipeSpec pipe;
  pipe.id = id;
  pipe.from = from;
  pipe.to = to;
  pipe.diameter_m = shape.diameter_m;
  pipe.wall_thickness_m = 0.007;
  pipe.bend_radius_m = shape.bend_radius_m;
  pipe.vertices_m = vertices;
  pipe.material = {"test", 3.5e9, 0.05, 0.4, 1400, shape.roughness_m};
  return pipe;
}

inline Network MakeLineNetwork(const std::vector<Vector3d>& points, const PipeShape& shape = {}) {
  return Network({{"A", points.front()}, {"B", points.back()}},
                 {MakePipeSpec("P", "A", "B", shape, {points.begin() + 1, points.end() - 1})});
}

inline PipeLine MakePipeLine(const std::vector<Vector3d>& points, const PipeShape& shape = {}) {
  Network network = MakeLineNetwork(points, shape);
  Route route = FindRoute(network, 0, 1);
  return {std::move(network), std::move(route)};
}

/// A network and its bores, which refer to it: it stays where it is made.
struct BoreNetwork {
  explicit BoreNetwork(Network made) : network(std::move(made)), bore(network) {}
  BoreNetwork(const BoreNetwork&) = delete;
  BoreNetwork& operator=(const BoreNetwork&) = delete;

  Network network;
  sim::Bore bore;
};

inline BoreNetwork MakeBoreLine(const std::vector<Vector3d>& points, const PipeShape& shape = {}) {
  return BoreNetwork(MakeLineNetwork(points, shape));
}

/// An arm of a star: its far end, from the hub, and its bore.
struct StarArm {
  Vector3d to_m;
  double radius_m = 0.075;
  bool passable = true;
};

/// Straight pipes from a hub "H" to as many ends.
inline Network MakeStar(const Vector3d& hub_m, const std::vector<StarArm>& arms) {
  std::vector<NodeSpec> nodes{{"H", hub_m}};
  std::vector<PipeSpec> pipes;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const std::string id = std::to_string(i);
    nodes.push_back({"N" + id, hub_m + arms[i].to_m});
    const PipeShape shape{.diameter_m = 2 * arms[i].radius_m, .bend_radius_m = 0};  // corners stay sharp
    pipes.push_back(MakePipeSpec("P" + id, "H", nodes.back().id, shape));
    pipes.back().passable = arms[i].passable;
  }
  return Network(std::move(nodes), pipes);
}

/// The spot in `pipe` of a point in its drawing, looked for along all of it.
inline sim::NetworkSpot FindSpot(const Network& network, int pipe, const Vector3d& p_L) {
  sim::NetworkSpot best;
  double best_m = 1e9;
  const auto& pieces = network.pipe(pipe).centreline;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double s_m = FindNearest(pieces[i], p_L);
    const double on_m = std::clamp(s_m, pieces[i].s_begin_m, pieces[i].s_end_m());
    const double distance_m = (EvalCentreline(pieces[i], on_m).p_W - p_L).norm();
    if (distance_m >= best_m - 1e-12) continue;
    best_m = distance_m;
    best = {pipe, i, s_m, EvalCentreline(pieces[i], s_m)};
  }
  return best;
}

}  // namespace piperun::testing
