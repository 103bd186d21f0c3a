#include "scenarios/pipeline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/inp_network.h"
#include "scenarios/leak_list.h"
#include "scenarios/network_params.h"
#include "sim/downstream.h"
#include "sim/hydraulics.h"
#include "sim/network/drained_part.h"
#include "sim/network/inp_reader.h"
#include "sim/network/network_flow.h"
#include "sim/network/pipe_leak.h"
#include "sim/network/simulation.h"

namespace piperun::scenarios {
namespace {

constexpr double kAccuracy = 1e-6;  // flows balance to this part of the whole, where the file asks for less

struct Stops {
  int launch = 0;
  std::vector<int> via;
  int retrieve = -1;
};

Stops FindStops(const MissionParams& mission, const Network& network) {
  Stops stops;
  stops.launch = ResolveNode(network, mission.launch, "mission.launch");
  for (std::size_t i = 0; i < mission.via.size(); ++i) {
    stops.via.push_back(
        ResolveNode(network, mission.via[i].node, "mission.via[" + std::to_string(i) + "].node"));
  }
  if (!mission.retrieve.empty()) {
    stops.retrieve = ResolveNode(network, mission.retrieve, "mission.retrieve");
  }
  return stops;
}

void Append(const std::vector<RouteLeg>& more, std::vector<RouteLeg>& legs) {
  legs.insert(legs.end(), more.begin(), more.end());
}

/// A pipeline written down pipe by pipe: along its route, in series.
Pipeline BuildSeries(const Scenario& scenario, const WaterProperties& water) {
  Network network = MakeNetwork(scenario.network);
  MakeFittings(scenario.network, network);  // refuses what does not fit
  const Stops stops = FindStops(scenario.mission, network);
  if (stops.retrieve < 0) {
    throw InputError("the node is missing; where water only enters, name where it leaves",
                     "mission.retrieve");
  }
  std::vector<RouteLeg> plan;
  int from = stops.launch;
  for (const int via : stops.via) Append(FindRoute(network, std::exchange(from, via), via).legs(), plan);
  Append(FindRoute(network, from, stops.retrieve).legs(), plan);
  std::vector<Leak> leaks = MakeListedLeaks(scenario, network);
  const std::vector<Leak> drawn = DrawLeaks(scenario, network, plan, leaks);
  leaks.insert(leaks.end(), drawn.begin(), drawn.end());
  sim::LocalLosses losses{{}, scenario.flow.bend_losses};
  for (const PipeEntry& pipe : scenario.network.pipes) losses.pipe_coefficients.push_back(pipe.minor_loss);
  sim::SteadyFlow flow = sim::SolveSteadyFlow(network, Route(network, plan),
                                              {scenario.flow.inlet_m3_s, scenario.flow.inlet_pressure_Pa},
                                              leaks, water, scenario.gravity_m_s2, losses);
  return {.drawing = scenario.network,
          .network = std::move(network),
          .flow = std::move(flow.timeline),
          .leaks = std::move(leaks),
          .leak_states = std::move(flow.leaks),
          .launch_node = stops.launch,
          .retrieve_node = stops.retrieve,
          .plan = std::move(plan),
          .notes = {},
          .warnings = std::move(flow.warnings)};
}

[[noreturn]] void ThrowDiverged(std::int64_t time_s, const sim::SolveReport& report,
                                const sim::HydraulicModel& model) {
  throw HydraulicsDiverged("the hydraulics at " + std::to_string(time_s) + " s " + Describe(report, model));
}

/// The water of an instant just solved, empty where none comes; names junctions whose demand is not served.
sim::HydraulicState Settle(const sim::HydraulicModel& model, sim::HydraulicSimulation& simulation,
                           std::set<int>& unserved) {
  const std::vector<bool> drained = FindDrained(model, simulation.state());
  const std::vector<int> dropped = DropDrainedDemands(drained, simulation.state());
  unserved.insert(dropped.begin(), dropped.end());
  if (!dropped.empty()) {
    const sim::SolveReport report = simulation.solver().Solve(simulation.state());
    if (!report.converged()) ThrowDiverged(simulation.time_s(), report, model);
  }
  sim::HydraulicState state = simulation.state();
  SettleDrained(model, drained, state);
  return state;
}

struct Period {
  std::vector<sim::HydraulicStep> steps;
  std::set<int> unserved;  ///< junctions with a demand that no water reaches, at times
};

/// The hydraulics of an EPANET file from its beginning to `until_s` (or its own end), instant by instant.
Period SolvePeriod(const sim::HydraulicModel& model, double until_s) {
  Period period;
  sim::HydraulicSimulation simulation(model);
  do {
    const sim::SolveReport report = simulation.Solve();
    if (!report.converged()) ThrowDiverged(simulation.time_s(), report, model);
    period.steps.push_back({simulation.time_s(), false, report, Settle(model, simulation, period.unserved)});
  } while (static_cast<double>(simulation.time_s()) < until_s && simulation.Advance());
  return period;
}

/// Leaks and customers that no water reaches, a sentence each.
std::vector<std::string> DescribeDry(const Period& period, const sim::LeakyModel& leaky,
                                     const std::vector<Leak>& leaks, const std::vector<LeakState>& states) {
  std::vector<std::string> warnings;
  for (const int junction : period.unserved) {
    warnings.push_back("node " + leaky.model.NodeId(junction) +
                       ": closed off from all water: its demand is not served");
  }
  for (std::size_t i = 0; i < leaks.size(); ++i) {
    if (states[i].pressure_drop_Pa > 0) continue;
    const std::string why =
        states[i].flow_m3_s == 0 && states[i].pressure_drop_Pa == 0
            ? "closed dead pipe with no pressure"
            : "pressure of " + FormatNumber(states[i].pressure_drop_Pa) + " Pa, no more than outside";
    warnings.push_back("leak " + leaks[i].id + ": " + why + ": no sound");
  }
  return warnings;
}

std::string BallText(const sim::BallParams& ball) {
  return "a ball of " + FormatNumber(2000 * ball.radius_m) + " mm";
}

/// The way along the water at the launch: through the nodes named, or where most of it goes.
std::vector<RouteLeg> PlanAlongWater(const Scenario& scenario, const Network& network,
                                     const sim::FlowTimeline& flow, const Stops& stops) {
  const sim::Bore bore(network);
  const sim::Downstream downstream(bore, flow, TrueTime{});
  const double min_radius_m = scenario.ball.radius_m / sim::kMaxDiameterRatio;
  std::vector<int> targets = stops.via;
  if (stops.retrieve >= 0) targets.push_back(stops.retrieve);
  std::vector<RouteLeg> plan;
  int from = stops.launch;
  for (const int target : targets) {
    const auto leg = downstream.FindFastestWay(from, target, min_radius_m);
    if (!leg || leg->empty()) {
      throw InputError(
          "at the launch no water leads from '" + network.nodes()[static_cast<std::size_t>(from)].id +
              "' to '" + network.nodes()[static_cast<std::size_t>(target)].id + "' through pipes that " +
              BallText(scenario.ball) + " passes; `piperun network FILE --from NODE` lists where it leads",
          target == stops.retrieve ? "mission.retrieve" : "mission.via");
    }
    Append(*leg, plan);
    from = target;
  }
  if (stops.retrieve < 0) Append(downstream.FollowMainFlow(from, min_radius_m), plan);
  if (plan.empty()) {
    throw InputError(
        "at the launch no water leaves this node through a pipe that " + BallText(scenario.ball) + " passes",
        "mission.launch");
  }
  return plan;
}

/// The model with links as they stand at the launch: what is closed then is closed to the ball.
sim::HydraulicModel AtLaunch(const sim::HydraulicModel& model, double launch_s) {
  sim::HydraulicModel at_launch = model;
  const std::vector<sim::HydraulicStep> steps = SolvePeriod(model, launch_s).steps;
  std::size_t last = 0;
  while (last + 1 < steps.size() && static_cast<double>(steps[last + 1].time_s) <= launch_s) ++last;
  const sim::HydraulicState& state = steps[last].state;
  std::size_t link = 0;
  for (sim::PipeLink& pipe : at_launch.pipes) pipe.status = state.status[link++];
  link += at_launch.pumps.size();
  for (sim::ValveLink& valve : at_launch.valves) {
    const bool fixed = std::isnan(state.setting[link]);
    if (!fixed) valve.setting = state.setting[link];
    const sim::LinkStatus status = state.status[link++];
    valve.status = IsClosed(status) || fixed ? status : sim::LinkStatus::kActive;
  }
  return at_launch;
}

MaterialRules ReadRules(const NetworkSource& source) {
  if (source.material_rules.empty()) return {};
  return {source.material_rules_text, source.material_rules};
}

/// An EPANET file made ready to be solved with leaks in it.
class InpPipeline {
 public:
  InpPipeline(const Scenario& scenario, const WaterProperties& water)
      : scenario_(scenario),
        water_(water),
        model_(sim::ReadInp(scenario.network.inp_text, scenario.network.inp)),
        drawing_(DrawNetwork(AtLaunch(model_, scenario.flow.launch_time_s),
                             {scenario.network.map_unit_m, scenario.network.bend_radius_diameters,
                              ReadRules(scenario.network)})),
        network_(MakeNetwork(drawing_.network)),
        stops_(FindStops(scenario.mission, network_)) {
    model_.options.accuracy = std::min(model_.options.accuracy, kAccuracy);
    auto& fittings = drawing_.network.fittings;
    fittings.insert(fittings.end(), scenario.network.fittings.begin(), scenario.network.fittings.end());
    MakeFittings(drawing_.network, network_);  // refuses what does not fit
  }

