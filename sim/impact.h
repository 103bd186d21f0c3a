#pragma once

namespace piperun::sim {

/// A sphere in front of a wall at the beginning of a step; its gap z follows z + z' t + z'' t^2/2 until it is
/// closed.
struct WallApproach {
  double gap_m = 0;              ///< z
  double speed_m_s = 0;          ///< z'; negative: it closes
  double acceleration_m_s2 = 0;  ///< z'': of the loads, and of a wall that curves towards the path
};

/// Impacts slower than this, or than twice what the acceleration adds in a step, leave without a rebound.
inline constexpr double kLeastImpactSpeed_m_s = 0.01;

/// Speed at which the gap closes within the coming step, sqrt(z'^2 - 2 z'' z); 0 when it stays open, and when
/// the sphere merely follows the wall: no more than |z''| dt.
double CalcClosingSpeed_m_s(const WallApproach& approach, double dt_s);

/// The gap at the end of the step in which the sphere hits the wall and leaves it at `restitution` times the
/// closing speed v_c: on the parabola that left the wall with that energy, at the height where the sphere was
/// when the step began,
///
///   z(dt) = z + u dt + z'' dt^2/2,  u^2 = (e v_c)^2 + 2 z'' z;
///
/// so a ball under steady load rises to e^2 of the height it fell from, exactly, whenever within a step it
/// hits. 0 where it does not rebound: slow impacts, and those too weak to come up to z again.
double CalcReboundGap_m(const WallApproach& approach, double restitution, double dt_s);

}  // namespace piperun::sim
