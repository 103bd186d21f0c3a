#pragma once

#include "sim/ball_world.h"
#include "sim/motion.h"

namespace piperun::sim {

/// Whether drag and profile are known for this ball in this bore: d/D <= 0.95.
bool Fits(const BallParams& ball, double bore_radius_m);

/// Throws InputError (key ball.radius_m) for a ball that does not fit into the pipe it is launched into.
void RequireFit(const MotionContext& context);

/// At rest on the invert near the node where chainage begins, moved around the wall by an arc a ~ N(0,
/// lateral_sd): the angle is a/R. B: x along the pipe, z against gravity across the pipe, y = z x x to the
/// left.
BallStart MakeLaunch(const MotionContext& context, double lateral_sd_m);

}  // namespace piperun::sim
