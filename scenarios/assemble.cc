#include "scenarios/assemble.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/network_params.h"

namespace piperun::scenarios {
namespace {

const Route* RouteOf(const Assembly& assembly) { return assembly.route ? &*assembly.route : nullptr; }

constexpr std::string_view kGroundtruthFolder = "state_groundtruth_estimate0";

template <class Kind>
const Kind& FindKind(const std::vector<Kind>& kinds, const std::string& name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name; });
  Demand(found != kinds.end(), "a kind's name was checked when the scenario was read");
  return *found;
}

/// Pipes that leave the route would need the flow shared out at the junction.
void RefuseSideBranches(const Network& network, const Route& route) {
  for (const RouteLeg& leg : route.legs()) {
    for (const int node : {network.pipe(leg.pipe).from, network.pipe(leg.pipe).to}) {
      if (network.EndsAt(node).size() > 2) {
        throw InputError("node '" + network.nodes()[static_cast<std::size_t>(node)].id +
                             "' joins more than two pipes; junctions on the route are not supported yet",
                         "network.pipes");
      }
    }
  }
}

void RequireBallFits(const Network& network, const Route& route, const sim::BallParams& ball) {
  for (const RouteLeg& leg : route.legs()) {
    const Pipe& pipe = network.pipe(leg.pipe);
    if (ball.radius_m < pipe.radius_m()) continue;
    throw InputError("a ball of radius " + FormatNumber(ball.radius_m) + " m does not fit into pipe '" +
                         pipe.id + "' of diameter " + FormatNumber(pipe.diameter_m) + " m; allowed: below " +
                         FormatNumber(pipe.radius_m()) + " m",
                     "ball.radius_m");
  }
}

std::vector<Leak> MakeLeaks(const Scenario& scenario, const Network& network) {
  std::vector<Leak> leaks;
  for (std::size_t i = 0; i < scenario.leaks.size(); ++i) {
    const LeakEntry& entry = scenario.leaks[i];
    const std::string key = "leaks[" + std::to_string(i) + "]";
    RequirePlainId(entry.id, key + ".id");
    const auto same = [&](const Leak& leak) { return leak.id == entry.id; };
    if (std::any_of(leaks.begin(), leaks.end(), same)) {
      throw InputError("'" + entry.id + "' is used twice; ids must be unique", key + ".id");
    }
    const auto pipe = network.FindPipe(entry.pipe);
    if (!pipe) throw InputError("there is no pipe '" + entry.pipe + "'", key + ".pipe");
    const Pipe& on = network.pipe(*pipe);
    if (entry.s_m > on.length_m) {
      throw InputError(FormatNumber(entry.s_m) + " is beyond the end of pipe '" + on.id + "'; allowed: [0, " +
                           FormatNumber(on.length_m) + "]",
                       key + ".s_m");
    }
    if (entry.hole_diameter_m >= on.diameter_m) {
      throw InputError(
          "the hole is wider than the pipe; allowed: below " + FormatNumber(on.diameter_m) + " m",
          key + ".hole_diameter_m");
    }
    leaks.push_back({entry.id, *pipe, entry.s_m, entry.hole_diameter_m, entry.cd});
  }
  return leaks;
}

void PlaceLeaks(const std::vector<Leak>& leaks, Assembly& assembly) {
  for (std::size_t i = 0; i < leaks.size(); ++i) {
    const auto chainage = assembly.route->Chainage(leaks[i].pipe, leaks[i].s_m);
    if (!chainage) {
      throw InputError("this pipe is not on the ball's route, so the leak could never be heard",
                       "leaks[" + std::to_string(i) + "].pipe");
    }
    assembly.leaks.push_back(
        {leaks[i], assembly.flow->leaks[i], *chainage, assembly.route->Eval(*chainage).p_W});
  }
}

void BuildPipeline(const Scenario& scenario, Assembly& assembly) {
  assembly.network.emplace(MakeNetwork(scenario.network));
  const Network& network = *assembly.network;
  assembly.route.emplace(MakeRoute(network, scenario.mission.launch, scenario.mission.retrieve, "mission"));
  RefuseSideBranches(network, *assembly.route);
  RequireBallFits(network, *assembly.route, scenario.ball);
  const std::vector<Leak> leaks = MakeLeaks(scenario, network);
  assembly.flow.emplace(sim::SolveSteadyFlow(network, *assembly.route,
                                             {scenario.flow.inlet_m3_s, scenario.flow.inlet_pressure_Pa},
                                             leaks, assembly.water, scenario.gravity_m_s2));
  PlaceLeaks(leaks, assembly);
}

