#pragma once

#include <vector>

#include "sim/network/head_loss.h"
#include "sim/network/hydraulic_state.h"
#include "sim/network/model.h"

namespace piperun::sim {

/// One way out of a junction whose flow depends on pressure, as a fictitious pipe to the ground: its head
/// loss at a flow is the pressure head that drives this flow.
struct Outlet {
  enum class Kind { kEmitter, kFixedLeak, kVariableLeak, kDemand };
  Kind kind = Kind::kEmitter;
  int junction = 0;
  double coefficient = 0;   ///< q = coefficient h^(1/exponent)
  double exponent = 2;      ///< h = (q / coefficient)^exponent
  double base_head_m = 0;   ///< head at which nothing flows
  double head_range_m = 0;  ///< demand: from nothing to all of it
};

/// The outlets of a network: emitters; leaks of junctions and half of each pipe's; demands, when
/// pressure-driven.
std::vector<Outlet> FindOutlets(const HydraulicModel& model);

/// Pressure head that drives `flow` out, and its slope. `full_m3_s` is the whole demand (demands only).
HeadLoss CalcOutletHead(const Outlet& outlet, double flow_m3_s, double full_m3_s,
                        const HydraulicOptions& options);

/// The flow at a head by the outlet's own law, q = C h^(1/n); what iterations must come to.
double CalcOutletFlow_m3_s(const Outlet& outlet, double head_m, double full_m3_s);

/// The flow of an outlet within a state.
double& OutletFlow(const Outlet& outlet, HydraulicState& state);
double OutletFlow(const Outlet& outlet, const HydraulicState& state);

}  // namespace piperun::sim
