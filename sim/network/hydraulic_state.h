#pragma once

#include <string>
#include <vector>

#include "sim/network/model.h"

namespace piperun::sim {

/// The water of a network at one instant: what is imposed (demands, heads of reservoirs and tanks, settings)
/// and what the solver finds. A value: copy it to start warm, keep it to go back.
struct HydraulicState {
  std::vector<double> head_m;              ///< per node
  std::vector<double> demand_m3_s;         ///< per junction, what customers want
  std::vector<double> delivered_m3_s;      ///< per junction, what they get (pressure-driven: may be less)
  std::vector<double> emitter_m3_s;        ///< per junction
  std::vector<double> fixed_leak_m3_s;     ///< per junction, through the part of the leaks that does not grow
  std::vector<double> variable_leak_m3_s;  ///< per junction, through the part that grows with pressure
  std::vector<double> inflow_m3_s;         ///< per reservoir and tank, net, as the iterations left it
  std::vector<double> flow_m3_s;           ///< per link, from -> to
  std::vector<LinkStatus> status;          ///< per link
  std::vector<double> setting;             ///< per link: pump speed, valve setting; NaN: the status is fixed

  /// Everything that leaves the network at a junction.
  double Outflow_m3_s(int junction) const {
    return delivered_m3_s[junction] + emitter_m3_s[junction] + fixed_leak_m3_s[junction] +
           variable_leak_m3_s[junction];
  }
};

/// How a solution came about and how good it is.
struct SolveReport {
  enum class End {
    kConverged,
    kUnbalanced,  ///< out of trials
    kSingular,    ///< the equations have no solution at `worst_node`
  };
  End end = End::kUnbalanced;
  int iterations = 0;
  double relative_flow_change = 0;  ///< sum |dQ| / sum |Q| of the last iteration
  double max_head_error_m = 0;  ///< greatest |head difference - head loss of the flow|, at `worst_link`; see
                                ///< HydraulicSolver::FindHeadError
  int worst_link = -1;
  double max_imbalance_m3_s = 0;  ///< greatest |inflow - outflow| of a junction, at `worst_node`
  int worst_node = -1;

  bool converged() const { return end == End::kConverged; }
};

/// "did not converge in 200 iterations: head loss of link 'P3' off by 0.2 m".
std::string Describe(const SolveReport& report, const HydraulicModel& model);

/// Nodes from which an open way leads to a reservoir or tank (an active PRV's or PSV's pinned node counts as
/// one). Elsewhere the equations hold but heads mean nothing.
std::vector<bool> FindSupplied(const HydraulicModel& model, const HydraulicState& state);

}  // namespace piperun::sim
