#include "base/network.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number.h"
#include "base/pipe_layout.h"

namespace piperun {
namespace {

using IdIndex = std::map<std::string, int, std::less<>>;

std::optional<int> FindId(const IdIndex& index, std::string_view id) {
  const auto found = index.find(id);
  if (found == index.end()) return std::nullopt;
  return found->second;
}

std::string ItemKey(const std::string& list, std::size_t i) { return list + "[" + std::to_string(i) + "]"; }

void RequirePositive(double value, const std::string& key) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(FormatNumber(value) + " is not allowed; it must be a finite number > 0", key);
}

void RequireFinite(const Vector3d& p, const std::string& key) {
  if (!p.allFinite()) throw InputError("a coordinate is not a finite number", key);
}

void RequireBendWiderThanBore(const PipeSpec& spec, const std::string& key) {
  if (!spec.vertices_m.empty()) RequirePositive(spec.bend_radius_m, key);
  const double bore_radius_m = 0.5 * spec.diameter_m;
  if (spec.bend_radius_m == 0 || (spec.bend_radius_m > bore_radius_m && std::isfinite(spec.bend_radius_m))) {
    return;
  }
  throw InputError(FormatNumber(spec.bend_radius_m) +
                       " m is too tight: a bend's radius must exceed the bore radius " +
                       FormatNumber(bore_radius_m) + " m",
                   key);
}

void RequireConeFits(const Cone& cone, const CentrelinePiece& at_end, double free_m, const std::string& key) {
  if (cone.length_m == 0) return;
  RequirePositive(cone.length_m, key + ".length_m");
  RequirePositive(cone.end_radius_m, key + ".end_radius_m");
  const double longest_m = at_end.straight() ? std::min(at_end.length_m, free_m) : 0;
  if (cone.length_m <= longest_m) return;
  throw InputError(FormatNumber(cone.length_m) + " m does not fit; the straight at this end has room for " +
                       FormatNumber(longest_m) + " m",
                   key + ".length_m");
}

int RequireId(const std::string& what, const IdIndex& index, const std::string& id, const std::string& key) {
  if (const auto found = FindId(index, id)) return *found;
  std::vector<std::string> known;
  for (const auto& [name, number] : index) known.push_back(name);
  std::string problem = "there is no " + what + " '" + id + "'";
  if (const auto near = FindNearestName(id, known)) problem += "; did you mean '" + *near + "'?";
  throw InputError(problem, key);
}

PipeNodes ResolveNodes(const IdIndex& nodes, const PipeSpec& spec, const std::string& key) {
  const PipeNodes at{RequireId("node", nodes, spec.from, key + ".from"),
                     RequireId("node", nodes, spec.to, key + ".to")};
  if (at.from != at.to) return at;
  throw InputError("the pipe leads from '" + spec.from + "' to itself; give its far end a node of its own",
                   key + ".to");
}

void RequireValid(const PipeSpec& spec, const std::string& key) {
  RequirePositive(spec.diameter_m, key + ".diameter_m");
  RequirePositive(spec.wall_thickness_m, key + ".wall_thickness_m");
  if (spec.length_m != 0) RequirePositive(spec.length_m, key + ".length_m");
  RequireBendWiderThanBore(spec, key + ".bend_radius_m");
  for (std::size_t i = 0; i < spec.vertices_m.size(); ++i) {
    RequireFinite(spec.vertices_m[i], ItemKey(key + ".vertices_m", i));
  }
}

Pipe MakePipe(const PipeSpec& spec, PipeNodes at, PipeCourse course, const std::string& key) {
  Pipe pipe;
  pipe.id = spec.id;
  pipe.from = at.from;
  pipe.to = at.to;
  pipe.diameter_m = spec.diameter_m;
  pipe.wall_thickness_m = spec.wall_thickness_m;
  pipe.material = spec.material;
  pipe.centreline = std::move(course.centreline);
  pipe.length_m = pipe.centreline.back().s_end_m();
  RequireConeFits(spec.cone_from, pipe.centreline.front(), pipe.length_m, key + ".cone_from");
  RequireConeFits(spec.cone_to, pipe.centreline.back(), pipe.length_m - spec.cone_from.length_m,
                  key + ".cone_to");
  pipe.cone_from = spec.cone_from.length_m > 0 ? spec.cone_from : course.cone_from;
  pipe.cone_to = spec.cone_to.length_m > 0 ? spec.cone_to : course.cone_to;
  pipe.passable = spec.passable;
  return pipe;
}

template <class T>
IdIndex IndexIds(const std::vector<T>& items, const std::string& list) {
  IdIndex index;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string key = ItemKey(list, i) + ".id";
    if (items[i].id.empty()) throw InputError("an id must not be empty", key);
    if (!index.emplace(items[i].id, static_cast<int>(i)).second) {
      throw InputError("'" + items[i].id + "' is used twice; ids must be unique", key);
    }
  }
  return index;
}

}  // namespace

