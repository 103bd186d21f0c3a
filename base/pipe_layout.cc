#include "base/pipe_layout.h"

#include <algorithm>
#include <cmath>

#include "base/bend_fit.h"
#include "base/check.h"
#include "base/number.h"
#include "base/pipe_drafts.h"

namespace piperun {
namespace {

constexpr double kMinTurn_rad = 1e-9;     // below this a vertex is no corner
constexpr double kSmoothTurn_rad = 1e-6;  // below this two pipes are one
constexpr double kTightestBend = 0.6;     // radius over diameter
constexpr double kStraightBeside = 1.5;   // of junctions and mitres, over diameter

/// Which corner a bend is: an inner vertex of a pipe's line, or the joint at a node.
struct BendPlace {
  int pipe = -1;
  std::size_t vertex = 0;
  int node = -1;
  double least_radius_m = 0;
};

/// All corners of a network as bends that compete for straights.
struct Fit {
  std::vector<BendStraight> straights;
  std::vector<int> first_straight;  ///< per pipe
  std::vector<BendDemand> bends;
  std::vector<BendPlace> places;  ///< of the bends
  std::vector<double> radii_m;    ///< of the bends, once they are fitted

  void Add(const BendDemand& bend, const BendPlace& place) {
    for (const BendSide& side : bend.sides) {
      straights[static_cast<std::size_t>(side.straight)].bend[static_cast<std::size_t>(side.end)] =
          static_cast<int>(bends.size());
    }
    bends.push_back(bend);
    places.push_back(place);
  }
  bool TooTight(std::size_t i) const { return bends[i].may_shrink && radii_m[i] < places[i].least_radius_m; }
};

double CalcLeastRadius_m(double wanted_m, double diameter_m) {
  return std::min(wanted_m, kTightestBend * diameter_m);
}

void AddStraights(const PipeDrafts& drafts, int pipe, Fit& fit) {
  fit.first_straight.push_back(static_cast<int>(fit.straights.size()));
  for (const Straight& straight : drafts.line(pipe).straights) {
    fit.straights.push_back({straight.length_m});
  }
  const double kept_m = kStraightBeside * drafts.spec(pipe).diameter_m;
  const auto first = static_cast<std::size_t>(fit.first_straight.back());
  if (drafts.EndsSharp({pipe, false})) fit.straights[first].kept_m[0] = kept_m;
  if (drafts.EndsSharp({pipe, true})) fit.straights.back().kept_m[1] = kept_m;
}

void AddVertices(const PipeDrafts& drafts, int pipe, Fit& fit) {
  const PipeSpec& spec = drafts.spec(pipe);
  const std::vector<Straight>& straights = drafts.line(pipe).straights;
  const int first = fit.first_straight[static_cast<std::size_t>(pipe)];
  for (std::size_t i = 1; i < straights.size(); ++i) {
    const double turn_rad = CalcTurn_rad(straights[i - 1].tangent_W, straights[i].tangent_W);
    if (turn_rad < kMinTurn_rad) continue;
    const double per_radius = std::tan(turn_rad / 2);
    const int after = first + static_cast<int>(i);
    fit.Add({spec.bend_radius_m, spec.fit_bends, {{{after - 1, 1, per_radius}, {after, 0, per_radius}}}},
            {pipe, i, -1, CalcLeastRadius_m(spec.bend_radius_m, spec.diameter_m)});
  }
}

void AddJoint(const PipeDrafts& drafts, int node, Fit& fit) {
  const auto bend = drafts.FindJointBend(node);
  if (!bend) return;
  BendDemand demand;
  demand.radius_m = bend->radius_m;
  double diameter_m = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const PipeEnd end = bend->end[side];
    const PipeSpec& spec = drafts.spec(end.pipe);
    const auto straight =
        fit.first_straight[static_cast<std::size_t>(end.pipe)] + static_cast<int>(drafts.StraightAt(end));
    // an arc may be longer than what it takes from the straight, and the pipe's length has to hold it
    const double per_radius = std::max(std::tan(bend->turn_rad / 2), bend->part[side] * bend->turn_rad);
    demand.sides[side] = {straight, end.at_to ? 1 : 0, per_radius};
    demand.may_shrink = demand.may_shrink || spec.fit_bends;
    diameter_m = std::max(diameter_m, spec.diameter_m);
  }
  fit.Add(demand, {-1, 0, node, CalcLeastRadius_m(bend->radius_m, diameter_m)});
}

Fit FitBends(const PipeDrafts& drafts) {
  Fit fit;
  const auto pipes = static_cast<int>(drafts.plan().specs.size());
  const auto nodes = static_cast<int>(drafts.plan().nodes.size());
  for (int pipe = 0; pipe < pipes; ++pipe) AddStraights(drafts, pipe, fit);
  for (int pipe = 0; pipe < pipes; ++pipe) AddVertices(drafts, pipe, fit);
  for (int node = 0; node < nodes; ++node) AddJoint(drafts, node, fit);
  fit.radii_m = CalcFittingRadii(fit.straights, fit.bends);
  return fit;
}

/// Leaves out the tightest vertex of every pipe that has one too tight; whether there was any.
bool DropTightVertices(const Fit& fit, PipeDrafts& drafts) {
  const auto tightness = [&](std::size_t i) { return fit.radii_m[i] / fit.places[i].least_radius_m; };
  bool dropped = false;
  for (std::size_t i = 0; i < fit.places.size();) {
    const int pipe = fit.places[i].pipe;
    std::size_t tightest = i, end = i;
    for (; end < fit.places.size() && fit.places[end].pipe == pipe; ++end) {
      if (fit.TooTight(end) && (!fit.TooTight(tightest) || tightness(end) < tightness(tightest))) {
        tightest = end;
      }
    }
    if (pipe >= 0 && fit.TooTight(tightest)) {
      drafts.DropVertex(pipe, fit.places[tightest].vertex);
      dropped = true;
    }
    i = end;
  }
  return dropped;
}

bool MitreTightJoints(const Fit& fit, PipeDrafts& drafts) {
  bool mitred = false;
  for (std::size_t i = 0; i < fit.places.size(); ++i) {
    if (fit.places[i].node < 0 || !fit.TooTight(i)) continue;
    drafts.Mitre(fit.places[i].node);
    mitred = true;
  }
  return mitred;
}

/// Every round leaves out a corner at least, so this ends.
Fit ThinOut(PipeDrafts& drafts) {
  Fit fit = FitBends(drafts);
  while (DropTightVertices(fit, drafts) || MitreTightJoints(fit, drafts)) fit = FitBends(drafts);
  return fit;
}

EndBend MakeEndBend(const PipeDrafts& drafts, const JointBend& bend, std::size_t side, double radius_m) {
  const PipeEnd end = bend.end[side];
  const Vector3d inward = drafts.Inward(end), away = -drafts.Inward(bend.end[1 - side]);
  EndBend part;
  part.radius_m = radius_m;
  part.turn_rad = bend.part[side] * bend.turn_rad;
  part.tangent_length_m = radius_m * std::tan(bend.turn_rad / 2);
  // along the pipe's own direction: the bisector, or what the other pipe's straight says
  const Vector3d into = bend.part[side] == 0.5 ? (away + inward).normalized()
                        : bend.part[side] == 1 ? away
                                               : inward;
  part.tangent_W = end.at_to ? Vector3d(-into) : into;
  return part;
}

std::vector<LineBends> CollectBends(const PipeDrafts& drafts, const Fit& fit) {
  std::vector<LineBends> bends(drafts.plan().specs.size());
  for (std::size_t pipe = 0; pipe < bends.size(); ++pipe) {
    const int i = static_cast<int>(pipe);
    bends[pipe].radius_m.assign(drafts.line(i).straights.size() - 1, drafts.spec(i).bend_radius_m);
  }
  for (std::size_t i = 0; i < fit.places.size(); ++i) {
    const BendPlace& place = fit.places[i];
    if (place.pipe >= 0) {
      bends[static_cast<std::size_t>(place.pipe)].radius_m[place.vertex - 1] = fit.radii_m[i];
      continue;
    }
    const JointBend joint = *drafts.FindJointBend(place.node);
    for (std::size_t side = 0; side < 2; ++side) {
      LineBends& line = bends[static_cast<std::size_t>(joint.end[side].pipe)];
      (joint.end[side].at_to ? line.end : line.begin) = MakeEndBend(drafts, joint, side, fit.radii_m[i]);
    }
  }
  return bends;
}

/// Bends must not reach into a junction or a sharp corner.
void RequireStraightEnds(const PipeDrafts& drafts, int pipe, const std::vector<CentrelinePiece>& pieces) {
  for (const bool at_to : {false, true}) {
    const CentrelinePiece& piece = at_to ? pieces.back() : pieces.front();
    if (piece.straight() || !drafts.EndsSharp({pipe, at_to})) continue;
    const NodeSpec& node = drafts.plan().nodes[static_cast<std::size_t>(drafts.NodeAt({pipe, at_to}))];
    throw InputError("the bend of radius " + FormatNumber(1 / piece.curvature_1_m) + " m next to node '" +
                     node.id +
                     "' leaves no straight there, where other pipes meet it; give a smaller radius");
  }
}

std::vector<CentrelinePiece> MakeCentreline(const PipeDrafts& drafts, int pipe, const LineBends& bends) {
  try {
    const Polyline& line = drafts.line(pipe);
    const double length_m = drafts.spec(pipe).length_m;
    std::vector<CentrelinePiece> pieces =
        RoundCorners(length_m > 0 ? FitStraights(line, bends, length_m) : line, bends);
    RequireStraightEnds(drafts, pipe, pieces);
    return pieces;
  } catch (const InputError& e) {
    throw InputError(e.problem(), PipeKey(pipe));
  }
}

/// Direction of a course at its end, into the pipe.
Vector3d CalcInward(const PipeCourse& course, bool at_to) {
  const CentrelinePiece& piece = at_to ? course.centreline.back() : course.centreline.front();
  if (!at_to) return piece.tangent_begin_W;
  return -EvalCentreline(piece, piece.s_end_m()).tangent_W;
}

void AddCone(const PipeDrafts& drafts, int node, std::vector<PipeCourse>& courses) {
  const std::vector<PipeEnd>& ends = drafts.EndsAt(node);
  if (ends.size() != 2) return;
  const auto course = [&](PipeEnd end) -> PipeCourse& { return courses[static_cast<std::size_t>(end.pipe)]; };
  const auto bore = [&](PipeEnd end) { return drafts.spec(end.pipe).diameter_m; };
  const std::size_t narrower = bore(ends[0]) < bore(ends[1]) ? 0 : 1;
  const PipeEnd narrow = ends[narrower], wide = ends[1 - narrower];
  if (bore(narrow) == bore(wide)) return;
  const Vector3d in = CalcInward(course(narrow), narrow.at_to), out = -CalcInward(course(wide), wide.at_to);
  PipeCourse& at = course(narrow);
  const CentrelinePiece& piece = narrow.at_to ? at.centreline.back() : at.centreline.front();
  if (CalcTurn_rad(in, out) > kSmoothTurn_rad || !piece.straight()) return;
  (narrow.at_to ? at.cone_to : at.cone_from) = CalcCone(bore(narrow), bore(wide), piece.length_m);
}

}  // namespace

Cone CalcCone(double narrow_m, double wide_m, double straight_m) {
  return {std::min(2 * (wide_m - narrow_m), 0.5 * straight_m), 0.5 * wide_m};
}

std::vector<PipeCourse> LayPipes(const NetworkPlan& plan) {
  PipeDrafts drafts(plan);
  const Fit fit = ThinOut(drafts);
  const std::vector<LineBends> bends = CollectBends(drafts, fit);
  std::vector<PipeCourse> courses;
  for (std::size_t pipe = 0; pipe < bends.size(); ++pipe) {
    courses.push_back({MakeCentreline(drafts, static_cast<int>(pipe), bends[pipe]), {}, {}});
  }
  for (std::size_t node = 0; node < plan.nodes.size(); ++node) {
    AddCone(drafts, static_cast<int>(node), courses);
  }
  return courses;
}

}  // namespace piperun
