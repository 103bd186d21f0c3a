#include "sim/network/drained_part.h"

#include <algorithm>
#include <numeric>

#include "sim/network/junction_outflow.h"

namespace piperun::sim {
namespace {

/// Which connected part each node belongs to: the sets of a union-find forest over the open links.
class OpenParts {
 public:
  OpenParts(const HydraulicModel& model, const HydraulicState& state)
      : parent_(static_cast<std::size_t>(model.node_count())) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int link = 0; link < model.link_count(); ++link) {
      if (!IsClosed(state.status[link])) parent_[Find(model.From(link))] = Find(model.To(link));
    }
  }
  int Find(int node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<bool> FindDrained(const HydraulicModel& model, const HydraulicState& state) {
  const std::vector<bool> supplied = FindSupplied(model, state);
  std::vector<bool> drained(static_cast<std::size_t>(model.junction_count()));
  if (std::find(supplied.begin(), supplied.end(), false) == supplied.end()) return drained;
  OpenParts parts(model, state);
  std::vector<bool> fed(supplied.size()), open(supplied.size());
  for (int i = 0; i < model.junction_count(); ++i) {
    if (state.demand_m3_s[i] < 0) fed[parts.Find(i)] = true;
    if (state.demand_m3_s[i] > 0) open[parts.Find(i)] = true;
  }
  for (const Outlet& outlet : FindOutlets(model)) {
    if (outlet.coefficient > 0) open[parts.Find(outlet.junction)] = true;
  }
  for (int i = 0; i < model.junction_count(); ++i) {
    drained[i] = !supplied[i] && open[parts.Find(i)] && !fed[parts.Find(i)];
  }
  return drained;
}

std::vector<int> DropDrainedDemands(const std::vector<bool>& drained, HydraulicState& state) {
  std::vector<int> dropped;
  for (std::size_t i = 0; i < drained.size(); ++i) {
    if (!drained[i] || state.demand_m3_s[i] == 0) continue;
    state.demand_m3_s[i] = state.delivered_m3_s[i] = 0;
    dropped.push_back(static_cast<int>(i));
  }
  return dropped;
}

void SettleDrained(const HydraulicModel& model, const std::vector<bool>& drained, HydraulicState& state) {
  for (int i = 0; i < model.junction_count(); ++i) {
    if (!drained[i]) continue;
    state.head_m[i] = model.Elevation_m(i);
    state.delivered_m3_s[i] = state.emitter_m3_s[i] = 0;
    state.fixed_leak_m3_s[i] = state.variable_leak_m3_s[i] = 0;
  }
  const auto is_dry = [&](int node) { return node < model.junction_count() && drained[node]; };
  for (int link = 0; link < model.link_count(); ++link) {
    if (is_dry(model.From(link)) || is_dry(model.To(link))) state.flow_m3_s[link] = 0;
  }
}

}  // namespace piperun::sim
