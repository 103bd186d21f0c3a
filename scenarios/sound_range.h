#pragma once

#include <string>
#include <vector>

#include "acoustics/scene.h"
#include "base/network.h"

namespace piperun::scenarios {

/// Where a record up to `top_Hz` goes beyond what the waves of the pipes where the ball can be are good for:
/// a sentence for the law of the wall and one for the first cut-on, with the lowest limit, the pipes that
/// have it, and how many others the record is too high for.
std::vector<std::string> WarnOfSoundRange(const Network& network, const acoustics::AcousticScene& scene,
                                          double top_Hz);

}  // namespace piperun::scenarios
