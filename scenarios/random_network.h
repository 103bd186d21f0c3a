#pragma once

#include <cstdint>
#include <string>

#include "scenarios/scenario.h"

namespace piperun::scenarios {

/// A small network nobody has designed, as an EPANET file, and a ball in it: a pure function of (seed,
/// index).
///
/// A feed, and four to nine pipes of 1 to 5 m that branch at any angle above 35 degrees, a fifth of them
/// vertical, bores of 52 to 200 mm (some too narrow for the ball), now and then a corner in a pipe or a loop
/// that closes the network. Half of the ends draw water, the others are dead. Mean speed in the first pipe
/// 0.2 to 1.5 m/s; balls of 30 to 70 mm, from a little lighter to a third heavier than water.
Scenario MakeRandomNetwork(std::uint64_t seed, std::uint64_t index);

/// A horizontal junction of three pipes of 150 mm, as an EPANET file, with a 60 mm ball launched 4 m ahead of
/// it. The two ways on leave at the angles given (from straight ahead, to the left) and share the flow:
/// `share` goes down the second.
Scenario MakeBranching(double straight_deg, double branch_deg, double share, double speed_m_s);

}  // namespace piperun::scenarios