double Pipe::area_m2() const { return std::numbers::pi * radius_m() * radius_m(); }

double Pipe::RadiusAt_m(double s_m) const {
  const auto in_cone = [this](const Cone& cone, double from_end_m) {
    return std::lerp(cone.end_radius_m, radius_m(), std::max(0.0, from_end_m) / cone.length_m);
  };
  if (cone_from.length_m > 0 && s_m < cone_from.length_m) return in_cone(cone_from, s_m);
  const double to_end_m = length_m - s_m;
  if (cone_to.length_m > 0 && to_end_m < cone_to.length_m) return in_cone(cone_to, to_end_m);
  return radius_m();
}

std::size_t Pipe::FindPiece(double s_m) const {
  std::size_t i = 0;
  while (i + 1 < centreline.size() && s_m > centreline[i].s_end_m()) ++i;
  return i;
}

CentrelinePoint Pipe::Eval(double s_m) const { return EvalCentreline(centreline[FindPiece(s_m)], s_m); }

Vector3d Pipe::Inward(bool at_to) const {
  const Vector3d tangent = Eval(EndS_m(at_to)).tangent_W;
  return at_to ? -tangent : tangent;
}

Network::Network(std::vector<NodeSpec> nodes, const std::vector<PipeSpec>& pipes) : nodes_(std::move(nodes)) {
  if (pipes.empty()) throw InputError("a network needs at least one pipe", "network.pipes");
  node_index_ = IndexIds(nodes_, "network.nodes");
  pipe_index_ = IndexIds(pipes, "network.pipes");
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    RequireFinite(nodes_[i].position_m, ItemKey("network.nodes", i) + ".position_m");
  }
  std::vector<PipeNodes> pipe_nodes;
  ends_.resize(nodes_.size());
  for (std::size_t i = 0; i < pipes.size(); ++i) {
    const std::string key = ItemKey("network.pipes", i);
    pipe_nodes.push_back(ResolveNodes(node_index_, pipes[i], key));
    RequireValid(pipes[i], key);
    ends_[static_cast<std::size_t>(pipe_nodes[i].from)].push_back({static_cast<int>(i), false});
    ends_[static_cast<std::size_t>(pipe_nodes[i].to)].push_back({static_cast<int>(i), true});
  }
  std::vector<PipeCourse> courses = LayPipes({nodes_, pipes, pipe_nodes, ends_});
  for (std::size_t i = 0; i < pipes.size(); ++i) {
    pipes_.push_back(MakePipe(pipes[i], pipe_nodes[i], std::move(courses[i]), ItemKey("network.pipes", i)));
  }
}

std::optional<int> Network::FindNode(std::string_view id) const { return FindId(node_index_, id); }
std::optional<int> Network::FindPipe(std::string_view id) const { return FindId(pipe_index_, id); }

int Network::RequireNode(const std::string& id, const std::string& key_path) const {
  return RequireId("node", node_index_, id, key_path);
}

int Network::RequirePipe(const std::string& id, const std::string& key_path) const {
  return RequireId("pipe", pipe_index_, id, key_path);
}

}  // namespace piperun
