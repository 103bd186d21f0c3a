#include "sim/flow_timeline.h"

#include <algorithm>

#include "base/check.h"

namespace piperun::sim {
namespace {

const FlowReach& FindReach(const std::vector<FlowReach>& reaches, double s_m) {
  std::size_t i = 0;
  while (i + 1 < reaches.size() && s_m >= reaches[i].s_end_m) ++i;
  return reaches[i];
}

}  // namespace

FlowTimeline::FlowTimeline(std::vector<double> areas_m2, std::vector<TrueTime> times,
                           std::vector<FlowState> states)
    : areas_m2_(std::move(areas_m2)), times_(std::move(times)), states_(std::move(states)) {
  Demand(!states_.empty() && states_.size() == times_.size(), "one time per flow state");
  Demand(times_.front() == TrueTime{} &&
             std::adjacent_find(times_.begin(), times_.end(), std::greater_equal{}) == times_.end(),
         "the times of flow states increase from zero");
  for (const FlowState& state : states_) {
    Demand(state.pipes.size() == areas_m2_.size(), "a flow state holds every pipe");
    for (const auto& reaches : state.pipes) Demand(!reaches.empty(), "a pipe has at least one reach");
  }
}

const FlowState& FlowTimeline::state(TrueTime t) const {
  std::size_t i = states_.size() - 1;
  while (i > 0 && t < times_[i]) --i;
  return states_[i];
}

FlowPoint FlowTimeline::Eval(int pipe, double s_m, TrueTime t) const {
  const auto p = static_cast<std::size_t>(pipe);
  const FlowReach& reach = FindReach(state(t).pipes[p], s_m);
  const double along = (s_m - reach.s_begin_m) / (reach.s_end_m - reach.s_begin_m);
  return {reach.flow_m3_s, reach.flow_m3_s / areas_m2_[p],
          reach.head_begin_m + along * (reach.head_end_m - reach.head_begin_m), reach.friction_factor};
}

}  // namespace piperun::sim
