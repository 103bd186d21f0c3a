#include "base/pipe_drafts.h"

#include <algorithm>

#include "base/check.h"

namespace piperun {
namespace {

constexpr double kMinTurn_rad = 1e-9;  // below this two pipes go on straight
constexpr double kSameVertex_m = 1e-3;

/// Leaves out inner vertices that coincide with their neighbours: drawings often repeat the nodes there.
void DropRepeatedVertices(std::vector<Vector3d>& vertices_W) {
  const auto same = [](const Vector3d& a, const Vector3d& b) { return (a - b).norm() < kSameVertex_m; };
  const Vector3d last = vertices_W.back();
  vertices_W.pop_back();
  vertices_W.erase(std::unique(vertices_W.begin(), vertices_W.end(), same), vertices_W.end());
  while (vertices_W.size() > 1 && same(vertices_W.back(), last)) vertices_W.pop_back();
  vertices_W.push_back(last);
}

/// Calls `act`; an error of the line gets the key of its pipe.
template <class Act>
auto WithKey(const std::string& key, Act act) {
  try {
    return act();
  } catch (const InputError& e) {
    throw InputError(e.problem(), key);
  }
}

}  // namespace

std::string PipeKey(int pipe) { return "network.pipes[" + std::to_string(pipe) + "]"; }

PipeDrafts::PipeDrafts(const NetworkPlan& plan) : plan_(plan), mitred_(plan.nodes.size(), false) {
  for (std::size_t i = 0; i < plan.specs.size(); ++i) {
    const PipeSpec& spec = plan.specs[i];
    Draft draft;
    draft.drawn_W.push_back(plan.nodes[static_cast<std::size_t>(plan.pipe_nodes[i].from)].position_m);
    draft.drawn_W.insert(draft.drawn_W.end(), spec.vertices_m.begin(), spec.vertices_m.end());
    draft.drawn_W.push_back(plan.nodes[static_cast<std::size_t>(plan.pipe_nodes[i].to)].position_m);
    if (spec.fit_bends) DropRepeatedVertices(draft.drawn_W);
    drafts_.push_back(std::move(draft));
    Draw(static_cast<int>(i));
  }
}

void PipeDrafts::Draw(int pipe) {
  Draft& draft = this->draft(pipe);
  const double length_m = spec(pipe).length_m;
  const std::vector<Vector3d> vertices_W = WithKey(PipeKey(pipe) + ".length_m", [&] {
    return length_m > 0 ? StretchToLength(draft.drawn_W, length_m) : draft.drawn_W;
  });
  draft.line = WithKey(PipeKey(pipe), [&] { return MakePolyline(vertices_W); });
}

void PipeDrafts::DropVertex(int pipe, std::size_t vertex) {
  std::vector<Vector3d>& drawn_W = draft(pipe).drawn_W;
  Demand(vertex > 0 && vertex + 1 < drawn_W.size(), "only inner vertices may be left out");
  drawn_W.erase(drawn_W.begin() + static_cast<std::ptrdiff_t>(vertex));
  DropRepeatedVertices(drawn_W);  // the feet of a spur
  Draw(pipe);
}

Vector3d PipeDrafts::Inward(PipeEnd end) const {
  const std::vector<Straight>& straights = line(end.pipe).straights;
  return end.at_to ? Vector3d(-straights.back().tangent_W) : straights.front().tangent_W;
}

std::size_t PipeDrafts::StraightAt(PipeEnd end) const {
  return end.at_to ? line(end.pipe).straights.size() - 1 : 0;
}

int PipeDrafts::NodeAt(PipeEnd end) const {
  const PipeNodes& at = plan_.pipe_nodes[static_cast<std::size_t>(end.pipe)];
  return end.at_to ? at.to : at.from;
}

std::optional<JointBend> PipeDrafts::FindJointBend(int node) const {
  const std::vector<PipeEnd>& ends = EndsAt(node);
  if (ends.size() != 2 || mitred_[static_cast<std::size_t>(node)]) return std::nullopt;
  const PipeSpec &a = spec(ends[0].pipe), &b = spec(ends[1].pipe);
  if (!(a.bend_radius_m > 0 && b.bend_radius_m > 0)) return std::nullopt;
  JointBend bend;
  bend.turn_rad = CalcTurn_rad(-Inward(ends[0]), Inward(ends[1]));
  if (bend.turn_rad < kMinTurn_rad) return std::nullopt;
  bend.end = {ends[0], ends[1]};
  const double part = a.diameter_m == b.diameter_m ? 0.5 : a.diameter_m > b.diameter_m ? 1 : 0;
  bend.part = {part, 1 - part};
  bend.radius_m = std::max(a.bend_radius_m, b.bend_radius_m);
  return bend;
}

bool PipeDrafts::EndsSharp(PipeEnd end) const {
  const int node = NodeAt(end);
  const std::vector<PipeEnd>& ends = EndsAt(node);
  if (ends.size() != 2) return ends.size() > 2;
  return CalcTurn_rad(-Inward(ends[0]), Inward(ends[1])) >= kMinTurn_rad && !FindJointBend(node);
}

}  // namespace piperun
