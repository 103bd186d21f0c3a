#include "sim/network/hydraulic_state.h"

#include "base/number.h"

namespace piperun::sim {
namespace {

bool IsSource(const HydraulicModel& model, const HydraulicState& state, int node) {
  if (node >= model.junction_count()) return true;
  for (std::size_t i = 0; i < model.valves.size(); ++i) {
    const ValveLink& valve = model.valves[i];
    if (state.status[static_cast<std::size_t>(model.first_valve()) + i] != LinkStatus::kActive) continue;
    if (valve.kind == ValveKind::kPressureReducing && valve.to == node) return true;
    if (valve.kind == ValveKind::kPressureSustaining && valve.from == node) return true;
  }
  return false;
}

std::string WithUnit(double value, const char* unit) { return FormatNumber(value) + " " + unit; }

}  // namespace

std::string Describe(const SolveReport& report, const HydraulicModel& model) {
  const std::string iterations = std::to_string(report.iterations) + " iterations";
  if (report.converged()) return "converged in " + iterations;
  if (report.end == SolveReport::End::kSingular) {
    return "no solution: the equations are singular at node '" + model.NodeId(report.worst_node) + "'";
  }
  std::string text = "did not converge in " + iterations + ": flows still change by " +
                     WithUnit(100 * report.relative_flow_change, "%");
  if (report.worst_link >= 0) {
    text += ", the head loss of link '" + model.LinkId(report.worst_link) + "' is off by " +
            WithUnit(report.max_head_error_m, "m");
  }
  if (report.worst_node >= 0) {
    text += ", the flows at node '" + model.NodeId(report.worst_node) + "' by " +
            WithUnit(report.max_imbalance_m3_s, "m3/s");
  }
  return text;
}

std::vector<bool> FindSupplied(const HydraulicModel& model, const HydraulicState& state) {
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(model.node_count()));
  for (int link = 0; link < model.link_count(); ++link) {
    if (IsClosed(state.status[link])) continue;
    neighbours[model.From(link)].push_back(model.To(link));
    neighbours[model.To(link)].push_back(model.From(link));
  }
  std::vector<bool> supplied(neighbours.size());
  std::vector<int> open;
  for (int node = 0; node < model.node_count(); ++node) {
    if (IsSource(model, state, node)) open.push_back(node);
  }
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    if (supplied[node]) continue;
    supplied[node] = true;
    open.insert(open.end(), neighbours[node].begin(), neighbours[node].end());
  }
  return supplied;
}

}  // namespace piperun::sim
