#include "sim/hydraulics.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "base/check.h"
#include "base/number.h"
#include "sim/bend_loss.h"
#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

constexpr double kMaxRelativeRoughness = 0.05;  // the end of Moody's chart
constexpr double kUnknownHead = std::numeric_limits<double>::quiet_NaN();

/// The water on its way along the route.
struct Stream {
  double flow_m3_s = 0;
  double head_m = 0;
  BendLossRange bend_losses{};
};

/// What every step along the route needs to know.
struct Problem {
  const Network& network;
  std::span<const Leak> leaks;
  const WaterProperties& water;
  double gravity_m_s2;
  const LocalLosses& losses;
};

/// A leg of the route with the bends on it, as far as they cost head.
struct Leg {
  RouteLeg way;
  std::vector<BendPart> bends;
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

/// K of what is not friction between two places along a leg; a bend is within them as a whole or not at all.
double CalcLocalLoss(const Problem& problem, const Leg& leg, const FlowReach& along, double reynolds,
                     Stream& stream) {
  const Pipe& pipe = problem.network.pipe(leg.way.pipe);
  const double middle_m = 0.5 * (along.s_begin_m + along.s_end_m), length_m = along.s_end_m - along.s_begin_m;
  double loss = 0;
  if (!problem.losses.pipe_coefficients.empty()) {
    loss +=
        problem.losses.pipe_coefficients[static_cast<std::size_t>(leg.way.pipe)] * length_m / pipe.length_m;
  }
  if (reynolds == 0) return loss;
  for (const BendPart& part : leg.bends) {
    if (middle_m < part.begin_m || middle_m > part.end_m) continue;
    const BendShape bend{part.turn_rad, part.radius_m / pipe.radius_m()};
    loss += CalcExcessBendLoss(bend, reynolds) * part.share * length_m / (part.end_m - part.begin_m);
    stream.bend_losses.Add(bend, reynolds);
  }
  return loss;
}

/// Lets the stream flow along a leg: h = (f L/D + K) U^2/(2g).
FlowReach Advance(const Problem& problem, const Leg& leg, double begin_m, double end_m, Stream& stream) {
  const Pipe& pipe = problem.network.pipe(leg.way.pipe);
  const double speed = stream.flow_m3_s / pipe.area_m2();
  const double reynolds = speed * pipe.diameter_m / problem.water.kinematic_viscosity_m2_s;
  FlowReach reach;
  reach.s_begin_m = begin_m;
  reach.s_end_m = end_m;
  reach.flow_m3_s = stream.flow_m3_s;
  reach.friction_factor = CalcFrictionFactor(reynolds, pipe.material.roughness_m / pipe.diameter_m);
  reach.head_begin_m = stream.head_m;
  const double friction = reach.friction_factor * (end_m - begin_m) / pipe.diameter_m;
  stream.head_m -= (friction + CalcLocalLoss(problem, leg, reach, reynolds, stream)) * speed * speed /
                   (2 * problem.gravity_m_s2);
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

/// Where the stream changes along a leg, and the leak it meets there.
struct Stop {
  double along_m = 0;
  std::optional<std::size_t> leak{};
};

/// Leaks, the ends of bends and the leg's own end, in the order in which the stream meets them.
std::vector<Stop> FindStops(const Problem& problem, const Leg& leg) {
  const double length_m = problem.network.pipe(leg.way.pipe).length_m;
  std::vector<Stop> stops;
  for (std::size_t i = 0; i < problem.leaks.size(); ++i) {
    const double s_m = problem.leaks[i].s_m;
    if (problem.leaks[i].pipe == leg.way.pipe) stops.push_back({leg.way.reversed ? length_m - s_m : s_m, i});
  }
  for (const BendPart& bend : leg.bends) {
    stops.push_back({bend.begin_m});
    stops.push_back({bend.end_m});
  }
  std::stable_sort(stops.begin(), stops.end(),
                   [](const Stop& a, const Stop& b) { return a.along_m < b.along_m; });
  stops.push_back({length_m});
  return stops;
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

std::vector<FlowReach> SolveLeg(const Problem& problem, const Leg& leg, Stream& stream,
                                std::vector<LeakState>& leaks) {
  constexpr double kNothing_m = 1e-9;  // rounding: no reach is that short
  const double length_m = problem.network.pipe(leg.way.pipe).length_m;
  std::vector<FlowReach> reaches;
  double done_m = 0;
  for (const Stop& stop : FindStops(problem, leg)) {
    const bool at_end = length_m - stop.along_m < kNothing_m;
    const double along_m = at_end ? length_m : stop.along_m;
    if (along_m - done_m > (at_end ? 0 : kNothing_m)) {
      reaches.push_back(Advance(problem, leg, std::exchange(done_m, along_m), along_m, stream));
    }
    if (stop.leak) leaks[*stop.leak] = Discharge(problem, *stop.leak, stream);
  }
  if (leg.way.reversed) {
    std::reverse(reaches.begin(), reaches.end());
    for (FlowReach& reach : reaches) reach = ReversedReach(reach, length_m);
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
                           std::span<const Leak> leaks, const WaterProperties& water, double gravity_m_s2,
                           const LocalLosses& losses) {
  const Problem problem{network, leaks, water, gravity_m_s2, losses};
  RequireInlet(inlet);
  RequireRoute(problem, route);
  for (std::size_t i = 0; i < leaks.size(); ++i) RequireLeak(problem, route, i);

  FlowState state = MakeStillState(network);
  std::vector<LeakState> leak_states(leaks.size());
  const double inlet_elevation = route.pieces().front().line.p_begin_W.z();
  Stream stream{inlet.flow_m3_s, inlet_elevation + inlet.pressure_Pa / (water.density_kg_m3 * gravity_m_s2)};
  std::vector<std::vector<BendPart>> bends(route.legs().size());
  if (losses.bends) bends = FindBends(network, route);
  for (std::size_t i = 0; i < bends.size(); ++i) {
    const Leg leg{route.legs()[i], std::move(bends[i])};
    state.pipes[static_cast<std::size_t>(leg.way.pipe)] = SolveLeg(problem, leg, stream, leak_states);
  }
  FillSidePipes(network, route, state);

  std::vector<double> areas;
  for (const Pipe& pipe : network.pipes()) areas.push_back(pipe.area_m2());
  FlowTimeline timeline(std::move(areas), {TrueTime{}}, {std::move(state)});
  RequireWholeColumn(problem, route, timeline);
  return {std::move(timeline), std::move(leak_states), stream.bend_losses.Warnings()};
}

}  // namespace piperun::sim
