#pragma once

#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// Names of the wall materials in the library (assets/materials/*.yaml, part of the binary).
std::vector<std::string_view> MaterialNames();

/// Properties of a material of the library. `given` is returned instead once it has been filled, so that a
/// struct can be visited again without losing what its file said.
WallParams FindWall(std::string_view material, const WallParams& given);

}  // namespace piperun::scenarios
