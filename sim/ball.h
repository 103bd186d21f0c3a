#pragma once

#include <optional>
#include <vector>

#include "base/params.h"

namespace piperun::sim {

/// Greatest d/D of a ball in a bore: drag and profile are known up to there, and beyond it jams at joints and
/// bends.
inline constexpr double kMaxDiameterRatio = 0.95;

/// The ball and what water and wall do to it. Defaults: a 60 mm prototype, slightly heavier than water.
///
/// k_spin is a calibration on Ellis (Can. J. Chem. Eng. 42 (1964), Capsules Part 5, abstract), who measured
/// v/U = 1.04 to 1.08 for spheres denser than water with d/D > 0.5 in a 32 mm pipe above 0.61 m/s. For SG 1.2
/// at 1 m/s and d/D = 0.6, 0.7, 0.8 our balance gives 1.046, 1.066, 1.080 with 0.6, and 1.012, 1.033, 1.044
/// with the full torque of a sphere far from walls (k_spin = 1). 0.5 to 0.75 stay within 0.02 of the band
/// from 0.7 to 1.5 m/s. Balls whose weight the lift takes off the wall slide, and are outside the
/// calibration.
struct BallParams {
  double radius_m = 0.03;
  double density_kg_m3 = 1100;            ///< mean density
  std::optional<double> given_mass_kg{};  ///< empty: from the density
  double inertia_factor = 0.4;            ///< I / (m r^2) about the centre of mass: 0.4 solid, 2/3 thin shell
  std::vector<double>
      inertia_kg_m2{};  ///< full tensor in B about the centre of mass, row by row; empty: isotropic
  Vector3d center_of_mass_B_m = Vector3d::Zero();  ///< from the centre of the sphere
  double roughness_m = 0;             ///< of the surface; 1e-3 of the diameter or more: no drag crisis
  double foam_thickness_m = 0;        ///< soft shell within `radius_m`; 0: none
  double friction = 0.4;              ///< sliding, ball on wet wall
  double rolling_resistance = 0.01;   ///< c_rr: resisting torque = c_rr r N
  double spinning_resistance = 0.01;  ///< c_sp: torque about the wall's normal = c_sp r N
  double restitution = 0;             ///< normal speed after an impact over the one before
  std::optional<double> added_mass_coefficient{};  ///< empty: by d/D (sim/added_mass.h)
  std::optional<double> contact_stiffness_N_m{};   ///< of ball and wall together; empty: rigid
  double contact_damping_N_s_m = 0;                ///< not read when rigid
  double spin_drag_factor = 0.6;    ///< k_spin: share of the free sphere's spin torque; see above
  double lift_coefficient = 0.2;    ///< C_L of the wall lift, +- 0.1
  double magnus_coefficient = 0.2;  ///< C_M per spin parameter w r / |u - v|, 0.1 to 0.4; C_M S <= 0.5
  double clock_offset_s = 0;
  double clock_drift_ppm = 0;

  double mass_kg() const;
  double volume_m3() const;
  /// Rough from 1e-3 of the diameter, or covered with foam (Achenbach, J. Fluid Mech. 65, 113 (1974)).
  bool suppresses_drag_crisis() const { return roughness_m >= 2e-3 * radius_m || foam_thickness_m > 0; }
  /// About the centre of mass, in B.
  Matrix3d Inertia_B_kg_m2() const;
  /// What the ranges in Visit cannot say; throws InputError: a tensor that is not symmetric, positive
  /// definite and a body's (each principal moment at most the sum of the others), a centre of mass or a foam
  /// shell that does not lie within the sphere.
  void Check() const;
  void Visit(ParamVisitor& v);
};

}  // namespace piperun::sim
