#include "base/network.h"

#include <algorithm>
#include <numbers>

#include "base/check.h"
#include "base/number.h"

namespace piperun {
namespace {

template <class T>
std::optional<int> FindId(const std::vector<T>& items, std::string_view id) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const T& item) { return item.id == id; });
  if (found == items.end()) return std::nullopt;
  return static_cast<int>(found - items.begin());
}

void RequirePositive(double value, const std::string& key) {
  if (!(value > 0)) throw InputError(FormatNumber(value) + " is not allowed; it must be > 0", key);
}

int ResolveNode(const std::vector<NodeSpec>& nodes, const std::string& id, const std::string& key) {
  const auto node = FindId(nodes, id);
  if (!node) throw InputError("there is no node '" + id + "'", key);
  return *node;
}

Pipe BuildPipe(const std::vector<NodeSpec>& nodes, const PipeSpec& spec, const std::string& key) {
  Pipe pipe;
  pipe.id = spec.id;
  pipe.from = ResolveNode(nodes, spec.from, key + ".from");
  pipe.to = ResolveNode(nodes, spec.to, key + ".to");
  RequirePositive(spec.diameter_m, key + ".diameter_m");
  RequirePositive(spec.wall_thickness_m, key + ".wall_thickness_m");
  pipe.diameter_m = spec.diameter_m;
  pipe.wall_thickness_m = spec.wall_thickness_m;
  pipe.material = spec.material;
  if (!spec.vertices_m.empty() && !(spec.bend_radius_m > 0.5 * spec.diameter_m)) {
    throw InputError(FormatNumber(spec.bend_radius_m) + " m is too tight: a bend's radius must exceed the bore radius " +
                         FormatNumber(0.5 * spec.diameter_m) + " m",
                     key + ".bend_radius_m");
  }
  std::vector<Vector3d> line{nodes[static_cast<std::size_t>(pipe.from)].position_m};
  line.insert(line.end(), spec.vertices_m.begin(), spec.vertices_m.end());
  line.push_back(nodes[static_cast<std::size_t>(pipe.to)].position_m);
  try {
    pipe.centreline = RoundCorners(line, spec.bend_radius_m);
  } catch (const InputError& e) {
    throw InputError(e.problem(), key);
  }
  pipe.length_m = pipe.centreline.back().s_end_m();
  return pipe;
}

template <class T>
void RefuseDuplicateIds(const std::vector<T>& items, const std::string& list) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (FindId(items, items[i].id) != static_cast<int>(i)) {
      throw InputError("'" + items[i].id + "' is used twice; ids must be unique",
                       list + "[" + std::to_string(i) + "].id");
    }
  }
}

}  // namespace

double Pipe::area_m2() const { return std::numbers::pi * radius_m() * radius_m(); }

Network::Network(std::vector<NodeSpec> nodes, const std::vector<PipeSpec>& pipes) : nodes_(std::move(nodes)) {
  if (pipes.empty()) throw InputError("a network needs at least one pipe", "network.pipes");
  RefuseDuplicateIds(nodes_, "network.nodes");
  RefuseDuplicateIds(pipes, "network.pipes");
  pipes_.reserve(pipes.size());
  for (std::size_t i = 0; i < pipes.size(); ++i) {
    pipes_.push_back(BuildPipe(nodes_, pipes[i], "network.pipes[" + std::to_string(i) + "]"));
  }
}

std::optional<int> Network::FindNode(std::string_view id) const { return FindId(nodes_, id); }
std::optional<int> Network::FindPipe(std::string_view id) const { return FindId(pipes_, id); }

std::vector<int> Network::PipesAt(int node) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < pipes_.size(); ++i) {
    if (pipes_[i].from == node || pipes_[i].to == node) found.push_back(static_cast<int>(i));
  }
  return found;
}

}  // namespace piperun
