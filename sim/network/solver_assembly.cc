#include "sim/network/solver.h"

#include <algorithm>
#include <cmath>

#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

bool PinsPressure(ValveKind kind) {
  return kind == ValveKind::kPressureReducing || kind == ValveKind::kPressureSustaining;
}

}  // namespace

/// Outlets with nothing to deliver stay out of the equations.
bool HydraulicSolver::IsIdle(const Outlet& outlet, const HydraulicState& state) const {
  return outlet.kind == Outlet::Kind::kDemand ? state.demand_m3_s[outlet.junction] <= 0
                                              : outlet.coefficient == 0;
}

bool HydraulicSolver::IsControlled(const HydraulicState& state, int link) const {
  const int valve = link - first_valve_;
  if (valve < 0 || std::isnan(state.setting[link])) return false;
  const ValveKind kind = model_.valves[valve].kind;
  return PinsPressure(kind) || kind == ValveKind::kFlowControl;
}

bool HydraulicSolver::IsPinned(const HydraulicState& state, int link) const {
  const int valve = link - first_valve_;
  return valve >= 0 && PinsPressure(model_.valves[valve].kind) && !std::isnan(state.setting[link]) &&
         state.status[link] == LinkStatus::kActive;
}

bool HydraulicSolver::HasPinned(const HydraulicState& state) const {
  for (int link = first_valve_; link < link_count_; ++link) {
    if (IsPinned(state, link)) return true;
  }
  return false;
}

/// What comes to each node by all links but pinned valves, minus what leaves it: what a pinned valve must
/// carry.
void HydraulicSolver::CalcExcess(const HydraulicState& state) {
  std::fill(excess_m3_s_.begin(), excess_m3_s_.end(), 0.0);
  for (int link = 0; link < link_count_; ++link) {
    if (IsPinned(state, link)) continue;
    const bool passes_setting = IsControlled(state, link) && state.status[link] == LinkStatus::kActive;
    const double flow = passes_setting ? state.setting[link] : state.flow_m3_s[link];
    excess_m3_s_[ends_[link].first] -= flow;
    excess_m3_s_[ends_[link].second] += flow;
  }
  for (int i = 0; i < junction_count_; ++i) excess_m3_s_[i] -= state.Outflow_m3_s(i);
}

void HydraulicSolver::Assemble(const HydraulicState& state) {
  laws_.CalcLosses(state, losses_);
  system_.Clear();
  if (HasPinned(state)) CalcExcess(state);
  for (int i = 0; i < junction_count_; ++i) {
    if (!model_.options.pressure_driven || state.demand_m3_s[i] <= 0)
      system_.AddRight(i, -state.delivered_m3_s[i]);
  }
  AssembleOutlets(state);
  AssembleLinks(state);
}

/// An active FCV passes its setting whatever the heads.
void HydraulicSolver::AssembleFlowControl(const HydraulicState& state, int link) {
  const double conductance = 1 / epanet::kClosedSlope_s_m2;
  const double drop = state.head_m[ends_[link].first] - state.head_m[ends_[link].second];
  PredictLink(link, state.setting[link] + conductance * drop, conductance);
}

void HydraulicSolver::AssembleLinks(const HydraulicState& state) {
  for (int link = 0; link < first_valve_; ++link) AssembleLawful(state, link);
  for (int link = first_valve_; link < link_count_; ++link) {
    if (IsPinned(state, link)) {
      AssemblePinned(state, link);
    } else if (IsControlled(state, link) && state.status[link] == LinkStatus::kActive) {
      AssembleFlowControl(state, link);
    } else {
      AssembleLawful(state, link);
    }
  }
}

/// What a pinned valve must pass, given the excess of its nodes.
double HydraulicSolver::PinnedFlow_m3_s(int link) const {
  const bool reduces = model_.valves[link - first_valve_].kind == ValveKind::kPressureReducing;
  return reduces ? -excess_m3_s_[ends_[link].second] : excess_m3_s_[ends_[link].first];
}

/// An active PRV or PSV: one node's head is its setting, and what flows is what this node needs or has to
/// spare.
void HydraulicSolver::AssemblePinned(const HydraulicState& state, int link) {
  const auto& [from, to] = ends_[link];
  const bool reduces = model_.valves[link - first_valve_].kind == ValveKind::kPressureReducing;
  const int pinned = reduces ? to : from, other = reduces ? from : to;
  const double goal_m = model_.junctions[pinned].elevation_m + state.setting[link];
  const double through = PinnedFlow_m3_s(link);
  predicted_m3_s_[link] = through;
  conductance_m2_s_[link] = 0;
  system_.AddDiagonal(pinned, epanet::kPinWeight_m2_s);
  system_.AddRight(pinned, epanet::kPinWeight_m2_s * (goal_m - state.head_m[pinned]));
  if (through > 0) system_.AddRight(other, reduces ? -through : through);
  if (!reduces) system_.AddLink(link, 1 / epanet::kClosedSlope_s_m2, 0);  // keeps the far side supported
}

void HydraulicSolver::AssembleOutlets(const HydraulicState& state) {
  for (std::size_t i = 0; i < outlets_.size(); ++i) {
    const Outlet& outlet = outlets_[i];
    const double full = state.demand_m3_s[outlet.junction];
    if (IsIdle(outlet, state)) continue;
    const double flow = OutletFlow(outlet, state);
    const HeadLoss head = CalcOutletHead(outlet, flow, full, model_.options);
    const double drop = state.head_m[outlet.junction] - outlet.base_head_m;
    outlet_conductance_m2_s_[i] = 1 / head.slope_s_m2;
    outlet_predicted_m3_s_[i] = flow + (drop - head.loss_m) / head.slope_s_m2;
    system_.AddDiagonal(outlet.junction, outlet_conductance_m2_s_[i]);
    system_.AddRight(outlet.junction, -outlet_predicted_m3_s_[i]);
  }
}

}  // namespace piperun::sim
