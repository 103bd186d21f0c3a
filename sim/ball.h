#pragma once

#include <optional>

#include "base/params.h"

namespace piperun::sim {

/// The ball and what water and wall do to it. Defaults: a 60 mm prototype, slightly heavier than water.
///
/// k_spin is a calibration on Ellis (Can. J. Chem. Eng. 42 (1964), Capsules Part 5, abstract), who measured
/// v/U = 1.04 to 1.08 for spheres denser than water with d/D > 0.5 in a 32 mm pipe above 0.61 m/s. For SG 1.2
/// at 1.2 m/s and d/D = 0.6, 0.7, 0.8 our balance gives 1.045, 1.074, 1.081 with 0.6, and 1.006, 1.035, 1.048
/// with the full torque of a sphere far from walls (k_spin = 1). 0.5 to 0.75 stay within 0.02 of the band.
struct BallParams {
  double radius_m = 0.03;
  double density_kg_m3 = 1100;                    ///< mean density
  double inertia_factor = 0.4;                    ///< I / (m r^2): 0.4 solid, 2/3 thin shell
  double friction = 0.4;                          ///< sliding, ball on wet wall
  double rolling_resistance = 0.01;               ///< c_rr: resisting torque = c_rr r N
  double added_mass_coefficient = 0.62;           ///< touching a wall, along it
  std::optional<double> contact_stiffness_N_m{};  ///< of ball and wall together; empty: rigid
  double contact_damping_N_s_m = 0;               ///< not read when rigid
  double spin_drag_factor = 0.6;  ///< k_spin: share of the free sphere's spin torque; see above
  double clock_offset_s = 0;
  double clock_drift_ppm = 0;

  double mass_kg() const;
  double volume_m3() const;
  void Visit(ParamVisitor& v);
};

}  // namespace piperun::sim
