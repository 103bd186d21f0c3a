#include "sim/network/solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/number.h"
#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

constexpr double kBalanced_m3_s = 1e-10;
constexpr int kBalanceTrials = 20;
constexpr double kMostTrickle_m3_s = 2e-6;  // through a closed link; more feeds a part that is cut off
constexpr double kDampedStep = 0.6;
constexpr double kGreatestDemandStep = 0.4;

std::vector<std::pair<int, int>> GatherEnds(const HydraulicModel& model) {
  std::vector<std::pair<int, int>> ends;
  ends.reserve(static_cast<std::size_t>(model.link_count()));
  for (int link = 0; link < model.link_count(); ++link) ends.emplace_back(model.From(link), model.To(link));
  return ends;
}

}  // namespace

HydraulicSolver::HydraulicSolver(const HydraulicModel& model)
    : model_(model),
      junction_count_(model.junction_count()),
      first_pump_(model.first_pump()),
      first_valve_(model.first_valve()),
      link_count_(model.link_count()),
      laws_(model),
      statuses_(model_, laws_),
      outlets_(FindOutlets(model)),
      ends_(GatherEnds(model)),
      system_(model.junction_count(), ends_),
      losses_(ends_.size()),
      predicted_m3_s_(ends_.size()),
      conductance_m2_s_(ends_.size()),
      outlet_predicted_m3_s_(outlets_.size()),
      outlet_conductance_m2_s_(outlets_.size()),
      excess_m3_s_(static_cast<std::size_t>(model.node_count())) {}

/// A pump of constant power has no law for flow backwards: it is halved instead.
double HydraulicSolver::LimitStep(int link, double flow_m3_s, double step_m3_s) const {
  const int pump = link - first_pump_;
  const bool is_power_pump = pump >= 0 && link < first_valve_ && laws_.IsConstantPower(pump);
  return is_power_pump && -step_m3_s > flow_m3_s ? -flow_m3_s / 2 : step_m3_s;
}

void HydraulicSolver::UpdateOutletFlow(HydraulicState& state, std::size_t i, double relaxation,
                                       FlowChange& change) {
  const Outlet& outlet = outlets_[i];
  const double full = state.demand_m3_s[outlet.junction];
  const bool is_demand = outlet.kind == Outlet::Kind::kDemand;
  if (IsIdle(outlet, state)) return;
  double& flow = OutletFlow(outlet, state);
  double step = relaxation * (outlet_predicted_m3_s_[i] +
                              outlet_conductance_m2_s_[i] * system_.Solution(outlet.junction) - flow);
  if (is_demand) step = std::clamp(step, -kGreatestDemandStep * full, kGreatestDemandStep * full);
  change.Apply(step, flow);
}

HydraulicSolver::FlowChange HydraulicSolver::UpdateFlows(HydraulicState& state, double relaxation) {
  FlowChange change;
  for (int link = 0; link < first_pump_; ++link) {
    change.Apply(CalcStep_m3_s(state, link, relaxation), state.flow_m3_s[link]);
  }
  for (int link = first_pump_; link < link_count_; ++link) {
    double& flow = state.flow_m3_s[link];
    change.Apply(LimitStep(link, flow, CalcStep_m3_s(state, link, relaxation)), flow);
  }
  for (std::size_t i = 0; i < outlets_.size(); ++i) UpdateOutletFlow(state, i, relaxation, change);
  for (int i = 0; i < junction_count_; ++i) state.head_m[i] += system_.Solution(i);
  return change;
}

/// An active control valve whose setting makes the equations contradict each other is opened for good.
bool HydraulicSolver::HandOverValve(HydraulicState& state) const {
  for (int link = first_valve_; link < link_count_; ++link) {
    const auto& [from, to] = ends_[link];
    if (from != system_.bad_junction() && to != system_.bad_junction()) continue;
    if (!IsControlled(state, link) || state.status[link] != LinkStatus::kActive) return false;
    state.status[link] = IsPinned(state, link) ? LinkStatus::kPressureShort : LinkStatus::kFlowShort;
    return true;
  }
  return false;
}

