#include "scenarios/wall_feature_list.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "scenarios/network_params.h"

namespace piperun::scenarios {
namespace {

constexpr std::string_view kEveryPipe = "*";

bool IsOpen(const sim::Bore& bore, int pipe) { return bore.open(pipe) && bore.network().pipe(pipe).passable; }

int FindPipe(const Network& network, const std::string& id) {
  try {
    return network.RequirePipe(id, "pipe");
  } catch (const InputError& e) {
    throw InputError(e.problem() + "; \"*\" stands for every pipe open to the ball", "pipe");
  }
}

std::vector<int> FindPipes(const sim::Bore& bore, const std::string& id) {
  std::vector<int> pipes;
  if (id != kEveryPipe) {
    pipes.push_back(FindPipe(bore.network(), id));
    if (!IsOpen(bore, pipes.front())) {
      throw InputError("pipe '" + id + "' is shut to the ball; choose one that it can enter", "pipe");
    }
    return pipes;
  }
  for (std::size_t i = 0; i < bore.network().pipes().size(); ++i) {
    if (IsOpen(bore, static_cast<int>(i))) pipes.push_back(static_cast<int>(i));
  }
  return pipes;
}

std::vector<sim::WallFeature> MakeEntry(const Scenario& scenario, const WallFeatureEntry& entry,
                                        const sim::Bore& bore) {
  const auto& kinds = sim::WallFeatureKinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == entry.kind.kind(); });
  Demand(kind != kinds.end(), "a kind's name was checked when the scenario was read");
  std::vector<sim::WallFeature> made;
  for (const int pipe : FindPipes(bore, entry.pipe)) {
    const RandomStream random(static_cast<std::uint64_t>(scenario.seed),
                              "wall_features." + entry.id + "." + bore.network().pipe(pipe).id,
                              static_cast<std::uint64_t>(scenario.run));
    const Vector3d gravity_W(0, 0, -scenario.gravity_m_s2);
    for (sim::WallFeature& feature :
         kind->make(entry.kind.params(), {bore, pipe, scenario.ball.radius_m, gravity_W, random})) {
      made.push_back(std::move(feature));
    }
  }
  return made;
}

void Append(std::vector<sim::WallFeature> made, const WallFeatureEntry& entry, WallFeatureList& list) {
  const bool several = made.size() > 1;
  for (std::size_t k = 0; k < made.size(); ++k) {
    const std::string id = several ? entry.id + "[" + std::to_string(k + 1) + "]" : entry.id;
    list.labels.push_back({id, entry.kind.kind(), made[k].pipe, made[k].s_m});
    list.features.push_back(std::move(made[k]));
  }
}

}  // namespace

WallFeatureList MakeWallFeatures(const Scenario& scenario, const sim::Bore& bore) {
  WallFeatureList list;
  const auto& entries = scenario.wall_features;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string key = "wall_features[" + std::to_string(i) + "]";
    RequirePlainId(entries[i].id, key + ".id");
    const auto same = [&](const WallFeatureEntry& other) { return other.id == entries[i].id; };
    if (std::any_of(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(i), same)) {
      throw InputError("'" + entries[i].id + "' is used twice; ids must be unique", key + ".id");
    }
    try {
      Append(MakeEntry(scenario, entries[i], bore), entries[i], list);
    } catch (const InputError& e) {
      throw InputError(e.problem(), key + "." + e.key_path());
    }
  }
  return list;
}

}  // namespace piperun::scenarios
