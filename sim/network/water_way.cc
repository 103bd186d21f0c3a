#include "sim/network/water_way.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "sim/ball.h"

namespace piperun::sim {
namespace {

double Length_m(const HydraulicModel& model, int link) {
  return link < model.first_pump() ? model.pipes[link].length_m : 0;
}

/// Nearest in time first.
struct IsLater {
  bool operator()(const WayPoint& a, const WayPoint& b) const { return a.time_s > b.time_s; }
};

}  // namespace

double Bore_m(const HydraulicModel& model, int link) {
  if (link < model.first_pump()) return model.pipes[link].diameter_m;
  if (link < model.first_valve()) return 0;
  return model.valves[link - model.first_valve()].diameter_m;
}

const char* ObstacleText(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::kNone:
      return "passes";
    case Obstacle::kTooNarrow:
      return "too narrow";
    case Obstacle::kClosed:
      return "closed";
    case Obstacle::kPump:
      return "pump";
    case Obstacle::kCheckValve:
      return "check valve";
    case Obstacle::kControlValve:
      return "control valve";
  }
  return "";
}

bool IsWideOpen(ValveKind kind, LinkStatus status, double setting, double minor_loss) {
  if (IsClosed(status)) return false;
  if (status == LinkStatus::kOpen && std::isnan(setting)) return true;
  if (kind == ValveKind::kThrottle) return setting <= minor_loss;
  return kind == ValveKind::kPositional && setting >= 100;
}

Obstacle FindObstacle(const HydraulicModel& model, const HydraulicState& state, int link,
                      double ball_diameter_m) {
  if (link >= model.first_pump() && link < model.first_valve()) return Obstacle::kPump;
  if (IsClosed(state.status[link])) return Obstacle::kClosed;
  if (ball_diameter_m > kMaxDiameterRatio * Bore_m(model, link)) return Obstacle::kTooNarrow;
  if (link < model.first_pump()) {
    return model.pipes[link].check_valve ? Obstacle::kCheckValve : Obstacle::kNone;
  }
  const ValveLink& valve = model.valves[link - model.first_valve()];
  const bool is_open = IsWideOpen(valve.kind, state.status[link], state.setting[link], valve.minor_loss);
  return is_open ? Obstacle::kNone : Obstacle::kControlValve;
}

double CalcSpeed_m_s(const HydraulicModel& model, const HydraulicState& state, int link) {
  const double bore = Bore_m(model, link);
  if (bore == 0 || IsClosed(state.status[link])) return 0;
  return std::abs(state.flow_m3_s[link]) / (std::numbers::pi / 4 * bore * bore);
}

WaterWays::WaterWays(const HydraulicModel& model, const HydraulicState& state, double ball_diameter_m)
    : model_(model),
      state_(state),
      ball_diameter_m_(ball_diameter_m),
      onward_(static_cast<std::size_t>(model.node_count())),
      blocked_(onward_.size()) {
  for (int link = 0; link < model.link_count(); ++link) AddStretch(link);
}

void WaterWays::AddStretch(int link) {
  const double flow = state_.flow_m3_s[link], speed = CalcSpeed_m_s(model_, state_, link);
  const int from = flow > 0 ? model_.From(link) : model_.To(link);
  const int to = flow > 0 ? model_.To(link) : model_.From(link);
  const Obstacle obstacle = FindObstacle(model_, state_, link, ball_diameter_m_);
  if (obstacle == Obstacle::kNone && speed >= kLeastSpeed_m_s) {
    const double length = Length_m(model_, link);
    onward_[from].push_back({link, to, std::abs(flow), length / speed, length});
  } else if (speed >= kLeastSpeed_m_s || (obstacle == Obstacle::kPump && !IsClosed(state_.status[link]))) {
    blocked_[from] = true;
  }
}

std::vector<WayPoint> WaterWays::FindReachable(int from) const {
  std::vector<WayPoint> reached;
  std::vector<bool> done(onward_.size());
  std::priority_queue<WayPoint, std::vector<WayPoint>, IsLater> front;
  front.push({from, -1, 0, 0});
  while (!front.empty()) {
    const WayPoint here = front.top();
    front.pop();
    if (done[here.node]) continue;
    done[here.node] = true;
    reached.push_back(here);
    if (IsEnd(here.node) && here.link >= 0) continue;
    for (const Stretch& s : onward_[here.node]) {
      if (!done[s.node]) front.push({s.node, s.link, here.time_s + s.time_s, here.distance_m + s.length_m});
    }
  }
  return reached;
}

std::optional<WaterWay> WaterWays::FindFastest(int from, int to) const {
  const std::vector<WayPoint> reached = FindReachable(from);
  const auto find = [&](int node) {
    return std::find_if(reached.begin(), reached.end(), [&](const WayPoint& p) { return p.node == node; });
  };
  auto point = find(to);
  if (point == reached.end()) return std::nullopt;
  WaterWay way{{*point}, WayEnd::kArrived};
  while (point->link >= 0) {
    const int end = model_.To(point->link);
    point = find(end == point->node ? model_.From(point->link) : end);
    way.points.push_back(*point);
  }
  std::reverse(way.points.begin(), way.points.end());
  return way;
}

WaterWay WaterWays::FollowMainFlow(int from, std::optional<int> to) const {
  WaterWay way{{{from, -1, 0, 0}}, WayEnd::kArrived};
  std::vector<bool> visited(onward_.size());
  while (way.points.back().node != to) {
    const WayPoint here = way.points.back();
    visited[here.node] = true;
    const auto& onward = onward_[here.node];
    const auto most = std::max_element(onward.begin(), onward.end(), [](const Stretch& a, const Stretch& b) {
      return a.flow_m3_s < b.flow_m3_s;
    });
    if (IsEnd(here.node) && here.link >= 0) {
      way.end = WayEnd::kLeavesNetwork;
      return way;
    }
    if (most == onward.end() || visited[most->node]) {
      way.end = blocked_[here.node] ? WayEnd::kBlocked : WayEnd::kDeadEnd;
      return way;
    }
    way.points.push_back(
        {most->node, most->link, here.time_s + most->time_s, here.distance_m + most->length_m});
  }
  return way;
}

}  // namespace piperun::sim
