#include "base/route.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/check.h"
#include "base/number.h"

namespace piperun {
namespace {

constexpr double kMaxKink_rad = 1e-6;

void AppendLeg(const Network& network, RouteLeg leg, std::vector<RoutePiece>& pieces) {
  const Pipe& pipe = network.pipe(leg.pipe);
  const auto append = [&](const CentrelinePiece& piece) {
    const double chainage = pieces.empty() ? 0 : pieces.back().line.s_end_m();
    RoutePiece r;
    r.pipe = leg.pipe;
    r.reversed = leg.reversed;
    r.radius_m = pipe.radius_m();
    r.pipe_s_begin_m = leg.reversed ? piece.s_end_m() : piece.s_begin_m;
    if (leg.reversed) {
      r.line = Reversed(piece, chainage);
    } else {
      r.line = piece;
      r.line.s_begin_m = chainage;
    }
    pieces.push_back(r);
  };
  if (leg.reversed) {
    std::for_each(pipe.centreline.rbegin(), pipe.centreline.rend(), append);
  } else {
    std::for_each(pipe.centreline.begin(), pipe.centreline.end(), append);
  }
}

/// Pipe `b` must go on where pipe `a` ends: same place, same direction, same bore.
void RequireSmoothJoint(const Network& network, const RoutePiece& a, const RoutePiece& b) {
  const std::string names = "pipes '" + network.pipe(a.pipe).id + "' and '" + network.pipe(b.pipe).id + "' ";
  const CentrelinePoint end = EvalCentreline(a.line, a.line.s_end_m());
  if ((end.p_W - b.line.p_begin_W).norm() > 1e-6) throw InputError(names + "do not meet", "network.pipes");
  const double kink = std::atan2(end.tangent_W.cross(b.line.tangent_begin_W).norm(),
                                 end.tangent_W.dot(b.line.tangent_begin_W));
  if (kink > kMaxKink_rad) {
    throw InputError(names + "meet at an angle of " + FormatNumber(kink) +
                         " rad; move the corner into one pipe as a vertex, where it gets a bend",
                     "network.pipes");
  }
  if (a.radius_m != b.radius_m) {
    throw InputError(names + "differ in diameter (" + FormatNumber(2 * a.radius_m) + " m and " +
                         FormatNumber(2 * b.radius_m) + " m); reducers are not supported yet",
                     "network.pipes");
  }
}

int OtherEnd(const Pipe& pipe, int node) { return pipe.from == node ? pipe.to : pipe.from; }

constexpr int kUnreached = -1;

/// The pipe by which a breadth-first walk from `launch_node` first reaches each node, or kUnreached.
std::vector<int> SpreadFrom(const Network& network, int launch_node) {
  std::vector<int> reached_by(network.nodes().size(), kUnreached);
  std::deque<int> open{launch_node};
  while (!open.empty()) {
    const int node = open.front();
    open.pop_front();
    for (const auto& [p, at_to] : network.EndsAt(node)) {
      const int next = OtherEnd(network.pipe(p), node);
      if (next == launch_node || reached_by[static_cast<std::size_t>(next)] != kUnreached) continue;
      reached_by[static_cast<std::size_t>(next)] = p;
      open.push_back(next);
    }
  }
  return reached_by;
}

}  // namespace

Route::Route(const Network& network, std::vector<RouteLeg> legs) : legs_(std::move(legs)) {
  Demand(!legs_.empty(), "a route has at least one pipe");
  for (const RouteLeg& leg : legs_) {
    Demand(leg.pipe >= 0 && leg.pipe < static_cast<int>(network.pipes().size()), "a leg's pipe exists");
    const std::size_t first = pieces_.size();
    AppendLeg(network, leg, pieces_);
    if (first > 0) RequireSmoothJoint(network, pieces_[first - 1], pieces_[first]);
  }
}

std::size_t Route::FindPiece(double chainage_m, std::size_t hint) const {
  std::size_t i = std::min(hint, pieces_.size() - 1);
  while (i > 0 && chainage_m < pieces_[i].line.s_begin_m) --i;
  while (i + 1 < pieces_.size() && chainage_m >= pieces_[i + 1].line.s_begin_m) ++i;
  return i;
}

CentrelinePoint Route::Eval(double chainage_m, std::size_t hint) const {
  return EvalCentreline(pieces_[FindPiece(chainage_m, hint)].line, chainage_m);
}

PipePosition Route::Locate(double chainage_m, std::size_t hint) const {
  const RoutePiece& piece = pieces_[FindPiece(chainage_m, hint)];
  return {piece.pipe, piece.PipeS_m(chainage_m)};
}

std::optional<double> Route::Chainage(int pipe, double s_m) const {
  for (const RoutePiece& piece : pieces_) {
    if (piece.pipe != pipe) continue;
    const double offset = piece.reversed ? piece.pipe_s_begin_m - s_m : s_m - piece.pipe_s_begin_m;
    if (offset >= -1e-9 && offset <= piece.line.length_m + 1e-9) return piece.line.s_begin_m + offset;
  }
  return std::nullopt;
}

Route FindRoute(const Network& network, int launch_node, int retrieve_node) {
  const auto nodes = static_cast<int>(network.nodes().size());
  Demand(launch_node >= 0 && launch_node < nodes, "the launch node exists");
  Demand(retrieve_node >= 0 && retrieve_node < nodes, "the retrieve node exists");
  if (launch_node == retrieve_node) {
    throw InputError("launch and retrieve are the same node; give a loop two nodes where it closes",
                     "mission.retrieve");
  }
  const std::vector<int> reached_by = SpreadFrom(network, launch_node);
  std::vector<RouteLeg> legs;
  for (int node = retrieve_node; node != launch_node;) {
    const int p = reached_by[static_cast<std::size_t>(node)];
    if (p == kUnreached) throw InputError("no pipes lead there from the launch node", "mission.retrieve");
    legs.push_back({p, network.pipe(p).to != node});
    node = OtherEnd(network.pipe(p), node);
  }
  std::reverse(legs.begin(), legs.end());
  return Route(network, std::move(legs));
}

}  // namespace piperun
