#include "sim/force_params.h"

#include <array>

namespace piperun::sim {

void ForceParams::Visit(ParamVisitor& v) {
  constexpr std::array<std::string_view, 6> kDrags{"brown_lawler",      "clift_gauvin", "clift_gauvin_1970",
                                                   "clift_grace_weber", "morrison",     "barati_high"};
  constexpr std::array<std::string_view, 5> kWallFactors{"kehlenbeck_di_felice", "di_felice", "munroe",
                                                         "newton", "none"};
  v.Choice({"drag", "Drag coefficient of the free sphere."}, kDrags, drag);
  v.Choice({"wall_factor", "How the tube around the ball raises its drag."}, kWallFactors, wall_factor);
  v.Flag({"rolling_drag", "More drag near the wall, as of a sphere that rolls along a plane."}, rolling_drag);
  v.Flag({"lift", "Lift away from the wall that the ball is close to."}, lift);
  v.Flag({"magnus", "Force across the relative velocity of a ball that spins."}, magnus);
  v.Flag({"spin_torque", "Torque of the water on a ball that spins."}, spin_torque);
  v.Flag({"rolling_resistance", "Torques of the wall against rolling and spinning."}, rolling_resistance);
  v.Flag({"fluid_acceleration", "Pressure gradient and added mass where the water accelerates or turns."},
         fluid_acceleration);
  v.Flag({"pressure_fall", "Pressure gradient of the pipe's friction."}, pressure_fall);
}

BallParams ApplyForces(BallParams ball, const ForceParams& forces) {
  if (forces.rolling_resistance) return ball;
  ball.rolling_resistance = 0;
  ball.spinning_resistance = 0;
  return ball;
}

void TurbulenceParams::Visit(ParamVisitor& v) {
  v.Flag({"on", "Whether the flow fluctuates."}, on);
  v.Number({"intensity", "Factor on the rms velocities of turbulent pipe flow."}, Range::Between(0, 3),
           intensity);
  v.Number({"kolmogorov_constant", "C0 of the Lagrangian structure function; sets the time scale T_L."},
           Range::Between(2, 10), kolmogorov_constant);
  v.Number({"time_scale_ratio", "T_2 / T_L: how long the acceleration remembers, over the velocity."},
           Range::Between(0.005, 0.9), time_scale_ratio);
  v.NumberOr({"filter", "Share of the rms velocity that a ball feels; by_size: less, the larger the ball."},
             Range::Between(0, 1), "by_size", filter);
}

void StreamParams::Visit(ParamVisitor& v) {
  constexpr std::array<std::string_view, 2> kProfiles{"power_law", "log_law"};
  v.Choice({"profile", "Mean velocity across a pipe in turbulent flow."}, kProfiles, profile);
  v.Flag({"secondary_flow", "Two counter-rotating cells in bends, fading behind them."}, secondary_flow);
  v.Number({"secondary_flow_amplitude", "A of their stream function A U (r/R) (1 - (r/R)^2) sin(theta) R."},
           Range::Between(0, 0.5), secondary_flow_amplitude);
  v.Flag({"swirl_switching", "A single cell behind bends that changes its sense at random."},
         swirl_switching);
  v.Struct({"turbulence", "Velocity fluctuations."}, turbulence);
}

}  // namespace piperun::sim
