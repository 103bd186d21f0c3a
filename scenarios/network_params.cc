#include "scenarios/network_params.h"

#include <algorithm>

#include "base/check.h"
#include "base/number.h"

namespace piperun::scenarios {
namespace {

WallMaterial MakeMaterial(const PipeEntry& entry) {
  const WallParams& wall = entry.wall;
  return {entry.material,     wall.young_modulus_Pa, wall.loss_factor,          wall.poisson_ratio,
          wall.density_kg_m3, wall.roughness_m,      wall.relative_permeability};
}

PipeSpec MakeSpec(const PipeEntry& entry) {
  PipeSpec spec;
  spec.id = entry.id;
  spec.from = entry.from;
  spec.to = entry.to;
  spec.diameter_m = entry.diameter_m;
  spec.wall_thickness_m = entry.wall_thickness_m;
  spec.bend_radius_m = entry.bend_radius_m;
  spec.material = MakeMaterial(entry);
  spec.length_m = entry.length_m.value_or(0);
  spec.passable = entry.passable;
  spec.fit_bends = entry.fit_bends;
  for (std::size_t i = 0; i < entry.vertices_m.size(); i += 3) {
    spec.vertices_m.emplace_back(entry.vertices_m[i], entry.vertices_m[i + 1], entry.vertices_m[i + 2]);
  }
  return spec;
}

}  // namespace

void RequirePlainId(const std::string& id, const std::string& key_path) {
  const auto refused = [](unsigned char c) { return c < ' ' || c == ',' || c == '"' || c == '\''; };
  if (id.empty() || id.front() == '#' || std::any_of(id.begin(), id.end(), refused)) {
    throw InputError(
        "an id is not empty, does not begin with '#' and holds no comma, quote or control character",
        key_path);
  }
}

Network MakeNetwork(const NetworkParams& params) {
  std::vector<NodeSpec> nodes;
  for (const NodeEntry& entry : params.nodes) nodes.push_back({entry.id, entry.position_m, entry.open_water});
  std::vector<PipeSpec> pipes;
  for (std::size_t i = 0; i < params.pipes.size(); ++i) {
    RequirePlainId(params.pipes[i].id, "network.pipes[" + std::to_string(i) + "].id");
    pipes.push_back(MakeSpec(params.pipes[i]));
  }
  return Network(std::move(nodes), pipes);
}

estimator::FittingKind FittingKindOf(const std::string& name) {
  for (const auto kind : {estimator::FittingKind::kPump, estimator::FittingKind::kService}) {
    if (name == estimator::Name(kind)) return kind;
  }
  return estimator::FittingKind::kValve;
}

std::vector<estimator::Fitting> MakeFittings(const NetworkParams& params, const Network& network) {
  std::vector<estimator::Fitting> fittings;
  for (std::size_t i = 0; i < params.fittings.size(); ++i) {
    const FittingEntry& entry = params.fittings[i];
    const std::string key = "network.fittings[" + std::to_string(i) + "]";
    RequirePlainId(entry.id, key + ".id");
    const int pipe = network.RequirePipe(entry.pipe, key + ".pipe");
    const double length_m = network.pipe(pipe).length_m;
    if (entry.s_m > length_m) {
      throw InputError("the fitting lies at " + FormatNumber(entry.s_m) + " m, beyond the pipe's range [0, " +
                           FormatNumber(length_m) + "] m",
                       key + ".s_m");
    }
    fittings.push_back({FittingKindOf(entry.kind), entry.id, pipe, entry.s_m});
  }
  return fittings;
}

int ResolveNode(const Network& network, const std::string& id, const std::string& key_path) {
  if (id.empty()) throw InputError("the node is missing; name a node of the network", key_path);
  return network.RequireNode(id, key_path);
}

}  // namespace piperun::scenarios
