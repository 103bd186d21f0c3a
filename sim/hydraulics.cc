#include "sim/hydraulics.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "base/check.h"
#include "base/number.h"
#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

constexpr double kMaxRelativeRoughness = 0.05;  // the end of Moody's chart
constexpr double kUnknownHead = std::numeric_limits<double>::quiet_NaN();

/// The water on its way along the route.
struct Stream {
  double flow_m3_s = 0;
  double head_m = 0;
};

/// What every step along the route needs to know.
struct Problem {
  const Network& network;
  std::span<const Leak> leaks;
  const WaterProperties& water;
  double gravity_m_s2;
};

std::string LeakKey(std::size_t i, const char* field) { return "leaks[" + std::to_string(i) + "]" + field; }

void RequireInlet(const InletCondition& inlet) {
  if (!(inlet.flow_m3_s >= 0 && std::isfinite(inlet.flow_m3_s))) {
    throw InputError("the inlet flow is " + FormatNumber(inlet.flow_m3_s) +
                         " m3/s; it must be >= 0, into the first pipe of the route",
                     "flow.inlet_m3_s");
  }
  if (!std::isfinite(inlet.pressure_Pa)) {
    throw InputError("the inlet pressure must be a finite number", "flow.inlet_pressure_Pa");
  }
}

void RequireLeak(const Problem& problem, const Route& route, std::size_t i) {
  const Leak& leak = problem.leaks[i];
  const Pipe& pipe = problem.network.pipe(leak.pipe);
  if (std::none_of(route.legs().begin(), route.legs().end(),
                   [&](const RouteLeg& leg) { return leg.pipe == leak.pipe; })) {
    throw InputError("pipe '" + pipe.id + "' is not on the route; leaks elsewhere are not supported yet",
                     LeakKey(i, ".pipe"));
  }
  if (!(leak.s_m >= 0 && leak.s_m <= pipe.length_m)) {
    throw InputError("the leak lies at " + FormatNumber(leak.s_m) + " m, beyond the pipe's range [0, " +
                         FormatNumber(pipe.length_m) + "] m",
                     LeakKey(i, ".s_m"));
  }
  if (!(leak.hole_diameter_m > 0 && leak.hole_diameter_m < pipe.diameter_m)) {
    throw InputError("the hole measures " + FormatNumber(leak.hole_diameter_m) + " m; it must lie in (0, " +
                         FormatNumber(pipe.diameter_m) + ") m, the pipe's bore",
                     LeakKey(i, ".hole_diameter_m"));
  }
  if (!(leak.discharge_coefficient > 0 && leak.discharge_coefficient <= 1)) {
    throw InputError("the discharge coefficient is " + FormatNumber(leak.discharge_coefficient) +
                         "; it must lie in (0, 1]",
                     LeakKey(i, ".cd"));
  }
}

void RequireRoute(const Problem& problem, const Route& route) {
  std::vector<bool> used(problem.network.pipes().size());
  for (const RouteLeg& leg : route.legs()) {
    const Pipe& pipe = problem.network.pipe(leg.pipe);
    if (used[static_cast<std::size_t>(leg.pipe)]) {
      throw InputError("the route uses pipe '" + pipe.id + "' twice; steady flow passes a pipe once",
                       "mission");
    }
    used[static_cast<std::size_t>(leg.pipe)] = true;
    if (pipe.material.roughness_m > kMaxRelativeRoughness * pipe.diameter_m) {
      throw InputError("pipe '" + pipe.id + "' has a roughness of " +
                           FormatNumber(pipe.material.roughness_m) +
                           " m; friction is known up to 0.05 diameters, " +
                           FormatNumber(kMaxRelativeRoughness * pipe.diameter_m) + " m",
                       "network.pipes");
    }
  }
}

double AxisElevation(const Pipe& pipe, double s_m) {
  std::size_t i = 0;
  while (i + 1 < pipe.centreline.size() && s_m > pipe.centreline[i].s_end_m()) ++i;
  return EvalCentreline(pipe.centreline[i], s_m).p_W.z();
}