  Pipeline Build() {
    std::vector<Leak> leaks = MakeListedLeaks(scenario_, network_);
    if (scenario_.random_leaks.count > 0) {
      const auto plan = PlanAlongWater(scenario_, network_, Solve(leaks).timeline, stops_);
      const std::vector<Leak> drawn = DrawLeaks(scenario_, network_, plan, leaks);
      leaks.insert(leaks.end(), drawn.begin(), drawn.end());
    }
    Flow flow = Solve(leaks);
    std::vector<RouteLeg> plan = PlanAlongWater(scenario_, network_, flow.timeline, stops_);
    std::vector<std::string> notes = model_.notes;
    notes.insert(notes.end(), drawing_.notes.begin(), drawing_.notes.end());
    return {std::move(drawing_.network),
            std::move(network_),
            std::move(flow.timeline),
            std::move(leaks),
            std::move(flow.leaks),
            stops_.launch,
            stops_.retrieve,
            std::move(plan),
            std::move(notes),
            std::move(flow.model),
            std::move(flow.warnings)};
  }

 private:
  struct Flow {
    sim::FlowTimeline timeline;
    std::vector<LeakState> leaks;
    sim::HydraulicModel model;
    std::vector<std::string> warnings;
  };
  Flow Solve(const std::vector<Leak>& leaks) const {
    const double launch_s = scenario_.flow.launch_time_s;
    const auto launch = std::llround(launch_s);
    if (static_cast<double>(launch) != launch_s) {
      throw InputError(FormatNumber(launch_s) + " s is not allowed; hydraulics count whole seconds",
                       "flow.launch_time_s");
    }
    sim::LeakyModel leaky = sim::InsertLeaks(model_, MakePipeLeaks(leaks), scenario_.gravity_m_s2);
    const Period period = SolvePeriod(leaky.model, launch_s + scenario_.mission.time_limit_s);
    sim::FlowTimeline timeline = sim::MakeFlowTimeline(leaky, period.steps, launch, network_, water_);
    std::vector<LeakState> states =
        sim::CalcLeakStates(leaky, period.steps, launch, TrueTime{}, water_, scenario_.gravity_m_s2);
    std::vector<std::string> warnings = DescribeDry(period, leaky, leaks, states);
    return {std::move(timeline), std::move(states), std::move(leaky.model), std::move(warnings)};
  }