void BuildScene(const Scenario& scenario, Assembly& assembly) {
  acoustics::AcousticScene& scene = assembly.scene;
  scene.ambient = scenario.ambient;
  scene.water = assembly.water;
  if (!assembly.network) return;
  for (const Pipe& pipe : assembly.network->pipes()) {
    scene.pipes.push_back(
        {pipe.from, pipe.to, pipe.length_m,
         acoustics::CalcPipeWave(pipe.diameter_m, pipe.wall_thickness_m, pipe.material, assembly.water)});
  }
  for (std::size_t i = 0; i < assembly.leaks.size(); ++i) {
    const PlacedLeak& placed = assembly.leaks[i];
    const KindEntry& sound = scenario.leaks[i].sound;
    const auto& kind = FindKind(acoustics::LeakSoundKinds(), sound.kind());
    scene.leaks.push_back(
        {placed.leak.id, placed.leak.pipe, placed.leak.s_m,
         kind.make(sound.params(), placed.leak.hole_diameter_m, placed.state, assembly.water.density_kg_m3)});
  }
}

void BuildMotion(const Scenario& scenario, Assembly& assembly) {
  sim::MotionContext context;
  context.seed = static_cast<std::uint64_t>(scenario.seed);
  context.run = static_cast<std::uint64_t>(scenario.run);
  context.gravity_W = {0, 0, -scenario.gravity_m_s2};
  context.water = assembly.water;
  context.network = assembly.network ? &*assembly.network : nullptr;
  context.route = RouteOf(assembly);
  context.flow = assembly.flow ? &assembly.flow->timeline : nullptr;
  context.ball = scenario.ball;
  context.lateral_sd_m = scenario.mission.lateral_sd_m;
  context.stuck_after_s = scenario.mission.stuck_after_s;
  const auto& kind = FindKind(sim::MotionKinds(), scenario.motion.kind());
  try {
    assembly.motion = kind.make(scenario.motion.params(), context);
  } catch (const InputError& e) {
    const bool about_ball = e.key_path().starts_with("ball.");
    throw InputError(e.problem(), about_ball ? e.key_path() : "motion." + e.key_path());
  }
}

std::unique_ptr<Channel> MakeChannel(int index, const SensorEntry& entry, const Scenario& scenario,
                                     const Assembly& assembly) {
  const RandomStream random(static_cast<std::uint64_t>(scenario.seed), entry.name,
                            static_cast<std::uint64_t>(scenario.run));
  if (const auto* hydrophone = dynamic_cast<const acoustics::HydrophoneParams*>(&entry.kind.params())) {
    if (!assembly.network) throw InputError("a hydrophone needs a pipe, and this scenario has no network");
    return std::make_unique<HydrophoneChannel>(index, *hydrophone, assembly.scene, random, assembly.clock,
                                               *assembly.network);
  }
  const Rate truth_rate = assembly.motion->rate();
  const sim::SensorContext context{random, assembly.clock, {0, 0, -scenario.gravity_m_s2}, truth_rate};
  auto sensor = FindKind(sim::SensorKinds(), entry.kind.kind()).make(entry.kind.params(), context);
  return std::make_unique<SensorChannel>(index, std::move(sensor), truth_rate);
}

void BuildChannels(const Scenario& scenario, Assembly& assembly) {
  std::vector<const SensorEntry*> entries;
  for (const SensorEntry& entry : scenario.sensors) {
    if (entry.name == kGroundtruthFolder) {
      throw InputError("this name is taken by the ground truth; choose another one", "sensors." + entry.name);
    }
    entries.push_back(&entry);
  }
  std::sort(entries.begin(), entries.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
  for (const SensorEntry* entry : entries) {
    try {
      assembly.channels.push_back(
          MakeChannel(static_cast<int>(assembly.channels.size()), *entry, scenario, assembly));
    } catch (const InputError& e) {
      throw InputError(e.problem(),
                       "sensors." + entry->name + (e.key_path().empty() ? "" : "." + e.key_path()));
    }
    assembly.channel_names.push_back(entry->name);
    const auto* sensor = dynamic_cast<const SensorChannel*>(assembly.channels.back().get());
    if (sensor && sensor->sensor().bias() && !assembly.imu) assembly.imu = sensor;
  }
}

std::unique_ptr<Assembly> Build(const Scenario& scenario) {
  auto assembly = std::make_unique<Assembly>();
  assembly->water = CalcWater(scenario.water.temperature_C);
  assembly->clock = {FromSeconds(scenario.ball.clock_offset_s), scenario.ball.clock_drift_ppm};
  if (!scenario.network.pipes.empty()) {
    BuildPipeline(scenario, *assembly);
  } else if (!scenario.leaks.empty()) {
    throw InputError("a leak needs a pipe, and this scenario has no network", "leaks");
  }
  BuildScene(scenario, *assembly);
  BuildMotion(scenario, *assembly);
  BuildChannels(scenario, *assembly);
  return assembly;
}

}  // namespace

std::unique_ptr<Assembly> Assemble(const Scenario& scenario) {
  try {
    return Build(scenario);
  } catch (const InputError& e) {
    if (!e.where().empty()) throw;
    throw InputError(e.problem(), e.key_path(), scenario.sources.Find(e.key_path()));
  }
}

}  // namespace piperun::scenarios
