#pragma once

namespace piperun::sim {

/// A wall or a ball that gives way: the overlap x >= 0 is pressed with k x + c dx/dt >= 0.
struct ContactCompliance {
  double stiffness_N_m = 0;  ///< k
  double damping_N_s_m = 0;  ///< c
};

/// A sphere at a wall that gives way, at the beginning of a step.
struct SoftApproach {
  double gap_m = 0;         ///< negative: overlap
  double speed_m_s = 0;     ///< of the gap, over the step before
  double impact_rad_s = 0;  ///< frequency of the sphere's mass on the contact, sqrt(k/M)
};

/// The force of a soft contact over a step, F = d (u - v) >= 0, v the speed of the gap over the step; d = 0:
/// none.
struct SoftForce {
  double firmness_N_s_m = 0;  ///< d
  double speed_m_s = 0;       ///< u
};

/// Longest step over which an impact is followed with second order, times sqrt(k/M): 6 steps to a contact.
inline constexpr double kResolvedImpact_rad = 0.5;

/// As the mean over the step before and the coming one (Newmark's method, J. Eng. Mech. Div. ASCE 85 (1959),
/// with beta = 1/4),
///
///   F = k (x + dt (x'+ - x'-)/4) + c (x'+ + x'-)/2,   x = -gap,
///
/// while the ball overlaps the wall: of second order and without losses of its own where c = 0; an impact on
/// a damped contact is of first order, since it may begin anywhere within a step. Steps longer than
/// kResolvedImpact_rad / sqrt(k/M) take the force at their end, k (x + dt x'+) + c x'+, of first order:
/// stable at any stiffness, but it swallows rebounds.
SoftForce CalcSoftForce(const ContactCompliance& compliance, const SoftApproach& approach, double dt_s);

}  // namespace piperun::sim