/// Lets the stream flow `length` along the pipe: h_f = f L/D U^2/(2g).
FlowReach Advance(const Problem& problem, const Pipe& pipe, double length_m, Stream& stream) {
  const double speed = stream.flow_m3_s / pipe.area_m2();
  const double reynolds = speed * pipe.diameter_m / problem.water.kinematic_viscosity_m2_s;
  FlowReach reach;
  reach.flow_m3_s = stream.flow_m3_s;
  reach.friction_factor = CalcFrictionFactor(reynolds, pipe.material.roughness_m / pipe.diameter_m);
  reach.head_begin_m = stream.head_m;
  stream.head_m -=
      reach.friction_factor * length_m / pipe.diameter_m * speed * speed / (2 * problem.gravity_m_s2);
  reach.head_end_m = stream.head_m;
  return reach;
}

/// Takes the orifice flow Q = Cd A sqrt(2 dp/rho) of leak i out of the stream.
LeakState Discharge(const Problem& problem, std::size_t i, Stream& stream) {
  const Leak& leak = problem.leaks[i];
  const double elevation = AxisElevation(problem.network.pipe(leak.pipe), leak.s_m);
  const double density = problem.water.density_kg_m3;
  const double pressure_Pa = density * problem.gravity_m_s2 * (stream.head_m - elevation);
  if (!(pressure_Pa > 0)) {
    throw InputError("the pressure at leak '" + leak.id + "' is " + FormatNumber(pressure_Pa) +
                         " Pa; it must be positive: raise the inlet pressure",
                     LeakKey(i, ""));
  }
  const double area = 0.25 * std::numbers::pi * leak.hole_diameter_m * leak.hole_diameter_m;
  const double flow = leak.discharge_coefficient * area * std::sqrt(2 * pressure_Pa / density);
  if (flow > stream.flow_m3_s) {
    throw InputError("leak '" + leak.id + "' would take " + FormatNumber(flow) + " m3/s of the " +
                         FormatNumber(stream.flow_m3_s) +
                         " m3/s that reach it; raise the inlet flow or make the hole smaller",
                     LeakKey(i, ""));
  }
  stream.flow_m3_s -= flow;
  return {flow, pressure_Pa};
}

/// Leaks of a pipe in the order in which the stream meets them.
std::vector<std::size_t> SortLeaks(const Problem& problem, const RouteLeg& leg) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < problem.leaks.size(); ++i) {
    if (problem.leaks[i].pipe == leg.pipe) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double s_a = problem.leaks[a].s_m, s_b = problem.leaks[b].s_m;
    return leg.reversed ? s_a > s_b : s_a < s_b;
  });
  return order;
}

/// A reach written along the stream, turned into the pipe's own direction.
FlowReach ReversedReach(const FlowReach& reach, double pipe_length_m) {
  FlowReach r = reach;
  r.s_begin_m = pipe_length_m - reach.s_end_m;
  r.s_end_m = pipe_length_m - reach.s_begin_m;
  r.flow_m3_s = -reach.flow_m3_s;
  std::swap(r.head_begin_m, r.head_end_m);
  return r;
}

std::vector<FlowReach> SolveLeg(const Problem& problem, const RouteLeg& leg, Stream& stream,
                                std::vector<LeakState>& leaks) {
  const Pipe& pipe = problem.network.pipe(leg.pipe);
  std::vector<FlowReach> reaches;
  double done_m = 0;
  const auto advance_to = [&](double along_m) {
    if (along_m <= done_m) return;
    FlowReach reach = Advance(problem, pipe, along_m - done_m, stream);
    reach.s_begin_m = std::exchange(done_m, along_m);
    reach.s_end_m = along_m;
    reaches.push_back(reach);
  };
  for (const std::size_t i : SortLeaks(problem, leg)) {
    const double s = problem.leaks[i].s_m;
    advance_to(leg.reversed ? pipe.length_m - s : s);
    leaks[i] = Discharge(problem, i, stream);
  }
  advance_to(pipe.length_m);
  if (leg.reversed) {
    std::reverse(reaches.begin(), reaches.end());
    for (FlowReach& reach : reaches) reach = ReversedReach(reach, pipe.length_m);
  }
  return reaches;
}

