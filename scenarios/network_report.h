#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/network/simulation.h"
#include "sim/network/water_way.h"

namespace piperun::scenarios {

/// The instants of a network that are told of.
struct NetworkSolution {
  std::vector<sim::HydraulicStep> steps;  ///< t = 0, or every reporting step; never empty
  /// The first instant that has no solution ("at 3600 s: did not converge ..."); empty: all converged.
  std::string problem;

  bool converged() const { return problem.empty(); }
};

struct NetworkOptions {
  bool extended = false;  ///< the whole period, not t = 0 only
  std::function<void(std::int64_t time_s)> progress;
  const std::atomic<bool>* stop = nullptr;  ///< set: Interrupted is thrown
};

/// Solves a network at t = 0 or over its whole period. Not converging is a value.
NetworkSolution SolveNetwork(const sim::HydraulicModel& model, const NetworkOptions& options);

/// A node at an instant, as EPANET reports it.
struct NodeReport {
  double head_m = 0;
  double pressure_m = 0;  ///< head above the elevation; of a tank: its level; of a reservoir: 0
  /// Everything that leaves the pipes here: customers, emitters and leaks of a junction; what flows into a
  /// reservoir or tank, which is negative while it feeds the network.
  double demand_m3_s = 0;
};
std::vector<NodeReport> ReportNodes(const sim::HydraulicModel& model, const sim::HydraulicState& state);

/// A link at an instant.
struct LinkReport {
  double flow_m3_s = 0;     ///< from -> to; 0 when closed
  double velocity_m_s = 0;  ///< >= 0; 0 in a pump, which has no bore
  double head_loss_m = 0;   ///< head at `from` minus head at `to`: negative in a running pump
};
std::vector<LinkReport> ReportLinks(const sim::HydraulicModel& model, const sim::HydraulicState& state);

/// "junction", "reservoir", "tank"; "pipe", "pump", "prv" ... "pcv".
const char* NodeKind(const sim::HydraulicModel& model, int node);
const char* LinkKind(const sim::HydraulicModel& model, int link);

/// What was asked about a ball and its ways, at the first instant told of.
struct BallQuestion {
  double ball_diameter_m = 0;  ///< 0: the water itself
  bool ask_passage = false;
  std::optional<int> from, to;  ///< nodes; `to` only with `from`
};

/// {"converged", "iterations" (of the first instant), "steps": [{"time_s", "nodes": {ID: {"head_m",
/// "demand_m3_s"}}, "links": {ID: {"flow_m3_s", "velocity_m_s", "status": "open" | "closed" | "active"}}}]},
/// SI; demand and flow as in NodeReport and LinkReport. When asked: "ball" (diameter_m, links: ID to "passes"
/// or what is in the way) and "routes" (from, reachable: ID to time_s and distance_m, main_flow, fastest).
std::string WriteNetworkJson(const sim::HydraulicModel& model, const NetworkSolution& solution,
                             const BallQuestion& question);

/// One row per node and link and instant; columns time_s, element (node or link), id, kind, then for nodes
/// elevation_m, head_m, pressure_m, demand_m3_s, for links from, to, flow_m3_s, velocity_m_s, head_loss_m,
/// status; what an element has not is empty.
std::string WriteNetworkCsv(const sim::HydraulicModel& model, const NetworkSolution& solution);

}  // namespace piperun::scenarios
