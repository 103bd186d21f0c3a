#pragma once

#include <vector>

#include "base/time.h"

namespace piperun::sim {

/// Water in a stretch of pipe without inflow or outflow.
struct FlowReach {
  double s_begin_m = 0;  ///< along the pipe from its `from` node
  double s_end_m = 0;
  double flow_m3_s = 0;     ///< positive from `from` to `to`
  double head_begin_m = 0;  ///< piezometric head (elevation + pressure head) at s_begin
  double head_end_m = 0;
  double friction_factor = 0;  ///< Darcy
};

/// Water at one place and time.
struct FlowPoint {
  double flow_m3_s = 0;
  double velocity_m_s = 0;  ///< Q/A, positive from `from` to `to`
  double head_m = 0;
  double friction_factor = 0;
  double dflow_dt_m3_s2 = 0;  ///< dQ/dt
};

/// One hydraulic state of a whole network: the reaches of every pipe in order of s.
struct FlowState {
  std::vector<std::vector<FlowReach>> pipes;
};

/// What friction between two hydraulic states follows from: Re = U D/nu and e/D, by sim/pipe_flow.h.
struct FrictionLaw {
  std::vector<double> relative_roughness;  ///< e/D per pipe, in [0, 0.05]
  double kinematic_viscosity_m2_s = 0;
};

/// The hydraulic state of a network over time. State i is that of times[i]; between two instants flow and
/// head go over linearly from one to the next, so that a flow that turns round passes through zero; before
/// the first and after the last they stay. Everyone who needs flow or pressure asks here.
class FlowTimeline {
 public:
  /// `areas_m2` per pipe. At least one state; times increase from zero; reaches lie at the same places in all
  /// states (aborts). More than one state needs `friction`: a friction factor is not linear in the flow, it
  /// is worked out anew from the flow of the moment.
  FlowTimeline(std::vector<double> areas_m2, std::vector<TrueTime> times, std::vector<FlowState> states,
               FrictionLaw friction = {});

  /// Flow at s (the first or last reach goes on beyond the pipe's ends). No allocation.
  FlowPoint Eval(int pipe, double s_m, TrueTime t) const;
  /// The same in one reach of the pipe, which need not hold s.
  FlowPoint EvalReach(int pipe, std::size_t reach, double s_m, TrueTime t) const;
  std::size_t FindReach(int pipe, double s_m) const;
  /// Where the reaches of a pipe lie (their flows are those of time zero).
  const std::vector<FlowReach>& reaches(int pipe) const {
    return states_.front().pipes[static_cast<std::size_t>(pipe)];
  }
  /// The last state whose time is not after t.
  const FlowState& state(TrueTime t) const { return states_[FindState(t)]; }

 private:
  std::size_t FindState(TrueTime t) const;
  double CalcFriction(std::size_t pipe, double velocity_m_s) const;

  std::vector<double> areas_m2_;
  std::vector<TrueTime> times_;
  std::vector<FlowState> states_;
  FrictionLaw friction_;
};

}  // namespace piperun::sim
