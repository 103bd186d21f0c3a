#include "sim/network/network_flow.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

constexpr double kMaxRelativeRoughness = 0.05;  // the end of Moody's chart

double CalcFriction(const Pipe& pipe, double flow_m3_s, const WaterProperties& water) {
  const double reynolds =
      std::abs(flow_m3_s) / pipe.area_m2() * pipe.diameter_m / water.kinematic_viscosity_m2_s;
  return CalcFrictionFactor(reynolds, pipe.material.roughness_m / pipe.diameter_m);
}

FlowReach MakeReach(const HydraulicModel& model, const HydraulicState& state, int link, double s_begin_m,
                    double s_end_m) {
  const auto l = static_cast<std::size_t>(link);
  FlowReach reach;
  reach.s_begin_m = s_begin_m;
  reach.s_end_m = s_end_m;
  reach.flow_m3_s = IsClosed(state.status[l]) ? 0 : state.flow_m3_s[l];
  reach.head_begin_m = state.head_m[static_cast<std::size_t>(model.From(link))];
  reach.head_end_m = state.head_m[static_cast<std::size_t>(model.To(link))];
  return reach;
}

/// Leaks have given every pipe more links, and pumps and valves other numbers.
FlowState MakeFlowState(const Network& network, const LeakyModel& leaky, const HydraulicState& state,
                        const WaterProperties& water) {
  FlowState flow;
  const std::size_t pipes = leaky.pipes.size();
  for (std::size_t i = 0; i < network.pipes().size(); ++i) {
    const Pipe& pipe = network.pipes()[i];
    std::vector<FlowReach> reaches;
    if (i < pipes) {
      for (const PipePiece& piece : leaky.pipes[i]) {
        reaches.push_back(MakeReach(leaky.model, state, piece.link, piece.s_begin_m, piece.s_end_m));
      }
    } else {
      const int link = leaky.model.first_pump() + static_cast<int>(i - pipes);
      reaches.push_back(MakeReach(leaky.model, state, link, 0, pipe.length_m));
    }
    for (FlowReach& reach : reaches) reach.friction_factor = CalcFriction(pipe, reach.flow_m3_s, water);
    flow.pipes.push_back(std::move(reaches));
  }
  return flow;
}

void RequireModerateRoughness(const Network& network) {
  for (const Pipe& pipe : network.pipes()) {
    if (pipe.material.roughness_m <= kMaxRelativeRoughness * pipe.diameter_m) continue;
    throw InputError(
        "pipe '" + pipe.id + "' has a roughness above 0.05 diameters, as far as friction is known",
        "network");
  }
}

/// Between the flows, and the heads, of two states; statuses and settings are those of the earlier one.
HydraulicState Blend(const HydraulicState& a, const HydraulicState& b, double u) {
  HydraulicState state = a;
  const auto blend = [u](std::vector<double>& x, const std::vector<double>& y) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::lerp(x[i], y[i], u);
  };
  blend(state.head_m, b.head_m);
  blend(state.flow_m3_s, b.flow_m3_s);
  blend(state.fixed_leak_m3_s, b.fixed_leak_m3_s);
  blend(state.variable_leak_m3_s, b.variable_leak_m3_s);
  return state;
}

/// The last step at or before the launch.
std::size_t FindLaunch(std::span<const HydraulicStep> steps, double launch_s) {
  std::size_t i = 0;
  while (i + 1 < steps.size() && static_cast<double>(steps[i + 1].time_s) <= launch_s) ++i;
  return i;
}

HydraulicState StateAt(std::span<const HydraulicStep> steps, std::size_t i, double time_s) {
  if (i + 1 == steps.size()) return steps[i].state;
  const double begin_s = static_cast<double>(steps[i].time_s),
               end_s = static_cast<double>(steps[i + 1].time_s);
  return Blend(steps[i].state, steps[i + 1].state,
               std::clamp((time_s - begin_s) / (end_s - begin_s), 0.0, 1.0));
}

LeakState MakeLeakState(const HydraulicModel& model, const HydraulicState& state, int junction,
                        const WaterProperties& water, double gravity_m_s2) {
  const auto j = static_cast<std::size_t>(junction);
  const double pressure_head_m = state.head_m[j] - model.junctions[j].elevation_m;
  return {state.fixed_leak_m3_s[j] + state.variable_leak_m3_s[j],
          water.density_kg_m3 * gravity_m_s2 * pressure_head_m};
}

}  // namespace

NetworkFlow MakeNetworkFlow(const Network& network, const LeakyModel& leaky,
                            std::span<const HydraulicStep> steps, double launch_s,
                            const WaterProperties& water, double gravity_m_s2) {
  Demand(!steps.empty(), "a network was solved at least once");
  RequireModerateRoughness(network);
  const std::size_t first = FindLaunch(steps, launch_s);
  const HydraulicState launch = StateAt(steps, first, launch_s);
  std::vector<TrueTime> times{TrueTime{}};
  std::vector<FlowState> states{MakeFlowState(network, leaky, launch, water)};
  for (std::size_t i = first + 1; i < steps.size(); ++i) {
    times.push_back(TrueTime(FromSeconds(static_cast<double>(steps[i].time_s) - launch_s)));
    states.push_back(MakeFlowState(network, leaky, steps[i].state, water));
  }
  std::vector<double> areas;
  FrictionLaw friction;
  friction.kinematic_viscosity_m2_s = water.kinematic_viscosity_m2_s;
  for (const Pipe& pipe : network.pipes()) {
    areas.push_back(pipe.area_m2());
    friction.relative_roughness.push_back(pipe.material.roughness_m / pipe.diameter_m);
  }
  std::vector<LeakState> leaks;
  for (const LeakPlace& place : leaky.leaks) {
    leaks.push_back(MakeLeakState(leaky.model, launch, place.junction, water, gravity_m_s2));
  }
  return {FlowTimeline(std::move(areas), std::move(times), std::move(states), std::move(friction)),
          std::move(leaks)};
}

}  // namespace piperun::sim
