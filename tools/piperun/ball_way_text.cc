#include "tools/piperun/ball_way_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "sim/ball.h"
#include "tools/piperun/long_table.h"
#include "tools/piperun/number_text.h"

namespace piperun::tools {
namespace {

using sim::HydraulicModel;

/// A row of the summary: links of one bore with one fate.
struct BoreGroup {
  double bore_m = 0;
  sim::Obstacle obstacle = sim::Obstacle::kNone;
  std::size_t links = 0;
  double length_m = 0;
};

std::vector<BoreGroup> GroupByBore(const HydraulicModel& model, const sim::HydraulicState& state,
                                   double diameter_m) {
  std::vector<BoreGroup> groups;
  for (int i = 0; i < model.link_count(); ++i) {
    const double bore = sim::Bore_m(model, i);
    const sim::Obstacle obstacle = FindObstacle(model, state, i, diameter_m);
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const BoreGroup& g) { return g.bore_m == bore && g.obstacle == obstacle; });
    if (group == groups.end()) group = groups.insert(groups.end(), {bore, obstacle});
    ++group->links;
    if (i < model.first_pump()) group->length_m += model.pipes[i].length_m;
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const BoreGroup& a, const BoreGroup& b) { return a.bore_m < b.bore_m; });
  return groups;
}

std::string BoreCell(double bore_m) { return bore_m > 0 ? Fixed(1000 * bore_m, 1) : "-"; }

std::string RatioCell(double diameter_m, double bore_m) {
  return bore_m > 0 ? Fixed(diameter_m / bore_m, 2) : "-";
}

std::string BoreTable(const HydraulicModel& model, const sim::HydraulicState& state, double diameter_m) {
  Table table({"bore_mm", "d/D", "ball", "links", "length_m"});
  for (const BoreGroup& group : GroupByBore(model, state, diameter_m)) {
    table.Add({BoreCell(group.bore_m), RatioCell(diameter_m, group.bore_m), ObstacleText(group.obstacle),
               std::to_string(group.links), Fixed(group.length_m, 1)});
  }
  return table.Text();
}

/// Every link when `whole`, else those the ball does not pass.
std::string PassageTable(const HydraulicModel& model, const sim::HydraulicState& state, double diameter_m,
                         bool whole) {
  LongTable table({"link", "kind", "bore_mm", "d/D", "ball"}, whole);
  for (int i = 0; i < model.link_count(); ++i) {
    const sim::Obstacle obstacle = FindObstacle(model, state, i, diameter_m);
    if (!whole && obstacle == sim::Obstacle::kNone) continue;
    const double bore = sim::Bore_m(model, i);
    table.Add({model.LinkId(i), scenarios::LinkKind(model, i), BoreCell(bore), RatioCell(diameter_m, bore),
               ObstacleText(obstacle)});
  }
  return table.empty() ? "" : "\n" + table.Text("links");
}

std::string PassageText(const HydraulicModel& model, const sim::HydraulicState& state, double diameter_m,
                        bool whole) {
  std::size_t passable = 0;
  double passable_m = 0, length_m = 0;
  for (int i = 0; i < model.first_pump(); ++i) {
    const bool passes = FindObstacle(model, state, i, diameter_m) == sim::Obstacle::kNone;
    passable += passes ? 1 : 0;
    passable_m += passes ? model.pipes[i].length_m : 0;
    length_m += model.pipes[i].length_m;
  }
  return fmt::format(
             "\nA ball of {:.4g} mm passes {} of {}, {:.2f} of {:.2f} km; it may fill {:.2f} of a bore\n",
             1000 * diameter_m, passable, Counted(model.pipes.size(), "pipe"), passable_m / 1000,
             length_m / 1000, sim::kMaxDiameterRatio) +
         BoreTable(model, state, diameter_m) + PassageTable(model, state, diameter_m, whole);
}