/// One Newton step. False when the equations have no solution.
bool HydraulicSolver::Iterate(HydraulicState& state, double relaxation, SolveReport& report,
                              FlowChange& change) {
  Assemble(state);
  while (!system_.Solve()) {
    if (!HandOverValve(state)) return false;
    Assemble(state);
  }
  change = UpdateFlows(state, relaxation);
  const double least_total = model_.options.accuracy * epanet::kCubicFoot_m3;
  report.relative_flow_change = change.total_m3_s > least_total ? change.changed_m3_s / change.total_m3_s
                                                                : change.changed_m3_s / epanet::kCubicFoot_m3;
  return true;
}

/// Whether outlets flow by their laws. Under suction, as in a part that a closed link cuts off from all water
/// but not from a customer, the law is no flow, and what the barrier against flow backwards lets in is
/// allowed.
bool HydraulicSolver::OutletsConverged(const HydraulicState& state) const {
  for (const Outlet& outlet : outlets_) {
    const double full = state.demand_m3_s[outlet.junction];
    const bool is_demand = outlet.kind == Outlet::Kind::kDemand;
    if (outlet.kind == Outlet::Kind::kEmitter || IsIdle(outlet, state)) continue;
    const double law = CalcOutletFlow_m3_s(outlet, state.head_m[outlet.junction], full);
    const double suction_m = std::max(0.0, outlet.base_head_m - state.head_m[outlet.junction]);
    const double allowed = epanet::kOutflowTolerance_m3_s + suction_m / epanet::kBarrierSlope_s_m2 +
                           (is_demand ? 0 : epanet::kOutflowRelativeTolerance * law);
    if (std::abs(law - OutletFlow(outlet, state)) > allowed) return false;
  }
  return true;
}

bool HydraulicSolver::IsConverged(const HydraulicState& state, const SolveReport& report,
                                  const FlowChange& change) {
  const HydraulicOptions& options = model_.options;
  if (report.relative_flow_change > options.accuracy) return false;
  if (options.head_error_m > 0) {
    SolveReport error;
    FindHeadError(state, error);
    if (error.max_head_error_m > options.head_error_m) return false;
  }
  if (options.flow_change_m3_s > 0 && change.greatest_m3_s > options.flow_change_m3_s) return false;
  return OutletsConverged(state);
}

void HydraulicSolver::FindHeadError(const HydraulicState& state, SolveReport& report) {
  laws_.CalcLosses(state, losses_);
  report.max_head_error_m = 0;
  report.worst_link = -1;
  for (int link = 0; link < link_count_; ++link) {
    if (IsClosed(state.status[link]) || IsControlled(state, link)) continue;
    const double drop = state.head_m[ends_[link].first] - state.head_m[ends_[link].second];
    const double error = std::abs(drop - losses_[link].loss_m);
    if (!(error <= report.max_head_error_m)) {
      report.max_head_error_m = error;
      report.worst_link = link;
    }
  }
}

void HydraulicSolver::FindImbalance(const HydraulicState& state, SolveReport& report) {
  std::fill(excess_m3_s_.begin(), excess_m3_s_.end(), 0.0);
  for (std::size_t link = 0; link < ends_.size(); ++link) {
    excess_m3_s_[ends_[link].first] -= state.flow_m3_s[link];
    excess_m3_s_[ends_[link].second] += state.flow_m3_s[link];
  }
  report.max_imbalance_m3_s = 0;
  report.worst_node = -1;
  for (int i = 0; i < junction_count_; ++i) {
    const double imbalance = std::abs(excess_m3_s_[i] - state.Outflow_m3_s(i));
    if (!(imbalance <= report.max_imbalance_m3_s)) {
      report.max_imbalance_m3_s = imbalance;
      report.worst_node = i;
    }
  }
}

