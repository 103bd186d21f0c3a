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

/// A piece of centreline in the direction of travel; its s is the chainage. Cones are pieces of their own, so
/// that the bore changes evenly along a piece, if at all.
struct RoutePiece {
  CentrelinePiece line;
  int pipe = 0;
  bool reversed = false;
  double radius_m = 0;        ///< bore where the piece begins
  double taper = 0;           ///< change of the bore's radius per metre of chainage; 0 but in cones
  double pipe_s_begin_m = 0;  ///< position along the pipe where the piece begins

  double RadiusAt_m(double chainage_m) const { return radius_m + taper * (chainage_m - line.s_begin_m); }
  double PipeS_m(double chainage_m) const {
    return pipe_s_begin_m + (reversed ? -1 : 1) * (chainage_m - line.s_begin_m);
  }
};

/// Where a chainage lies in the network.
struct PipePosition {
  int pipe = 0;
  double s_m = 0;
};

/// The way through a network: a chain of pieces with chainage 0 at its first node. Every leg is shifted to
/// where the one before it ended: drawings need not close where lengths are stated (see Network). Legs may
/// meet at an angle and differ in bore; consecutive pieces then share their position only.
class Route {
 public:
  /// Throws InputError when a leg does not begin at the node where the one before it ends.
  Route(const Network& network, std::vector<RouteLeg> legs);

  const std::vector<RouteLeg>& legs() const { return legs_; }
  const std::vector<RoutePiece>& pieces() const { return pieces_; }
  double length_m() const { return pieces_.back().line.s_end_m(); }

  /// Index of the piece that holds `chainage_m` (the first or last beyond the ends). `hint` is where to start
  /// looking: constant time along a continuous motion.
  std::size_t FindPiece(double chainage_m, std::size_t hint = 0) const;
  CentrelinePoint Eval(double chainage_m, std::size_t hint = 0) const;
  /// Radius of the bore.
  double RadiusAt_m(double chainage_m, std::size_t hint = 0) const;
  PipePosition Locate(double chainage_m, std::size_t hint = 0) const;
  /// Chainage of a position on a pipe (the first, should the route pass it twice), or nothing when the route
  /// does not use that pipe or the position lies beyond its ends.
  std::optional<double> Chainage(int pipe, double s_m) const;

 private:
  std::vector<RouteLeg> legs_;
  std::vector<RoutePiece> pieces_;
};

/// The legs of a way that begins at a node and takes these pipes in turn. Throws InputError when a pipe does
/// not begin or end where the way has come to.
std::vector<RouteLeg> MakeLegs(const Network& network, int launch_node, const std::vector<int>& pipes);

/// The way with the fewest pipes between two nodes, through passable pipes and past no open water. Throws
/// InputError when there is none, or when the nodes are the same (for a loop, give the nodes where it closes
/// different ids).
Route FindRoute(const Network& network, int launch_node, int retrieve_node);

}  // namespace piperun
