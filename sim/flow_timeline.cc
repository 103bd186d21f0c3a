#include "sim/flow_timeline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "sim/pipe_flow.h"

namespace piperun::sim {
namespace {

void DemandSamePlaces(const FlowState& a, const FlowState& b) {
  const auto same = [](const FlowReach& x, const FlowReach& y) {
    return x.s_begin_m == y.s_begin_m && x.s_end_m == y.s_end_m;
  };
  for (std::size_t p = 0; p < a.pipes.size(); ++p) {
    Demand(std::equal(a.pipes[p].begin(), a.pipes[p].end(), b.pipes[p].begin(), b.pipes[p].end(), same),
           "reaches lie at the same places in all states");
  }
}

/// Along a reach and at one instant: flow is the same everywhere, head falls linearly.
FlowPoint EvalAlong(const FlowReach& reach, double s_m, double area_m2) {
  const double along = (s_m - reach.s_begin_m) / (reach.s_end_m - reach.s_begin_m);
  return {reach.flow_m3_s, reach.flow_m3_s / area_m2,
          reach.head_begin_m + along * (reach.head_end_m - reach.head_begin_m), reach.friction_factor, 0};
}

}  // namespace

FlowTimeline::FlowTimeline(std::vector<double> areas_m2, std::vector<TrueTime> times,
                           std::vector<FlowState> states, FrictionLaw friction)
    : areas_m2_(std::move(areas_m2)),
      times_(std::move(times)),
      states_(std::move(states)),
      friction_(std::move(friction)) {
  Demand(!states_.empty() && states_.size() == times_.size(), "one time per flow state");
  Demand(times_.front() == TrueTime{} &&
             std::adjacent_find(times_.begin(), times_.end(), std::greater_equal{}) == times_.end(),
         "the times of flow states increase from zero");
  Demand(states_.size() == 1 || friction_.relative_roughness.size() == areas_m2_.size(),
         "flow that changes needs the roughness of every pipe");
  for (const FlowState& state : states_) {
    Demand(state.pipes.size() == areas_m2_.size(), "a flow state holds every pipe");
    for (const auto& reaches : state.pipes) Demand(!reaches.empty(), "a pipe has at least one reach");
    DemandSamePlaces(states_.front(), state);
  }
}

std::size_t FlowTimeline::FindState(TrueTime t) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), t);
  return after == times_.begin() ? 0 : static_cast<std::size_t>(after - times_.begin()) - 1;
}

std::size_t FlowTimeline::FindReach(int pipe, double s_m) const {
  const std::vector<FlowReach>& along = reaches(pipe);
  std::size_t i = 0;
  while (i + 1 < along.size() && s_m >= along[i].s_end_m) ++i;
  return i;
}

double FlowTimeline::CalcFriction(std::size_t pipe, double velocity_m_s) const {
  const double diameter_m = std::sqrt(4 / std::numbers::pi * areas_m2_[pipe]);
  return CalcFrictionFactor(std::abs(velocity_m_s) * diameter_m / friction_.kinematic_viscosity_m2_s,
                            friction_.relative_roughness[pipe]);
}

FlowPoint FlowTimeline::Eval(int pipe, double s_m, TrueTime t) const {
  return EvalReach(pipe, FindReach(pipe, s_m), s_m, t);
}

FlowPoint FlowTimeline::EvalReach(int pipe, std::size_t reach, double s_m, TrueTime t) const {
  const auto p = static_cast<std::size_t>(pipe);
  const std::size_t i = FindState(t);
  const FlowPoint a = EvalAlong(states_[i].pipes[p][reach], s_m, areas_m2_[p]);
  if (i + 1 == states_.size() || t < times_[i]) return a;
  const FlowPoint b = EvalAlong(states_[i + 1].pipes[p][reach], s_m, areas_m2_[p]);
  const Duration step = times_[i + 1] - times_[i];
  const double share = static_cast<double>((t - times_[i]).count()) / static_cast<double>(step.count());
  FlowPoint point;
  point.flow_m3_s = a.flow_m3_s + share * (b.flow_m3_s - a.flow_m3_s);
  point.velocity_m_s = point.flow_m3_s / areas_m2_[p];
  point.head_m = a.head_m + share * (b.head_m - a.head_m);
  point.friction_factor = CalcFriction(p, point.velocity_m_s);
  point.dflow_dt_m3_s2 = (b.flow_m3_s - a.flow_m3_s) / Seconds(step);
  return point;
}

}  // namespace piperun::sim
