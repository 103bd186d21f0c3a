#include "scenarios/sound_list.h"

#include <algorithm>
#include <cmath>

#include "acoustics/hydrophone.h"
#include "acoustics/sound.h"
#include "base/check.h"
#include "base/number.h"
#include "scenarios/network_params.h"

namespace piperun::scenarios {
namespace {

/// The end at a node of the first pipe there.
acoustics::PipePlace FindPlaceAtNode(const Network& network, const std::string& id, const std::string& key) {
  const int node = network.RequireNode(id, key);
  for (std::size_t i = 0; i < network.pipes().size(); ++i) {
    const Pipe& pipe = network.pipes()[i];
    if (pipe.from == node) return {static_cast<int>(i), 0};
    if (pipe.to == node) return {static_cast<int>(i), pipe.length_m};
  }
  throw InputError("no pipe ends at node '" + id + "'", key);
}

acoustics::PipePlace FindPlace(const SoundEntry& entry, const Network& network, const std::string& key) {
  if (entry.pipe.empty() == entry.node.empty()) {
    throw InputError("a sound is in a pipe or at a node; give one of them", key + ".pipe");
  }
  if (!entry.node.empty()) return FindPlaceAtNode(network, entry.node, key + ".node");
  const acoustics::PipePlace place{network.RequirePipe(entry.pipe, key + ".pipe"), entry.s_m};
  const double length_m = network.pipe(place.pipe).length_m;
  if (place.s_m <= length_m) return place;
  throw InputError(FormatNumber(place.s_m) + " is beyond the end of pipe '" + entry.pipe +
                       "'; allowed: [0, " + FormatNumber(length_m) + "]",
                   key + ".s_m");
}

acoustics::SoundingTimes MakeTimes(const SoundEntry& entry, const std::string& key) {
  acoustics::SoundingTimes times;
  times.ramp_s = entry.ramp_s;
  if (entry.on_s) times.on_s = *entry.on_s;
  if (entry.off_s) times.off_s = *entry.off_s;
  if (times.off_s > times.on_s) return times;
  throw InputError(
      FormatNumber(times.off_s) + " is not allowed; it must be above on_s, " + FormatNumber(times.on_s),
      key + ".off_s");
}

acoustics::SoundSite FindSite(const Pipeline& pipeline, const acoustics::AcousticScene& scene,
                              const acoustics::PipePlace& place, double gravity_m_s2) {
  const sim::FlowPoint flow = pipeline.flow.Eval(place.pipe, place.s_m, TrueTime{});
  const double elevation_m = pipeline.network.pipe(place.pipe).Eval(place.s_m).p_W.z();
  return {scene.network.pipes[static_cast<std::size_t>(place.pipe)].wave, scene.water,
          std::abs(flow.flow_m3_s), scene.water.density_kg_m3 * gravity_m_s2 * (flow.head_m - elevation_m)};
}

acoustics::SiteSound MakeSound(const SoundEntry& entry, const acoustics::SoundSite& site,
                               const std::string& key) {
  const auto& kinds = acoustics::SoundKinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == entry.kind.kind(); });
  Demand(kind != kinds.end(), "a kind's name was checked when the scenario was read");
  try {
    return kind->make(entry.kind.params(), site);
  } catch (const InputError& e) {
    throw InputError(e.problem(), key + "." + e.key_path());
  }
}

void RequireWithinPipe(const acoustics::SiteSound& sound, const acoustics::PipePlace& place,
                       double pipe_length_m, const std::string& key) {
  const double room_m = 2 * std::min(place.s_m, pipe_length_m - place.s_m);
  if (sound.loss_length_m <= room_m) return;
  throw InputError(FormatNumber(sound.loss_length_m) + " is not allowed; centred here, at most " +
                       FormatDigits(room_m, 6) + " m lie within the pipe: give each pipe a pocket of its own",
                   key + ".length_m");
}

void Add(acoustics::SiteSound sound, const std::string& id, const acoustics::PipePlace& place,
         const acoustics::SoundingTimes& times, acoustics::AcousticScene& scene) {
  if (sound.loss_Np_m > 0) {
    scene.network.pipes[static_cast<std::size_t>(place.pipe)].local_losses.push_back(
        {place.s_m - sound.loss_length_m / 2, place.s_m + sound.loss_length_m / 2, sound.loss_Np_m});
  }
  if (sound.noise)
    scene.leaks.push_back({id, place.pipe, place.s_m, std::move(sound.noise), sound.role, times});
  if (!sound.tones.empty()) scene.tones.push_back({id, place.pipe, place.s_m, times, std::move(sound.tones)});
}

void RequireOwnId(const Scenario& scenario, const Pipeline& pipeline, std::size_t i, const std::string& key) {
  const std::string& id = scenario.sounds[i].id;
  RequirePlainId(id, key + ".id");
  const auto same = [&](const auto& other) { return other.id == id; };
  const auto begin = scenario.sounds.begin();
  if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(i), same) ||
      std::any_of(pipeline.leaks.begin(), pipeline.leaks.end(), same)) {
    throw InputError("'" + id + "' is used twice; ids of sounds and leaks must be unique", key + ".id");
  }
}

void RequireAudibleRolling(const Scenario& scenario) {
  const acoustics::RollingParams& rolling = scenario.ambient.rolling;
  if (!rolling.on) return;
  try {
    rolling.Check();
  } catch (const InputError& e) {
    throw InputError(e.problem(), "ambient.rolling." + e.key_path());
  }
  for (const SensorEntry& entry : scenario.sensors) {
    const auto* params = dynamic_cast<const acoustics::HydrophoneParams*>(&entry.kind.params());
    if (!params || rolling.low_Hz < 0.5 * params->rate_Hz) continue;
    throw InputError(FormatNumber(rolling.low_Hz) +
                         " is not allowed; the band must begin below half the rate of '" + entry.name +
                         "', " + FormatNumber(0.5 * params->rate_Hz) + " Hz",
                     "ambient.rolling.low_Hz");
  }
}

}  // namespace

std::vector<std::string> AddSounds(const Scenario& scenario, const Pipeline& pipeline,
                                   acoustics::AcousticScene& scene) {
  RequireAudibleRolling(scenario);
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < scenario.sounds.size(); ++i) {
    const SoundEntry& entry = scenario.sounds[i];
    const std::string key = "sounds[" + std::to_string(i) + "]";
    RequireOwnId(scenario, pipeline, i, key);
    const acoustics::PipePlace place = FindPlace(entry, pipeline.network, key);
    const acoustics::SoundingTimes times = MakeTimes(entry, key);
    acoustics::SiteSound sound =
        MakeSound(entry, FindSite(pipeline, scene, place, scenario.gravity_m_s2), key);
    RequireWithinPipe(sound, place, pipeline.network.pipe(place.pipe).length_m, key);
    if (!sound.noise && sound.tones.empty() && sound.loss_Np_m == 0) {
      notes.push_back("sound '" + entry.id + "' is silent: no water flows, or no pressure drives it");
    }
    Add(std::move(sound), entry.id, place, times, scene);
  }
  return notes;
}

}  // namespace piperun::scenarios
