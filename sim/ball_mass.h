#pragma once

#include "sim/ball.h"

namespace piperun::sim {

/// The mass matrix of a ball together with the water that moves with it.
///
/// For a sphere the added mass m_a acts as a point mass at its centre B, without moment of inertia (potential
/// flow). With the ball's own m at its centre of mass C, p_BC = r, kinetic energy is that of one rigid body,
///
///   M = m + m_a,   p_BM = m r / M,   I' = I_C + m m_a/M (|r|^2 E - r r^T)   about M
///
/// (mechanics; exact). Weight acts at C, buoyancy and the water's loads at B: both have a moment about M.
struct BallMass {
  double mass_kg = 0;                           ///< M
  Vector3d p_BM_B = Vector3d::Zero();           ///< from the sphere's centre, m
  Matrix3d inertia_B_kg_m2 = Matrix3d::Zero();  ///< I'
};

/// `added_mass_kg` >= 0, the same in every direction.
BallMass CalcBallMass(const BallParams& ball, double added_mass_kg);

/// Angular frequency at which a mass bounces on a contact of this stiffness, sqrt(k/M); undamped.
/// An impact takes about half a period, pi/omega.
double CalcContactFrequency_rad_s(double stiffness_N_m, double mass_kg);

}  // namespace piperun::sim