/// Still water under an unknown head in every pipe.
FlowState MakeStillState(const Network& network) {
  FlowState state;
  for (const Pipe& pipe : network.pipes()) {
    state.pipes.push_back(
        {{.s_end_m = pipe.length_m, .head_begin_m = kUnknownHead, .head_end_m = kUnknownHead}});
  }
  return state;
}

/// Water in pipes beside the route stands still under the head of the route's node they hang on.
void FillSidePipes(const Network& network, const Route& route, FlowState& state) {
  std::deque<std::pair<int, double>> open;  // nodes and their heads
  for (const RouteLeg& leg : route.legs()) {
    const auto& reaches = state.pipes[static_cast<std::size_t>(leg.pipe)];
    open.emplace_back(network.pipe(leg.pipe).from, reaches.front().head_begin_m);
    open.emplace_back(network.pipe(leg.pipe).to, reaches.back().head_end_m);
  }
  for (; !open.empty(); open.pop_front()) {
    const auto [node, head_m] = open.front();
    for (const auto& [p, at_to] : network.EndsAt(node)) {
      FlowReach& reach = state.pipes[static_cast<std::size_t>(p)].front();
      if (!std::isnan(reach.head_begin_m)) continue;
      reach.head_begin_m = reach.head_end_m = head_m;
      open.emplace_back(network.pipe(p).from, head_m);
      open.emplace_back(network.pipe(p).to, head_m);
    }
  }
}

/// Cold water boils at an absolute pressure near zero: below this gauge pressure the column parts.
constexpr double kPartingPressure_Pa = -1e5;

/// Looks at both ends and the middle of every piece of the route.
void RequireWholeColumn(const Problem& problem, const Route& route, const FlowTimeline& timeline) {
  for (const RoutePiece& piece : route.pieces()) {
    for (const double part : {0.0, 0.5, 1.0}) {
      const double chainage_m = piece.line.s_begin_m + part * piece.line.length_m;
      const double head_m = timeline.Eval(piece.pipe, piece.PipeS_m(chainage_m), TrueTime{}).head_m;
      const double z_m = EvalCentreline(piece.line, chainage_m).p_W.z();
      const double pressure_Pa = problem.water.density_kg_m3 * problem.gravity_m_s2 * (head_m - z_m);
      if (pressure_Pa >= kPartingPressure_Pa) continue;
      throw InputError("the pressure falls to " + FormatNumber(pressure_Pa) + " Pa (gauge) at chainage " +
                           FormatNumber(chainage_m) + " m, where the water would part; allowed: above " +
                           FormatNumber(kPartingPressure_Pa) + " Pa. Raise the inlet pressure",
                       "flow.inlet_pressure_Pa");
    }
  }
}

}  // namespace

SteadyFlow SolveSteadyFlow(const Network& network, const Route& route, const InletCondition& inlet,
                           std::span<const Leak> leaks, const WaterProperties& water, double gravity_m_s2) {
  const Problem problem{network, leaks, water, gravity_m_s2};
  RequireInlet(inlet);
  RequireRoute(problem, route);
  for (std::size_t i = 0; i < leaks.size(); ++i) RequireLeak(problem, route, i);

  FlowState state = MakeStillState(network);
  std::vector<LeakState> leak_states(leaks.size());
  const double inlet_elevation = route.pieces().front().line.p_begin_W.z();
  Stream stream{inlet.flow_m3_s, inlet_elevation + inlet.pressure_Pa / (water.density_kg_m3 * gravity_m_s2)};
  for (const RouteLeg& leg : route.legs()) {
    state.pipes[static_cast<std::size_t>(leg.pipe)] = SolveLeg(problem, leg, stream, leak_states);
  }
  FillSidePipes(network, route, state);

  std::vector<double> areas;
  for (const Pipe& pipe : network.pipes()) areas.push_back(pipe.area_m2());
  FlowTimeline timeline(std::move(areas), {TrueTime{}}, {std::move(state)});
  RequireWholeColumn(problem, route, timeline);
  return {std::move(timeline), std::move(leak_states)};
}

}  // namespace piperun::sim
