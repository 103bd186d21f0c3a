#include "sim/network/solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

constexpr double kNoSetting = std::numeric_limits<double>::quiet_NaN();

double FirstOutletFlow_m3_s(Outlet::Kind kind) {
  return kind == Outlet::Kind::kEmitter ? epanet::kFirstEmitterFlow_m3_s : epanet::kFirstLeakageFlow_m3_s;
}

void AddLinkState(LinkStatus status, double setting, HydraulicState& state) {
  state.status.push_back(status);
  state.setting.push_back(setting);
}

}  // namespace

HydraulicState HydraulicSolver::MakeState() const {
  HydraulicState state;
  const auto junctions = static_cast<std::size_t>(model_.junction_count());
  for (const ReservoirNode& reservoir : model_.reservoirs) state.head_m.push_back(reservoir.head_m);
  for (const TankNode& tank : model_.tanks) state.head_m.push_back(tank.elevation_m + tank.initial_level_m);
  const double highest = *std::max_element(state.head_m.begin(), state.head_m.end());
  state.inflow_m3_s.resize(state.head_m.size());
  state.head_m.insert(state.head_m.begin(), junctions, highest);
  state.demand_m3_s.resize(junctions);
  state.delivered_m3_s.resize(junctions);
  state.emitter_m3_s.resize(junctions);
  state.fixed_leak_m3_s.resize(junctions);
  state.variable_leak_m3_s.resize(junctions);
  for (const Outlet& outlet : outlets_) {
    if (outlet.kind != Outlet::Kind::kDemand) OutletFlow(outlet, state) = FirstOutletFlow_m3_s(outlet.kind);
  }
  for (const PipeLink& pipe : model_.pipes) AddLinkState(pipe.status, kNoSetting, state);
  for (const PumpLink& pump : model_.pumps) AddLinkState(pump.status, pump.speed, state);
  for (const ValveLink& valve : model_.valves) {
    AddLinkState(valve.status, valve.status == LinkStatus::kActive ? valve.setting : kNoSetting, state);
  }
  for (int link = 0; link < model_.link_count(); ++link) {
    state.flow_m3_s.push_back(laws_.FirstFlow_m3_s(link, state.status[link], state.setting[link]));
  }
  return state;
}

void HydraulicSolver::SetLeak(int junction, const LeakCoefficients& leak, HydraulicState& state) {
  const auto set = [&](Outlet::Kind kind, double coefficient, double exponent) {
    auto found = std::find_if(outlets_.begin(), outlets_.end(), [&](const Outlet& outlet) {
      return outlet.junction == junction && outlet.kind == kind;
    });
    if (found == outlets_.end()) {
      if (coefficient == 0) return;
      found =
          outlets_.insert(found, {kind, junction, 0, exponent, model_.junctions[junction].elevation_m, 0});
      outlet_predicted_m3_s_.push_back(0);
      outlet_conductance_m2_s_.push_back(0);
    }
    found->coefficient = coefficient;
    const double flow = CalcOutletFlow_m3_s(*found, state.head_m[junction], 0);
    OutletFlow(*found, state) = coefficient == 0 ? 0 : std::max(flow, epanet::kZeroFlow_m3_s);
  };
  set(Outlet::Kind::kFixedLeak, leak.fixed_m25_s, 2);
  set(Outlet::Kind::kVariableLeak, leak.variable_m15_s, 2.0 / 3);
}

}  // namespace piperun::sim
