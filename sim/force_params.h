#pragma once

#include <optional>
#include <string>

#include "base/params.h"
#include "sim/ball.h"

namespace piperun::sim {

/// Which laws act on a ball in a pipe. Every one can be exchanged or switched off, to see what it does; their
/// coefficients are the ball's (sim/ball.h). Sources, ranges and how sure each is: docs/physics.md.
struct ForceParams {
  std::string drag = "brown_lawler";                 ///< C_D of the free sphere
  std::string wall_factor = "kehlenbeck_di_felice";  ///< what the tube around the ball adds
  bool rolling_drag = true;                          ///< what the wall next to the ball adds
  bool lift = true;
  bool magnus = true;
  bool spin_torque = true;
  bool rolling_resistance = true;
  bool fluid_acceleration = true;
  bool pressure_fall = true;

  void Visit(ParamVisitor& v);
};

/// The ball with the resistances of the wall that act on it.
BallParams ApplyForces(BallParams ball, const ForceParams& forces);

/// Velocity fluctuations that the ball meets on its way (sim/turbulence.h).
struct TurbulenceParams {
  bool on = false;
  double intensity = 1;            ///< factor on the rms velocities of pipe flow
  double kolmogorov_constant = 5;  ///< C0, 4 to 6: sets the time scale
  double time_scale_ratio = 0.1;   ///< T_2 / T_L
  std::optional<double> filter;    ///< share of the rms that a ball of this size feels; nothing: by its size

  void Visit(ParamVisitor& v);
};

/// The flow in a pipe beyond its bulk speed.
struct StreamParams {
  std::string profile = "power_law";
  bool secondary_flow = true;  ///< cells across the pipe in bends and behind them
  double secondary_flow_amplitude = 0.15;
  bool swirl_switching = false;
  TurbulenceParams turbulence;

  void Visit(ParamVisitor& v);
};

}  // namespace piperun::sim
