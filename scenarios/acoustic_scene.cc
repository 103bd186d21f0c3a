#include "scenarios/acoustic_scene.h"

#include <cmath>
#include <string>

#include "base/check.h"
#include "scenarios/pipe_sound.h"
#include "scenarios/wave_table.h"

namespace piperun::scenarios {
namespace {

using acoustics::NodeEnd;

constexpr double kNoFlow_m3_s = 1e-9;

const sim::FlowReach& ReachAt(const Pipeline& pipeline, int pipe, bool at_to) {
  const auto& reaches = pipeline.flow.reaches(pipe);
  return at_to ? reaches.back() : reaches.front();
}

/// One for each node; `pipeline.hydraulics` tells that the network was not drawn pipe by pipe.
std::vector<NodeEnd> FindEnds(const Pipeline& pipeline) {
  const Network& network = pipeline.network;
  std::vector<int> pipes_at(network.nodes().size(), 0);
  for (const Pipe& pipe : network.pipes()) {
    ++pipes_at[static_cast<std::size_t>(pipe.from)];
    ++pipes_at[static_cast<std::size_t>(pipe.to)];
  }
  std::vector<NodeEnd> ends(network.nodes().size(), NodeEnd::kClosed);
  for (std::size_t i = 0; i < network.pipes().size(); ++i) {
    const Pipe& pipe = network.pipes()[i];
    for (const bool at_to : {false, true}) {
      const auto node = static_cast<std::size_t>(at_to ? pipe.to : pipe.from);
      const bool flows = std::abs(ReachAt(pipeline, static_cast<int>(i), at_to).flow_m3_s) > kNoFlow_m3_s;
      if (!pipeline.hydraulics && pipes_at[node] == 1 && flows) ends[node] = NodeEnd::kGoesOn;
    }
  }
  for (std::size_t node = 0; node < ends.size(); ++node) {
    if (network.nodes()[node].open_water) ends[node] = NodeEnd::kOpenWater;
  }
  return ends;
}

/// Ends a fitting's pipe in a node of its own, joined to the network by its resistance if water flows.
void AddResistance(const Pipeline& pipeline, int pipe, double specific_weight_N_m3,
                   acoustics::AcousticNetwork& network) {
  acoustics::AcousticPipe& fitting = network.pipes[static_cast<std::size_t>(pipe)];
  const int behind = fitting.to_node;
  fitting.to_node = static_cast<int>(network.ends.size());
  network.ends.push_back(NodeEnd::kClosed);
  const sim::FlowReach &first = ReachAt(pipeline, pipe, false), &last = ReachAt(pipeline, pipe, true);
  const double flow_m3_s = std::abs(first.flow_m3_s);
  const double drop_Pa = specific_weight_N_m3 * std::abs(first.head_begin_m - last.head_end_m);
  if (flow_m3_s < kNoFlow_m3_s || drop_Pa <= 0) return;
  network.links.push_back({fitting.to_node, behind, 2 * drop_Pa / flow_m3_s});
}

/// Throws with the key path of the pipe.
const acoustics::PipeWave& FindWave(const Pipeline& pipeline, std::size_t i, WaveTable& waves) {
  const Pipe& pipe = pipeline.network.pipes()[i];
  try {
    return waves.Find(MakePipeSection(pipe.diameter_m, pipe.wall_thickness_m, pipe.material,
                                      pipeline.drawing.pipes[i].sound));
  } catch (const InputError& e) {
    throw InputError("pipe '" + pipe.id + "': " + e.problem(),
                     "network.pipes[" + std::to_string(i) + "]." + e.key_path());
  }
}

}  // namespace

acoustics::AcousticNetwork MakeAcousticNetwork(const Pipeline& pipeline, const WaterProperties& water,
                                               double gravity_m_s2) {
  acoustics::AcousticNetwork network;
  WaveTable waves(water);
  for (std::size_t i = 0; i < pipeline.network.pipes().size(); ++i) {
    const Pipe& pipe = pipeline.network.pipes()[i];
    network.pipes.push_back({pipe.from, pipe.to, pipe.length_m, FindWave(pipeline, i, waves)});
  }
  network.ends = FindEnds(pipeline);
  for (std::size_t i = 0; i < network.pipes.size(); ++i) {
    if (!pipeline.network.pipes()[i].passable)
      AddResistance(pipeline, static_cast<int>(i), water.density_kg_m3 * gravity_m_s2, network);
  }
  for (std::size_t i = 0; i < pipeline.leaks.size(); ++i) {
    const Leak& leak = pipeline.leaks[i];
    const LeakState& state = pipeline.leak_states[i];
    if (state.flow_m3_s > 0 && state.pressure_drop_Pa > 0)
      network.holes.push_back({{leak.pipe, leak.s_m}, state.flow_m3_s / (2 * state.pressure_drop_Pa)});
  }
  return network;
}

acoustics::AcousticScene MakeAcousticScene(const Scenario& scenario, const WaterProperties& water,
                                           const Pipeline* pipeline, const sim::Bore* bore) {
  acoustics::AcousticScene scene;
  scene.ambient = scenario.ambient;
  scene.water = water;
  scene.ball = {scenario.ball.radius_m, scenario.ball.mass_kg(),
                scenario.ball.contact_stiffness_N_m.has_value()};
  if (!pipeline) return scene;
  scene.network = MakeAcousticNetwork(*pipeline, water, scenario.gravity_m_s2);
  for (int pipe = 0; pipe < static_cast<int>(scene.network.pipes.size()); ++pipe) {
    if (bore->open(pipe)) scene.listening_pipes.push_back(pipe);
  }
  const KindEntry drawn_sound = LeakEntry{}.sound;
  for (std::size_t i = 0; i < pipeline->leaks.size(); ++i) {
    const Leak& leak = pipeline->leaks[i];
    const KindEntry& sound = i < scenario.leaks.size() ? scenario.leaks[i].sound : drawn_sound;
    const auto& kind = FindKind(acoustics::LeakSoundKinds(), sound.kind());
    scene.leaks.push_back(
        {leak.id, leak.pipe, leak.s_m,
         kind.make(sound.params(), leak.hole_diameter_m, pipeline->leak_states[i], water.density_kg_m3)});
  }
  return scene;
}

}  // namespace piperun::scenarios
