#pragma once

#include "base/params.h"

namespace piperun::sim {

/// The ball and what water and wall do to it. Defaults: a 60 mm prototype, slightly heavier than water.
struct BallParams {
  double radius_m = 0.03;
  double density_kg_m3 = 1100;            ///< mean density
  double inertia_factor = 0.4;            ///< I / (m r^2): 0.4 solid, 2/3 thin shell
  double friction = 0.4;                  ///< sliding, ball on wet wall
  double rolling_resistance = 0.01;       ///< c_rr: resisting torque = c_rr r N
  double added_mass_coefficient = 0.62;   ///< touching a wall, along it
  double spin_drag_factor = 0.25;         ///< k_spin, calibrated on Ellis 1964
  double clock_offset_s = 0;
  double clock_drift_ppm = 0;

  double mass_kg() const;
  double volume_m3() const;
  void Visit(ParamVisitor& v);
};

}  // namespace piperun::sim
