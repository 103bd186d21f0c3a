#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sim/network_spot.h"

namespace piperun::testing {

/// A pipe out of a common node at the origin.
struct Ray {
  Vector3d direction;
  double diameter_m = 1;
  double length_m = 20;
};

/// Pipes 0, 1, .. from node 0 outwards.
inline Network MakeStar(const std::vector<Ray>& rays) {
  std::vector<NodeSpec> nodes{{"N", Vector3d::Zero()}};
  std::vector<PipeSpec> pipes;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    nodes.push_back({"E" + std::to_string(i), rays[i].length_m * rays[i].direction.normalized()});
    PipeSpec pipe;
    pipe.id = "P" + std::to_string(i);
    pipe.from = "N";
    pipe.to = nodes.back().id;
    pipe.diameter_m = rays[i].diameter_m;
    pipe.wall_thickness_m = 0.01;
    pipe.material.roughness_m = 1e-4;
    pipes.push_back(pipe);
  }
  return Network(std::move(nodes), pipes);
}

/// The spot of a point that lies in a given pipe.
inline sim::NetworkSpot SpotIn(const Network& network, int pipe, const Vector3d& p_L) {
  const auto& pieces = network.pipe(pipe).centreline;
  sim::NetworkSpot spot{pipe, 0, 0, {}};
  double nearest = 1e300;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double s_m = std::clamp(FindNearest(pieces[i], p_L), pieces[i].s_begin_m, pieces[i].s_end_m());
    const CentrelinePoint axis = EvalCentreline(pieces[i], s_m);
    if ((axis.p_W - p_L).norm() >= nearest) continue;
    nearest = (axis.p_W - p_L).norm();
    spot = {pipe, i, s_m, axis};
  }
  return spot;
}

}  // namespace piperun::testing
