#include "base/route.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/check.h"

namespace piperun {
namespace {

constexpr double kMaxGap_m = 1e-9;  // below this one leg's drawing goes on in the next

/// A stretch of a pipe in which its bore changes evenly, and its centreline is one line or arc.
struct Stretch {
  CentrelinePiece line;  // s along the pipe
  double radius_begin_m = 0, radius_end_m = 0;
};

/// The part of a straight from s to its end.
CentrelinePiece CutOff(CentrelinePiece& line, double s_m) {
  CentrelinePiece rest = line;
  rest.p_begin_W = EvalCentreline(line, s_m).p_W;
  rest.s_begin_m = s_m;
  rest.length_m = line.s_end_m() - s_m;
  line.length_m = s_m - line.s_begin_m;
  return rest;
}

/// The pieces of a pipe's centreline, cut where its cones end. A cone lies within a straight (see LayPipes).
std::vector<Stretch> CutAtCones(const Pipe& pipe) {
  std::vector<CentrelinePiece> lines = pipe.centreline;
  if (pipe.cone_from.length_m > 0)
    lines.insert(lines.begin() + 1, CutOff(lines.front(), pipe.cone_from.length_m));
  if (pipe.cone_to.length_m > 0) {
    lines.push_back(CutOff(lines.back(), pipe.length_m - pipe.cone_to.length_m));
  }
  std::vector<Stretch> stretches;
  for (const CentrelinePiece& line : lines) stretches.push_back({line, pipe.radius_m(), pipe.radius_m()});
  if (pipe.cone_from.length_m > 0) stretches.front().radius_begin_m = pipe.cone_from.end_radius_m;
  if (pipe.cone_to.length_m > 0) stretches.back().radius_end_m = pipe.cone_to.end_radius_m;
  return stretches;
}

RoutePiece MakePiece(RouteLeg leg, const Stretch& stretch, double chainage_m) {
  RoutePiece piece;
  piece.pipe = leg.pipe;
  piece.reversed = leg.reversed;
  piece.radius_m = leg.reversed ? stretch.radius_end_m : stretch.radius_begin_m;
  const double radius_end_m = leg.reversed ? stretch.radius_begin_m : stretch.radius_end_m;
  piece.taper = (radius_end_m - piece.radius_m) / stretch.line.length_m;
  piece.pipe_s_begin_m = leg.reversed ? stretch.line.s_end_m() : stretch.line.s_begin_m;
  piece.line = leg.reversed ? Reversed(stretch.line, chainage_m) : stretch.line;
  piece.line.s_begin_m = chainage_m;
  return piece;
}

void AppendLeg(const Network& network, RouteLeg leg, std::vector<RoutePiece>& pieces) {
  std::vector<Stretch> stretches = CutAtCones(network.pipe(leg.pipe));
  if (leg.reversed) std::reverse(stretches.begin(), stretches.end());
  const std::size_t first = pieces.size();
  for (const Stretch& stretch : stretches) {
    pieces.push_back(MakePiece(leg, stretch, pieces.empty() ? 0 : pieces.back().line.s_end_m()));
  }
  if (first == 0) return;
  const CentrelinePiece& before = pieces[first - 1].line;
  const Vector3d gap_W = EvalCentreline(before, before.s_end_m()).p_W - pieces[first].line.p_begin_W;
  if (gap_W.norm() <= kMaxGap_m) return;
  for (std::size_t i = first; i < pieces.size(); ++i) pieces[i].line.p_begin_W += gap_W;
}

int BeginOf(const Network& network, RouteLeg leg) { return network.NodeAt({leg.pipe, leg.reversed}); }
int EndOf(const Network& network, RouteLeg leg) { return network.NodeAt({leg.pipe, !leg.reversed}); }

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
      if (!network.pipe(p).passable) continue;
      if (next == launch_node || reached_by[static_cast<std::size_t>(next)] != kUnreached) continue;
      reached_by[static_cast<std::size_t>(next)] = p;
      if (!network.nodes()[static_cast<std::size_t>(next)].open_water) open.push_back(next);
    }
  }
  return reached_by;
}

}  // namespace

Route::Route(const Network& network, std::vector<RouteLeg> legs) : legs_(std::move(legs)) {
  Demand(!legs_.empty(), "a route has at least one pipe");
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    const RouteLeg leg = legs_[i];
    Demand(leg.pipe >= 0 && leg.pipe < static_cast<int>(network.pipes().size()), "a leg's pipe exists");
    if (i > 0 && BeginOf(network, leg) != EndOf(network, legs_[i - 1])) {
      throw InputError("pipes '" + network.pipe(legs_[i - 1].pipe).id + "' and '" +
                           network.pipe(leg.pipe).id + "' do not meet",
                       "network.pipes");
    }
    AppendLeg(network, leg, pieces_);
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

double Route::RadiusAt_m(double chainage_m, std::size_t hint) const {
  return pieces_[FindPiece(chainage_m, hint)].RadiusAt_m(chainage_m);
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

std::vector<RouteLeg> MakeLegs(const Network& network, int launch_node, const std::vector<int>& pipes) {
  std::vector<RouteLeg> legs;
  int node = launch_node;
  for (const int p : pipes) {
    const Pipe& pipe = network.pipe(p);
    if (pipe.from != node && pipe.to != node) {
      throw InputError("pipe '" + pipe.id + "' does not lead on from node '" +
                           network.nodes()[static_cast<std::size_t>(node)].id + "'",
                       "network.pipes");
    }
    legs.push_back({p, pipe.from != node});
    node = OtherEnd(pipe, node);
  }
  return legs;
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
    if (p == kUnreached) {
      throw InputError("no pipes that a ball can pass lead there from the launch node", "mission.retrieve");
    }
    legs.push_back({p, network.pipe(p).to != node});
    node = OtherEnd(network.pipe(p), node);
  }
  std::reverse(legs.begin(), legs.end());
  return Route(network, std::move(legs));
}

}  // namespace piperun
