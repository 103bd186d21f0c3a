#pragma once

#include <functional>
#include <map>
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
  double roughness_m = 0;            ///< equivalent sand-grain roughness of the bore
  double relative_permeability = 1;  ///< mu_r in a field as weak as the earth's; 1: not magnetic
};

struct NodeSpec {
  std::string id;
  Vector3d position_m = Vector3d::Zero();  ///< W frame: x east, y north, z up (elevation)
  bool open_water = false;                 ///< a reservoir or tank: whoever comes here has left the pipes
};

/// A concentric reducer at an end of a pipe: the bore widens to that of the pipe it meets there.
struct Cone {
  double length_m = 0;  ///< along the pipe, from its end; 0: none
  double end_radius_m = 0;
};

/// A pipe from node to node as a user describes it: the polyline from -> vertices -> to, corners rounded.
struct PipeSpec {
  std::string id;
  std::string from;
  std::string to;
  double diameter_m = 0;  ///< bore
  double wall_thickness_m = 0;
  double bend_radius_m = 0;  ///< of the centreline: at vertices, and where it meets one pipe alone; 0: none
  std::vector<Vector3d> vertices_m;
  WallMaterial material;
  double length_m = 0;          ///< as stated; 0: as drawn
  bool passable = true;         ///< false: a pump, a closed or throttling valve; nothing solid gets through
  bool fit_bends = false;       ///< bends that do not fit are made tighter or left out, not refused
  Cone cone_from{}, cone_to{};  ///< as stated; without, one is made where the next pipe in line is wider
};

/// One end of a pipe.
struct PipeEnd {
  int pipe = 0;
  bool at_to = false;
  bool operator==(const PipeEnd&) const = default;
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
  Cone cone_from, cone_to;
  bool passable = true;

  double radius_m() const { return 0.5 * diameter_m; }
  double area_m2() const;
  /// Radius of the bore at s: radius_m() but in the cones; beyond an end as at it.
  double RadiusAt_m(double s_m) const;
  double EndS_m(bool at_to) const { return at_to ? length_m : 0; }
  /// Index of the piece of the centreline that holds s; the first or last beyond the ends.
  std::size_t FindPiece(double s_m) const;
  /// Axis at s; beyond the ends the first or last piece goes on.
  CentrelinePoint Eval(double s_m) const;
  /// Unit tangent of the axis at an end, pointing into the pipe.
  Vector3d Inward(bool at_to) const;
};

/// An immutable pipe network: nodes, and pipes made of straight lines and circular bends, laid by LayPipes.
/// Every pipe has its own drawing: with stated lengths, its end need not lie where the next pipe begins.
class Network {
 public:
  /// Throws InputError with the key path ("network.pipes[2].diameter_m") of what is wrong: an id that is
  /// empty, used twice or unknown; a pipe from a node to itself; a size that is not a finite number > 0; a
  /// coordinate that is not finite; a length shorter than the rise; a bend tighter than the bore; a bend that
  /// or cone that does not fit; no pipe at all.
  Network(std::vector<NodeSpec> nodes, const std::vector<PipeSpec>& pipes);

  const std::vector<NodeSpec>& nodes() const { return nodes_; }
  const std::vector<Pipe>& pipes() const { return pipes_; }
  const Pipe& pipe(int i) const { return pipes_[static_cast<std::size_t>(i)]; }
  std::optional<int> FindNode(std::string_view id) const;
  std::optional<int> FindPipe(std::string_view id) const;
  /// The same of names that a user gave; InputError at `key_path`, with the nearest name, where there is
  /// none.
  int RequireNode(const std::string& id, const std::string& key_path) const;
  int RequirePipe(const std::string& id, const std::string& key_path) const;
  /// Pipes that begin or end at a node.
  const std::vector<PipeEnd>& EndsAt(int node) const { return ends_[static_cast<std::size_t>(node)]; }
  int NodeAt(PipeEnd end) const { return end.at_to ? pipe(end.pipe).to : pipe(end.pipe).from; }

 private:
  std::vector<NodeSpec> nodes_;
  std::vector<Pipe> pipes_;
  std::vector<std::vector<PipeEnd>> ends_;  ///< per node
  std::map<std::string, int, std::less<>> node_index_, pipe_index_;
};

}  // namespace piperun
