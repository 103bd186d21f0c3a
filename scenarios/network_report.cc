#include "scenarios/network_report.h"

#include <array>

#include "scenarios/run.h"

namespace piperun::scenarios {
namespace {

using sim::HydraulicModel;
using sim::HydraulicState;

constexpr std::array<const char*, 7> kValveKinds{"prv", "psv", "pbv", "fcv", "tcv", "gpv", "pcv"};

void Keep(sim::HydraulicSimulation& simulation, NetworkSolution& solution) {
  sim::SolveReport report = simulation.report();
  if (report.end != sim::SolveReport::End::kSingular) {
    simulation.solver().FindHeadError(simulation.state(), report);
  }
  solution.steps.push_back({simulation.time_s(), simulation.IsReportTime(), report, simulation.state()});
}

}  // namespace

NetworkSolution SolveNetwork(const HydraulicModel& model, const NetworkOptions& options) {
  NetworkSolution solution;
  sim::HydraulicSimulation simulation(model);
  do {
    if (options.stop && *options.stop) throw Interrupted();
    const bool converged = simulation.Solve().converged();
    if (!converged && solution.converged()) {
      solution.problem =
          "at " + std::to_string(simulation.time_s()) + " s: " + sim::Describe(simulation.report(), model);
    }
    const bool is_last_chance = !converged && solution.steps.empty();
    if (!options.extended || simulation.IsReportTime() || is_last_chance) Keep(simulation, solution);
    if (options.progress) options.progress(simulation.time_s());
  } while (options.extended && simulation.Advance());
  return solution;
}

std::vector<NodeReport> ReportNodes(const HydraulicModel& model, const HydraulicState& state) {
  std::vector<NodeReport> nodes(static_cast<std::size_t>(model.node_count()));
  for (int i = 0; i < model.node_count(); ++i) {
    nodes[i].head_m = state.head_m[i];
    const bool is_reservoir = i >= model.junction_count() && i < model.first_tank();
    nodes[i].pressure_m = is_reservoir ? 0 : state.head_m[i] - model.Elevation_m(i);
    if (i < model.junction_count()) nodes[i].demand_m3_s = state.Outflow_m3_s(i);
  }
  for (int link = 0; link < model.link_count(); ++link) {
    if (sim::IsClosed(state.status[link])) continue;
    const int from = model.From(link), to = model.To(link);
    if (from >= model.junction_count()) nodes[from].demand_m3_s -= state.flow_m3_s[link];
    if (to >= model.junction_count()) nodes[to].demand_m3_s += state.flow_m3_s[link];
  }
  return nodes;
}

std::vector<LinkReport> ReportLinks(const HydraulicModel& model, const HydraulicState& state) {
  std::vector<LinkReport> links(static_cast<std::size_t>(model.link_count()));
  for (int i = 0; i < model.link_count(); ++i) {
    links[i].flow_m3_s = sim::IsClosed(state.status[i]) ? 0 : state.flow_m3_s[i];
    links[i].velocity_m_s = sim::CalcSpeed_m_s(model, state, i);
    links[i].head_loss_m = state.head_m[model.From(i)] - state.head_m[model.To(i)];
  }
  return links;
}

const char* NodeKind(const HydraulicModel& model, int node) {
  if (node < model.junction_count()) return "junction";
  return node < model.first_tank() ? "reservoir" : "tank";
}

const char* LinkKind(const HydraulicModel& model, int link) {
  if (link < model.first_pump()) return "pipe";
  if (link < model.first_valve()) return "pump";
  return kValveKinds[static_cast<std::size_t>(model.valves[link - model.first_valve()].kind)];
}

}  // namespace piperun::scenarios
