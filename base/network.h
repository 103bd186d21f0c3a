#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/centreline.h"

namespace piperun {

/// What a pipe's wall is made of, as far as water, ball and sound notice.
struct WallMaterial {
  std::string name;
  double young_modulus_Pa = 0;
  double loss_factor = 0;  ///< effective: wall, lining, joints, deposits
  double poisson_ratio = 0;
  double density_kg_m3 = 0;
  double roughness_m = 0;  ///< equivalent sand-grain roughness of the bore
};

struct NodeSpec {
  std::string id;
  Vector3d position_m = Vector3d::Zero();  ///< W frame: x east, y north, z up (elevation)
};

/// A pipe from node to node as a user describes it: the polyline from -> vertices -> to, corners rounded.
struct PipeSpec {
  std::string id;
  std::string from;
  std::string to;
  double diameter_m = 0;  ///< bore
  double wall_thickness_m = 0;
  double bend_radius_m = 0;  ///< of the centreline, at every vertex; not read when there is none
  std::vector<Vector3d> vertices_m;
  WallMaterial material;
};

struct Pipe {
  std::string id;
  int from = 0;  ///< node indices
  int to = 0;
  double diameter_m = 0;
  double wall_thickness_m = 0;
  WallMaterial material;
  std::vector<CentrelinePiece> centreline;  ///< s = 0 at `from`
  double length_m = 0;

  double radius_m() const { return 0.5 * diameter_m; }
  double area_m2() const;
};

/// An immutable pipe network: nodes, and pipes made of straight lines and circular bends.
class Network {
 public:
  /// Throws InputError with the key path ("network.pipes[2].diameter_m") of what is wrong: an id that is
  /// empty, used twice or unknown; a size that is not a finite number > 0; a coordinate that is not finite; a
  /// bend tighter than the bore; a bend that does not fit; no pipe at all.
  Network(std::vector<NodeSpec> nodes, const std::vector<PipeSpec>& pipes);

  const std::vector<NodeSpec>& nodes() const { return nodes_; }
  const std::vector<Pipe>& pipes() const { return pipes_; }
  const Pipe& pipe(int i) const { return pipes_[static_cast<std::size_t>(i)]; }
  std::optional<int> FindNode(std::string_view id) const;
  std::optional<int> FindPipe(std::string_view id) const;
  /// Pipes that begin or end at a node.
  std::vector<int> PipesAt(int node) const;

 private:
  std::vector<NodeSpec> nodes_;
  std::vector<Pipe> pipes_;
};

}  // namespace piperun
