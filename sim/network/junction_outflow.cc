#include "sim/network/junction_outflow.h"

#include <algorithm>
#include <cmath>

#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

constexpr double kLeastFlow_m3_s = 1e-15;  // where a law with n < 1 would be vertical

/// Keeps a flow above a limit: beyond it the head falls steeply. `excess` is flow minus limit. The rounded
/// corner is EPANET's.
void AddLowerBarrier(double excess_m3_s, HeadLoss& head) {
  const double a = epanet::kBarrierSlope_s_m2 * excess_m3_s;
  const double b = std::hypot(a, epanet::kBarrierRounding_m);
  head.loss_m += (a - b) / 2;
  head.slope_s_m2 += epanet::kBarrierSlope_s_m2 / 2 * (1 - a / b);
}

void AddUpperBarrier(double excess_m3_s, HeadLoss& head) {
  const double a = epanet::kBarrierSlope_s_m2 * excess_m3_s;
  const double b = std::hypot(a, epanet::kBarrierRounding_m);
  head.loss_m += (a + b) / 2;
  head.slope_s_m2 += epanet::kBarrierSlope_s_m2 / 2 * (1 + a / b);
}

/// Leaks of the junctions, with half of the leakage of each pipe (all of it at its only junction).
std::vector<LeakCoefficients> GatherLeaks(const HydraulicModel& model) {
  std::vector<LeakCoefficients> leaks;
  for (const JunctionNode& junction : model.junctions) leaks.push_back(junction.leak);
  for (const PipeLink& pipe : model.pipes) {
    const bool from = pipe.from < model.junction_count(), to = pipe.to < model.junction_count();
    const double share = from && to ? 0.5 : 1;
    for (const int node : {pipe.from, pipe.to}) {
      if (node >= model.junction_count()) continue;
      leaks[node].fixed_m25_s += share * pipe.leakage.fixed_m25_s;
      leaks[node].variable_m15_s += share * pipe.leakage.variable_m15_s;
    }
  }
  return leaks;
}

std::vector<double> HydraulicState::*FindField(Outlet::Kind kind) {
  switch (kind) {
    case Outlet::Kind::kEmitter:
      return &HydraulicState::emitter_m3_s;
    case Outlet::Kind::kFixedLeak:
      return &HydraulicState::fixed_leak_m3_s;
    case Outlet::Kind::kVariableLeak:
      return &HydraulicState::variable_leak_m3_s;
    case Outlet::Kind::kDemand:
      break;
  }
  return &HydraulicState::delivered_m3_s;
}

}  // namespace

std::vector<Outlet> FindOutlets(const HydraulicModel& model) {
  const HydraulicOptions& options = model.options;
  const std::vector<LeakCoefficients> leaks = GatherLeaks(model);
  std::vector<Outlet> outlets;
  for (int i = 0; i < model.junction_count(); ++i) {
    const JunctionNode& junction = model.junctions[i];
    const auto add = [&](Outlet::Kind kind, double coefficient, double exponent) {
      if (coefficient > 0) outlets.push_back({kind, i, coefficient, exponent, junction.elevation_m, 0});
    };
    add(Outlet::Kind::kEmitter, junction.emitter, 1 / options.emitter_exponent);
    add(Outlet::Kind::kFixedLeak, leaks[i].fixed_m25_s, 2);
    add(Outlet::Kind::kVariableLeak, leaks[i].variable_m15_s, 2.0 / 3);
    if (options.pressure_driven) {
      outlets.push_back({Outlet::Kind::kDemand, i, 0, 1 / options.pressure_exponent,
                         junction.elevation_m + options.min_pressure_m,
                         options.required_pressure_m - options.min_pressure_m});
    }
  }
  return outlets;
}

HeadLoss CalcOutletHead(const Outlet& outlet, double flow_m3_s, double full_m3_s,
                        const HydraulicOptions& options) {
  const double n = outlet.exponent, q = std::max(std::abs(flow_m3_s), kLeastFlow_m3_s);
  if (outlet.kind == Outlet::Kind::kDemand) {
    const double slope = n * outlet.head_range_m * std::pow(q / full_m3_s, n - 1) / full_m3_s;
    HeadLoss head{slope * flow_m3_s / n, slope};
    AddLowerBarrier(flow_m3_s, head);
    AddUpperBarrier(flow_m3_s - full_m3_s, head);
    return head;
  }
  const double slope = n * std::pow(q / outlet.coefficient, n - 1) / outlet.coefficient;
  HeadLoss head{slope * flow_m3_s / n, slope};
  if (slope < options.least_slope_s_m2) {
    head = {options.least_slope_s_m2 / n * flow_m3_s, options.least_slope_s_m2 / n};
  }
  if (outlet.kind != Outlet::Kind::kEmitter || !options.emitter_backflow) AddLowerBarrier(flow_m3_s, head);
  return head;
}

double CalcOutletFlow_m3_s(const Outlet& outlet, double head_m, double full_m3_s) {
  const double h = std::max(0.0, head_m - outlet.base_head_m);
  if (outlet.kind != Outlet::Kind::kDemand) return outlet.coefficient * std::pow(h, 1 / outlet.exponent);
  return full_m3_s * std::pow(std::min(1.0, h / outlet.head_range_m), 1 / outlet.exponent);
}

double& OutletFlow(const Outlet& outlet, HydraulicState& state) {
  return (state.*FindField(outlet.kind))[outlet.junction];
}

double OutletFlow(const Outlet& outlet, const HydraulicState& state) {
  return (state.*FindField(outlet.kind))[outlet.junction];
}

}  // namespace piperun::sim