std::string WayText(const HydraulicModel& model, const sim::HydraulicState& state, const sim::WaterWay& way,
                    bool whole) {
  LongTable table({"by", "to", "bore_mm", "velocity_m_s", "distance_m", "time"}, whole);
  for (const sim::WayPoint& point : way.points) {
    if (point.link < 0) continue;
    table.Add(
        {model.LinkId(point.link), model.NodeId(point.node), Fixed(1000 * sim::Bore_m(model, point.link), 0),
         Fixed(CalcSpeed_m_s(model, state, point.link), 3), Fixed(point.distance_m, 1), Clock(point.time_s)});
  }
  return table.Text("pipes");
}

std::string EndText(const HydraulicModel& model, const sim::WaterWay& way) {
  const std::string node = "'" + model.NodeId(way.points.back().node) + "'";
  switch (way.end) {
    case sim::WayEnd::kArrived:
      return "it arrives at " + node;
    case sim::WayEnd::kLeavesNetwork:
      return "it ends in open water at " + node;
    case sim::WayEnd::kDeadEnd:
      return "it ends at " + node + ": no water flows on";
    case sim::WayEnd::kBlocked:
      return "it ends at " + node + ": water flows on where the ball cannot pass";
  }
  return "";
}

std::string MainFlowText(const HydraulicModel& model, const sim::HydraulicState& state,
                         const sim::WaterWay& way, bool whole) {
  return fmt::format("\nThe way of the greatest flow from '{}': {:.1f} m in {}; {}\n",
                     model.NodeId(way.points.front().node), way.points.back().distance_m,
                     Clock(way.points.back().time_s), EndText(model, way)) +
         (way.points.size() > 1 ? WayText(model, state, way, whole) : "");
}

std::string ReachableText(const HydraulicModel& model, const sim::WaterWays& ways, int from,
                          const sim::WaterWay& main_flow, bool whole) {
  const std::vector<sim::WayPoint> reached = ways.FindReachable(from);
  LongTable table({"node", "kind", "by", "distance_m", "time", "time_main_flow"}, whole);
  for (const sim::WayPoint& point : reached) {
    if (point.link < 0) continue;
    const auto on_main = std::find_if(main_flow.points.begin(), main_flow.points.end(),
                                      [&](const sim::WayPoint& p) { return p.node == point.node; });
    table.Add({model.NodeId(point.node), scenarios::NodeKind(model, point.node), model.LinkId(point.link),
               Fixed(point.distance_m, 1), Clock(point.time_s),
               on_main == main_flow.points.end() ? "-" : Clock(on_main->time_s)});
  }
  const std::size_t count = reached.size() - 1;
  if (count == 0) return "";  // the way of the greatest flow has said why
  return fmt::format("\nFrom '{}' the water comes by {}; fastest ways, at the water's bulk speed\n",
                     model.NodeId(from), Counted(count, "node")) +
         table.Text("nodes");
}

}  // namespace

std::string DescribeBallWays(const HydraulicModel& model, const sim::HydraulicState& state,
                             const scenarios::BallQuestion& question, bool whole) {
  std::string text;
  if (question.ask_passage) text += PassageText(model, state, question.ball_diameter_m, whole);
  if (!question.from) return text;
  const sim::WaterWays ways(model, state, question.ball_diameter_m);
  const sim::WaterWay main_flow = ways.FollowMainFlow(*question.from, question.to);
  text += MainFlowText(model, state, main_flow, whole);
  if (!question.to) return text + ReachableText(model, ways, *question.from, main_flow, whole);
  const auto fastest = ways.FindFastest(*question.from, *question.to);
  if (!fastest)
    return text + fmt::format("\nNo water takes the ball from '{}' to '{}'\n", model.NodeId(*question.from),
                              model.NodeId(*question.to));
  return text +
         fmt::format("\nThe fastest way from '{}' to '{}': {:.1f} m in {}\n", model.NodeId(*question.from),
                     model.NodeId(*question.to), fastest->points.back().distance_m,
                     Clock(fastest->points.back().time_s)) +
         WayText(model, state, *fastest, whole);
}

}  // namespace piperun::tools
