#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sim/ball.h"

namespace piperun::scenarios {

/// A ball of the library (assets/balls/*.yaml, part of the binary; every value with its source there).
struct BallPreset {
  std::string_view name;
  std::string description;
  sim::BallParams ball;
};

/// In alphabetical order. "none" first: no preset, the defaults of sim::BallParams.
std::span<const BallPreset> BallPresets();
std::span<const std::string_view> BallPresetNames();

/// A ball of the library by its name (aborts on another one).
const sim::BallParams& FindBall(std::string_view preset);

}  // namespace piperun::scenarios
