#pragma once

#include <optional>
#include <vector>

#include "base/network.h"

namespace piperun {

/// One pipe of a route, walked from its `from` node (or from its `to` node when reversed).
struct RouteLeg {
  int pipe = 0;
  bool reversed = false;
};

/// A piece of centreline in the direction of travel; its s is the chainage.
struct RoutePiece {
  CentrelinePiece line;
  int pipe = 0;
  bool reversed = false;
  double radius_m = 0;        ///< bore
  double pipe_s_begin_m = 0;  ///< position along the pipe where the piece begins

  double PipeS_m(double chainage_m) const {
    return pipe_s_begin_m + (reversed ? -1 : 1) * (chainage_m - line.s_begin_m);
  }
};

/// Where a chainage lies in the network.
struct PipePosition {
  int pipe = 0;
  double s_m = 0;
};

/// The way through a network: a chain of pieces with chainage 0 at its first node.
class Route {
 public:
  /// Throws InputError when consecutive pipes do not meet, meet at an angle (a corner belongs into a pipe's
  /// vertices, where it gets a bend), or differ in bore.
  Route(const Network& network, std::vector<RouteLeg> legs);

  const std::vector<RouteLeg>& legs() const { return legs_; }
  const std::vector<RoutePiece>& pieces() const { return pieces_; }
  double length_m() const { return pieces_.back().line.s_end_m(); }

  /// Index of the piece that holds `chainage_m` (the first or last beyond the ends). `hint` is where to start
  /// looking: constant time along a continuous motion.
  std::size_t FindPiece(double chainage_m, std::size_t hint = 0) const;
  CentrelinePoint Eval(double chainage_m, std::size_t hint = 0) const;
  PipePosition Locate(double chainage_m, std::size_t hint = 0) const;
  /// Chainage of a position on a pipe (the first, should the route pass it twice), or nothing when the route
  /// does not use that pipe or the position lies beyond its ends.
  std::optional<double> Chainage(int pipe, double s_m) const;

 private:
  std::vector<RouteLeg> legs_;
  std::vector<RoutePiece> pieces_;
};

/// The way with the fewest pipes between two nodes. Throws InputError when there is none, or when the nodes
/// are the same (for a loop, give the nodes where it closes different ids).
Route FindRoute(const Network& network, int launch_node, int retrieve_node);

}  // namespace piperun
