#include "scenarios/assemble.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/acoustic_scene.h"
#include "scenarios/network_params.h"
#include "scenarios/sound_list.h"
#include "scenarios/sound_range.h"

namespace piperun::scenarios {
namespace {

constexpr std::string_view kGroundtruthFolder = "state_groundtruth_estimate0";

/// With pinned branches, only the planned way is open.
std::vector<bool> FindOpenPipes(const MissionParams& mission, const Pipeline& pipeline) {
  if (mission.branches == "free") return {};
  std::vector<bool> open(pipeline.network.pipes().size());
  for (const RouteLeg& leg : pipeline.plan) open[static_cast<std::size_t>(leg.pipe)] = true;
  return open;
}

void BuildWay(const Scenario& scenario, Assembly& assembly) {
  assembly.pipeline.emplace(BuildPipeline(scenario, assembly.water));
  const Pipeline& pipeline = *assembly.pipeline;
  assembly.plan.emplace(pipeline.network, pipeline.plan);
  assembly.bore.emplace(pipeline.network, FindOpenPipes(scenario.mission, pipeline));
  WallFeatureList list = MakeWallFeatures(scenario, *assembly.bore);
  assembly.bore->SetFeatures(std::move(list.features));
  assembly.wall_features = std::move(list.labels);
  for (const WallFeatureLabel& label : assembly.wall_features) {
    if (label.kind == "joint") assembly.stick_joints.push_back({label.pipe, label.s_m});
  }
}

void BuildMotion(const Scenario& scenario, Assembly& assembly) {
  sim::MotionContext context;
  context.seed = static_cast<std::uint64_t>(scenario.seed);
  context.run = static_cast<std::uint64_t>(scenario.run);
  context.gravity_W = {0, 0, -scenario.gravity_m_s2};
  context.water = assembly.water;
  if (assembly.pipeline) {
    const Pipeline& pipeline = *assembly.pipeline;
    context.network = &pipeline.network;
    context.route = &*assembly.plan;
    context.bore = &*assembly.bore;
    context.flow = &pipeline.flow;
    context.launch = {pipeline.plan.front().pipe, pipeline.plan.front().reversed};
    context.retrieve_node = pipeline.retrieve_node;
  }
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

sim::SensorContext MakeSensorContext(const SensorEntry& entry, const Scenario& scenario,
                                     const Assembly& assembly) {
  const auto seed = static_cast<std::uint64_t>(scenario.seed), run = static_cast<std::uint64_t>(scenario.run);
  return {.random = RandomStream(seed, entry.name, run),
          .clock = assembly.clock,
          .gravity_W = {0, 0, -scenario.gravity_m_s2},
          .truth_rate = assembly.motion->rate(),
          .water_temperature_C = scenario.water.temperature_C,
          .water_density_kg_m3 = assembly.water.density_kg_m3,
          .network = assembly.network(),
          .joints = assembly.stick_joints,
          .seed = seed,
          .run = run};
}

std::unique_ptr<Channel> MakeChannel(int index, const SensorEntry& entry, const Scenario& scenario,
                                     const Assembly& assembly) {
  const sim::SensorContext context = MakeSensorContext(entry, scenario, assembly);
  if (const auto* hydrophone = dynamic_cast<const acoustics::HydrophoneParams*>(&entry.kind.params())) {
    if (!assembly.pipeline) {
      throw InputError("a hydrophone needs a pipe, and this scenario has no network");
    }
    return std::make_unique<HydrophoneChannel>(index, *hydrophone, assembly.scene, context.random,
                                               assembly.clock, *assembly.network());
  }
  auto sensor = FindKind(sim::SensorKinds(), entry.kind.kind()).make(entry.kind.params(), context);
  return std::make_unique<SensorChannel>(index, std::move(sensor), context.truth_rate);
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

/// Where hydrophones listen beyond what is known of the pipes' waves.
void WarnOfSound(const Scenario& scenario, Assembly& assembly) {
  double top_Hz = 0;
  for (const SensorEntry& entry : scenario.sensors) {
    const auto* hydrophone = dynamic_cast<const acoustics::HydrophoneParams*>(&entry.kind.params());
    if (hydrophone) top_Hz = std::max(top_Hz, 0.5 * hydrophone->rate_Hz);
  }
  if (!assembly.pipeline) return;
  for (std::string& warning : WarnOfSoundRange(*assembly.network(), assembly.scene, top_Hz))
    assembly.pipeline->warnings.push_back(std::move(warning));
}

std::unique_ptr<Assembly> Build(const Scenario& scenario) {
  auto assembly = std::make_unique<Assembly>();
  assembly->water = CalcWater(scenario.water.temperature_C);
  assembly->clock = {FromSeconds(scenario.ball.clock_offset_s), scenario.ball.clock_drift_ppm};
  if (!scenario.network.pipes.empty() || !scenario.network.inp.empty()) {
    BuildWay(scenario, *assembly);
  } else if (!scenario.leaks.empty() || scenario.random_leaks.count > 0) {
    throw InputError("a leak needs a pipe, and this scenario has no network", "leaks");
  } else if (!scenario.sounds.empty()) {
    throw InputError("a sound needs a pipe, and this scenario has no network", "sounds");
  } else if (!scenario.wall_features.empty()) {
    throw InputError("a wall feature needs a pipe, and this scenario has no network", "wall_features");
  }
  assembly->scene =
      MakeAcousticScene(scenario, assembly->water, assembly->pipeline ? &*assembly->pipeline : nullptr,
                        assembly->bore ? &*assembly->bore : nullptr);
  if (assembly->pipeline) {
    for (std::string& note : AddSounds(scenario, *assembly->pipeline, assembly->scene))
      assembly->pipeline->notes.push_back(std::move(note));
  }
  BuildMotion(scenario, *assembly);
  BuildChannels(scenario, *assembly);
  WarnOfSound(scenario, *assembly);
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
