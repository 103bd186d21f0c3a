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
};

/// One hydraulic state of a whole network: the reaches of every pipe in order of s.
struct FlowState {
  std::vector<std::vector<FlowReach>> pipes;
};

/// The hydraulic state of a network over time, piecewise steady: state i holds from times[i] on. Everyone who
/// needs flow or pressure asks here.
class FlowTimeline {
 public:
  /// `areas_m2` per pipe. At least one state; times increase from zero.
  FlowTimeline(std::vector<double> areas_m2, std::vector<TrueTime> times, std::vector<FlowState> states);
  FlowPoint Eval(int pipe, double s_m, TrueTime t) const;
  const FlowState& state(TrueTime t) const;

 private:
  std::vector<double> areas_m2_;
  std::vector<TrueTime> times_;
  std::vector<FlowState> states_;
};

}  // namespace piperun::sim
