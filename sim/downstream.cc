#include "sim/downstream.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace piperun::sim {
namespace {

PipeEnd Other(PipeEnd end) { return {end.pipe, !end.at_to}; }

}  // namespace

Downstream::Downstream(const Bore& bore, const FlowTimeline& flow, TrueTime t)
    : bore_(bore), network_(bore.network()) {
  for (std::size_t i = 0; i < network_.pipes().size(); ++i) {
    const double middle_m = 0.5 * network_.pipes()[i].length_m;
    speed_m_s_.push_back(flow.Eval(static_cast<int>(i), middle_m, t).velocity_m_s);
  }
}

double Downstream::SpeedInto_m_s(PipeEnd end) const {
  const double speed = speed_m_s_[static_cast<std::size_t>(end.pipe)];
  return end.at_to ? -speed : speed;
}

bool Downstream::IsWay(PipeEnd end, double min_radius_m) const {
  const Pipe& pipe = network_.pipe(end.pipe);
  return bore_.open(end.pipe) && pipe.passable && pipe.radius_m() >= min_radius_m &&
         SpeedInto_m_s(end) > kStillWater_m_s;
}

bool Downstream::LeadsOn(int pipe, int node) const {
  const double speed = speed_m_s_[static_cast<std::size_t>(pipe)];
  if (std::abs(speed) <= kStillWater_m_s) return false;
  if (node < 0) return true;
  const int next = network_.NodeAt({pipe, speed > 0});
  return next == node || FindFastestWay(next, node, 0).has_value();
}

bool Downstream::LeadsAway(const Joint& joint) const {
  return std::any_of(joint.arms.begin(), joint.arms.end(),
                     [&](const JointArm& arm) { return SpeedInto_m_s(arm.end) > kStillWater_m_s; });
}

bool Downstream::LeadsIntoNarrower(const Joint& joint, double radius_m) const {
  return std::any_of(joint.arms.begin(), joint.arms.end(), [&](const JointArm& arm) {
    return arm.radius_m < radius_m && SpeedInto_m_s(arm.end) > kStillWater_m_s;
  });
}

std::optional<std::vector<RouteLeg>> Downstream::FindFastestWay(int from, int to, double min_radius_m) const {
  constexpr double kNever_s = std::numeric_limits<double>::infinity();
  const std::size_t nodes = network_.nodes().size();
  std::vector<double> arrival_s(nodes, kNever_s);
  std::vector<PipeEnd> entered(nodes);
  using Visit = std::pair<double, int>;  // arrival, node
  std::priority_queue<Visit, std::vector<Visit>, std::greater<>> open;
  arrival_s[static_cast<std::size_t>(from)] = 0;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [time_s, node] = open.top();
    open.pop();
    if (time_s > arrival_s[static_cast<std::size_t>(node)]) continue;
    for (const PipeEnd& end : network_.EndsAt(node)) {
      if (!IsWay(end, min_radius_m)) continue;
      const auto next = static_cast<std::size_t>(network_.NodeAt(Other(end)));
      const double next_s = time_s + network_.pipe(end.pipe).length_m / SpeedInto_m_s(end);
      if (next_s >= arrival_s[next]) continue;
      arrival_s[next] = next_s;
      entered[next] = end;
      open.emplace(next_s, static_cast<int>(next));
    }
  }
  if (arrival_s[static_cast<std::size_t>(to)] == kNever_s) return std::nullopt;
  std::vector<RouteLeg> legs;
  for (int node = to; node != from;) {
    const PipeEnd end = entered[static_cast<std::size_t>(node)];
    legs.push_back({end.pipe, end.at_to});
    node = network_.NodeAt(end);
  }
  std::reverse(legs.begin(), legs.end());
  return legs;
}

std::vector<RouteLeg> Downstream::FollowMainFlow(int from, double min_radius_m) const {
  std::vector<RouteLeg> legs;
  std::vector<bool> seen(network_.nodes().size());
  for (int node = from; !seen[static_cast<std::size_t>(node)];) {
    seen[static_cast<std::size_t>(node)] = true;
    std::optional<PipeEnd> main;
    double greatest_m3_s = 0;
    for (const PipeEnd& end : network_.EndsAt(node)) {
      const double flow_m3_s = SpeedInto_m_s(end) * network_.pipe(end.pipe).area_m2();
      if (!IsWay(end, min_radius_m) || flow_m3_s <= greatest_m3_s) continue;
      greatest_m3_s = flow_m3_s;
      main = end;
    }
    if (!main) break;
    legs.push_back({main->pipe, main->at_to});
    node = network_.NodeAt(Other(*main));
  }
  return legs;
}

}  // namespace piperun::sim
