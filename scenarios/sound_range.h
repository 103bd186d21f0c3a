#pragma once

#include <string>
#include <vector>

#include "acoustics/scene.h"
#include "base/network.h"

namespace piperun::scenarios {

/// Where a record up to `top_Hz` goes beyond what the waves of its pipes are good for: a sentence for the law
/// of the wall and one for the first cut-on, once for all pipes where the ball can be that carry the same
/// wave, with the numbers.
std::vector<std::string> WarnOfSoundRange(const Network& network, const acoustics::AcousticScene& scene,
                                          double top_Hz);

}  // namespace piperun::scenarios
