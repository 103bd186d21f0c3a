#pragma once

#include <string>
#include <vector>

#include "acoustics/scene.h"
#include "scenarios/pipeline.h"
#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Adds what a scenario's `sounds` say to a scene that has its pipes and leaks: sources of noise behind the
/// leaks, machines with tones, stretches of pipe with an extra loss. Flow and pressure are those at the
/// launch. Returns a note for every sound, and every leak, that no water flows or no pressure drives: it is
/// silent. Throws InputError ("sounds[i]...") for ids used twice, unknown pipes and nodes, places beyond a
/// pipe's end, an end before the beginning, and for what the kind refuses; "ambient.rolling..." for a band
/// that does not rise or that a hydrophone's rate does not reach.
std::vector<std::string> AddSounds(const Scenario& scenario, const Pipeline& pipeline,
                                   acoustics::AcousticScene& scene);

}  // namespace piperun::scenarios