  std::vector<sim::PipeLeak> MakePipeLeaks(const std::vector<Leak>& leaks) const {
    std::vector<sim::PipeLeak> holes;
    for (std::size_t i = 0; i < leaks.size(); ++i) {
      const Leak& leak = leaks[i];
      if (leak.pipe >= static_cast<int>(model_.pipes.size())) {
        throw InputError("'" + network_.pipe(leak.pipe).id + "' is a pump or valve; a leak lies in a pipe",
                         "leaks[" + std::to_string(i) + "].pipe");
      }
      holes.push_back({leak.id, leak.pipe, leak.s_m,
                       0.25 * std::numbers::pi * leak.hole_diameter_m * leak.hole_diameter_m,
                       leak.area_slope_m, leak.discharge_coefficient});
    }
    return holes;
  }

  const Scenario& scenario_;
  const WaterProperties& water_;
  sim::HydraulicModel model_;
  InpDrawing drawing_;
  Network network_;
  Stops stops_;
};

}  // namespace

Pipeline BuildPipeline(const Scenario& scenario, const WaterProperties& water) {
  Pipeline pipeline =
      scenario.network.inp.empty() ? BuildSeries(scenario, water) : InpPipeline(scenario, water).Build();
  for (PipeEntry& pipe : pipeline.drawing.pipes)
    pipe.sound = ResolvePipeSound(pipe.sound, scenario.network.sound);
  return pipeline;
}

}  // namespace piperun::scenarios