/// The equations let a trickle through closed links, and a pinned valve passes what its node needed one
/// iteration ago. Closes the former, sets the latter to what the node needs now.
void HydraulicSolver::SettleFlows(HydraulicState& state) {
  for (std::size_t link = 0; link < ends_.size(); ++link) {
    double& flow = state.flow_m3_s[link];
    if (IsClosed(state.status[link]) && std::abs(flow) < kMostTrickle_m3_s) flow = 0;
  }
  if (!HasPinned(state)) return;
  CalcExcess(state);
  for (int link = first_valve_; link < link_count_; ++link) {
    if (IsPinned(state, link)) state.flow_m3_s[link] = PinnedFlow_m3_s(link);
  }
}

/// Balances mass by changing flows along the last iteration's linear equations: no new slopes, only
/// right-hand sides. Heads stay those at which the iterations ended, as EPANET reports them.
void HydraulicSolver::Balance(HydraulicState& state, SolveReport& report) {
  for (int i = 0; i <= kBalanceTrials; ++i) {
    SettleFlows(state);
    FindImbalance(state, report);
    if (report.max_imbalance_m3_s <= kBalanced_m3_s || i == kBalanceTrials) return;
    for (int node = 0; node < junction_count_; ++node) {
      system_.SetRight(node, excess_m3_s_[node] - state.Outflow_m3_s(node));
    }
    system_.SolveAgain();
    for (int link = 0; link < link_count_; ++link) {
      if (!IsClosed(state.status[link]))
        state.flow_m3_s[link] += conductance_m2_s_[link] * system_.Difference(link);
    }
    for (std::size_t k = 0; k < outlets_.size(); ++k) {
      if (IsIdle(outlets_[k], state)) continue;
      OutletFlow(outlets_[k], state) += outlet_conductance_m2_s_[k] * system_.Solution(outlets_[k].junction);
    }
  }
}

void HydraulicSolver::CalcInflows(HydraulicState& state) const {
  std::fill(state.inflow_m3_s.begin(), state.inflow_m3_s.end(), 0.0);
  const int n = junction_count_;
  for (std::size_t link = 0; link < ends_.size(); ++link) {
    if (IsClosed(state.status[link])) continue;
    if (ends_[link].first >= n) state.inflow_m3_s[ends_[link].first - n] -= state.flow_m3_s[link];
    if (ends_[link].second >= n) state.inflow_m3_s[ends_[link].second - n] += state.flow_m3_s[link];
  }
}

/// True when a link or a pressure control changed a status.
bool HydraulicSolver::UpdateStatuses(HydraulicState& state) const {
  const bool links_changed = statuses_.UpdateLinks(state);
  return statuses_.UpdatePressureControls(state) || links_changed;
}

/// What is told of a solution when the iterations have ended, however they ended.
void HydraulicSolver::Finish(HydraulicState& state, SolveReport& report) {
  CalcInflows(state);
  Balance(state, report);
  if (!report.converged() || model_.options.head_error_m > 0) FindHeadError(state, report);
}

SolveReport HydraulicSolver::Solve(HydraulicState& state) {
  const HydraulicOptions& options = model_.options;
  const int max_trials = options.max_trials + std::max(0, options.extra_trials);
  SolveReport report;
  FlowChange change;
  int next_check = options.check_frequency;
  double relaxation = 1;
  while (report.iterations < max_trials) {
    ++report.iterations;
    if (!Iterate(state, relaxation, report, change)) {
      report.end = SolveReport::End::kSingular;
      report.worst_node = system_.bad_junction();
      return report;
    }
    const bool damp = options.damp_limit > 0 && report.relative_flow_change <= options.damp_limit;
    relaxation = damp ? kDampedStep : 1;
    const bool valves_changed = (options.damp_limit == 0 || damp) && statuses_.UpdatePressureValves(state);
    if (IsConverged(state, report, change)) {
      report.end = SolveReport::End::kConverged;
      if (report.iterations > options.max_trials || (!UpdateStatuses(state) && !valves_changed)) break;
      report.end = SolveReport::End::kUnbalanced;
      next_check = report.iterations + options.check_frequency;
    } else if (report.iterations <= options.max_check && report.iterations == next_check) {
      statuses_.UpdateLinks(state);
      next_check += options.check_frequency;
    }
  }
  Finish(state, report);
  return report;
}

}  // namespace piperun::sim
