#include "tools/piperun/network_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "tools/piperun/table.h"

namespace piperun::tools {
namespace {

using scenarios::LinkKind;
using scenarios::LinkReport;
using scenarios::NodeKind;
using scenarios::NodeReport;
using scenarios::ReportLinks;
using scenarios::ReportNodes;
using sim::HydraulicModel;
using sim::HydraulicStep;

constexpr std::size_t kScreenRows = 20;
constexpr std::size_t kMostTankColumns = 6;

std::string Clock(double seconds) {
  const auto whole = std::llround(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

/// A table that stops at a screenful and says what is left out.
class LongTable {
 public:
  LongTable(std::vector<std::string> head, bool whole) : table_(std::move(head)), whole_(whole) {}
  void Add(std::vector<std::string> row) {
    if (whole_ || rows_ < kScreenRows) table_.Add(std::move(row));
    ++rows_;
  }
  std::string Text(const char* what) const {
    std::string text = table_.Text();
    if (!whole_ && rows_ > kScreenRows) {
      text += fmt::format("  ... and {} more {}; --all prints them\n", rows_ - kScreenRows, what);
    }
    return text;
  }

 private:
  Table table_;
  bool whole_;
  std::size_t rows_ = 0;
};

const char* LawName(sim::HeadLossLaw law) {
  switch (law) {
    case sim::HeadLossLaw::kHazenWilliams:
      return "Hazen-Williams";
    case sim::HeadLossLaw::kDarcyWeisbach:
      return "Darcy-Weisbach";
    case sim::HeadLossLaw::kChezyManning:
      return "Chezy-Manning";
  }
  return "";
}

std::string Counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

double PipeLength_m(const HydraulicModel& model) {
  double length = 0;
  for (const sim::PipeLink& pipe : model.pipes) length += pipe.length_m;
  return length;
}

std::string SizeText(const HydraulicModel& model) {
  std::string text = model.name;
  if (!model.title.empty()) text += ": " + model.title.front();
  text += fmt::format("\n  {}: {}, {}, {}\n", Counted(static_cast<std::size_t>(model.node_count()), "node"),
                      Counted(model.junctions.size(), "junction"),
                      Counted(model.reservoirs.size(), "reservoir"), Counted(model.tanks.size(), "tank"));
  text += fmt::format("  {}: {} of {:.2f} km, {}, {}\n",
                      Counted(static_cast<std::size_t>(model.link_count()), "link"),
                      Counted(model.pipes.size(), "pipe"), PipeLength_m(model) / 1000,
                      Counted(model.pumps.size(), "pump"), Counted(model.valves.size(), "valve"));
  text += fmt::format("  {} head loss; the file is in {} and {} units; accuracy {:g}\n",
                      LawName(model.options.law), model.options.flow_unit, model.options.metric ? "SI" : "US",
                      model.options.accuracy);
  for (const std::string& note : model.notes) text += "  note: " + note + "\n";
  return text;
}

std::string QualityText(const HydraulicModel& model, const HydraulicStep& step) {
  const sim::SolveReport& report = step.report;
  std::string text =
      fmt::format("\nAt {}: {}\n", Clock(static_cast<double>(step.time_s)), Describe(report, model));
  if (report.end == sim::SolveReport::End::kSingular) return text;
  text += fmt::format(
      "  last change of flows {:.1e}, head losses within {:.1e} m, mass balance within {:.1e} L/s\n",
      report.relative_flow_change, report.max_head_error_m, 1000 * report.max_imbalance_m3_s);
  const std::vector<bool> supplied = FindSupplied(model, step.state);
  const auto cut_off = std::count(supplied.begin(), supplied.end(), false);
  if (cut_off > 0) {
    text += fmt::format("  {} cut off from every reservoir and tank: heads there mean nothing ('?')\n",
                        Counted(static_cast<std::size_t>(cut_off), "node"));
  }
  return text;
}

double Bar(const HydraulicModel& model, double head_m) {
  return head_m * 9.80665 * 1000 * model.options.specific_gravity * 1e-5;
}

std::string NodeTable(const HydraulicModel& model, const HydraulicStep& step, bool whole) {
  LongTable table({"node", "kind", "elevation_m", "head_m", "pressure_m", "pressure_bar", "demand_L_s"},
                  whole);
  const std::vector<NodeReport> nodes = ReportNodes(model, step.state);
  const std::vector<bool> supplied = FindSupplied(model, step.state);
  for (int i = 0; i < model.node_count(); ++i) {
    const NodeReport& node = nodes[i];
    const bool known = supplied[i], in_pipes = i < model.junction_count() || i >= model.first_tank();
    const auto cell = [&](bool shown, int digits, double value) {
      return !shown ? std::string("-") : known ? fmt::format("{:.{}f}", value, digits) : std::string("?");
    };
    table.Add({model.NodeId(i), NodeKind(model, i), fmt::format("{:.2f}", model.Elevation_m(i)),
               cell(true, 4, node.head_m), cell(in_pipes, 3, node.pressure_m),
               cell(in_pipes, 3, Bar(model, node.pressure_m)),
               fmt::format("{:.4f}", 1000 * node.demand_m3_s)});
  }
  return table.Text("nodes");
}

std::string LinkTable(const HydraulicModel& model, const HydraulicStep& step, bool whole) {
  LongTable table({"link", "kind", "from", "to", "length_m", "bore_mm", "flow_L_s", "velocity_m_s",
                   "head_loss_m", "status"},
                  whole);
  const std::vector<LinkReport> links = ReportLinks(model, step.state);
  for (int i = 0; i < model.link_count(); ++i) {
    const double bore = sim::Bore_m(model, i);
    const bool is_pipe = i < model.first_pump();
    table.Add({model.LinkId(i), LinkKind(model, i), model.NodeId(model.From(i)), model.NodeId(model.To(i)),
               is_pipe ? fmt::format("{:.1f}", model.pipes[i].length_m) : "-",
               bore > 0 ? fmt::format("{:.0f}", 1000 * bore) : "-",
               fmt::format("{:.4f}", 1000 * links[i].flow_m3_s), fmt::format("{:.3f}", links[i].velocity_m_s),
               fmt::format("{:.4f}", links[i].head_loss_m), StatusText(step.state.status[i])});
  }
  return table.Text("links");
}

/// The junction with the lowest pressure among those that have one, or -1.
int FindLowest(const HydraulicModel& model, const HydraulicStep& step) {
  const std::vector<bool> supplied = FindSupplied(model, step.state);
  int lowest = -1;
  const auto pressure = [&](int i) { return step.state.head_m[i] - model.Elevation_m(i); };
  for (int i = 0; i < model.junction_count(); ++i) {
    if (supplied[i] && (lowest < 0 || pressure(i) < pressure(lowest))) lowest = i;
  }
  return lowest;
}

std::string PeriodTable(const HydraulicModel& model, const scenarios::NetworkSolution& solution) {
  std::vector<std::string> head{"time",       "iterations", "change", "balance_L_s",
                                "demand_L_s", "lowest_m",   "at"};
  const std::size_t tanks = std::min(model.tanks.size(), kMostTankColumns);
  for (std::size_t i = 0; i < tanks; ++i) head.push_back("level_m:" + model.tanks[i].id);
  Table table(std::move(head));
  for (const HydraulicStep& step : solution.steps) {
    double demand = 0;
    for (int i = 0; i < model.junction_count(); ++i) demand += step.state.Outflow_m3_s(i);
    const int lowest = FindLowest(model, step);
    std::vector<std::string> row{
        Clock(static_cast<double>(step.time_s)),
        std::to_string(step.report.iterations),
        fmt::format("{:.1e}", step.report.relative_flow_change),
        fmt::format("{:.1e}", 1000 * step.report.max_imbalance_m3_s),
        fmt::format("{:.3f}", 1000 * demand),
        lowest < 0 ? "-" : fmt::format("{:.2f}", step.state.head_m[lowest] - model.Elevation_m(lowest)),
        lowest < 0 ? "-" : model.NodeId(lowest)};
    for (std::size_t i = 0; i < tanks; ++i) {
      row.push_back(fmt::format(
          "{:.3f}",
          step.state.head_m[static_cast<std::size_t>(model.first_tank()) + i] - model.tanks[i].elevation_m));
    }
    table.Add(std::move(row));
  }
  return table.Text();
}

std::string InstantText(const HydraulicModel& model, const HydraulicStep& step, bool whole) {
  return QualityText(model, step) + "\n" + NodeTable(model, step, whole) + "\n" +
         LinkTable(model, step, whole);
}

std::string PassageText(const HydraulicModel& model, const sim::HydraulicState& state, double diameter_m,
                        bool whole) {
  LongTable table({"link", "kind", "bore_mm", "d/D", "ball"}, whole);
  std::size_t passable = 0;
  double length = 0;
  for (int i = 0; i < model.link_count(); ++i) {
    const sim::Obstacle obstacle = FindObstacle(model, state, i, diameter_m);
    const double bore = sim::Bore_m(model, i);
    if (obstacle == sim::Obstacle::kNone && i < model.first_pump()) {
      ++passable;
      length += model.pipes[i].length_m;
    }
    table.Add({model.LinkId(i), LinkKind(model, i), bore > 0 ? fmt::format("{:.0f}", 1000 * bore) : "-",
               bore > 0 ? fmt::format("{:.2f}", diameter_m / bore) : "-", ObstacleText(obstacle)});
  }
  return fmt::format("\nA ball of {:.4g} mm passes {} of {}, {:.2f} of {:.2f} km (d/D at most {:.2f})\n",
                     1000 * diameter_m, passable, Counted(model.pipes.size(), "pipe"), length / 1000,
                     PipeLength_m(model) / 1000, sim::kGreatestBallToBore) +
         table.Text("links");
}

std::string WayText(const HydraulicModel& model, const sim::HydraulicState& state, const sim::WaterWay& way,
                    bool whole) {
  LongTable table({"by", "to", "bore_mm", "velocity_m_s", "distance_m", "time"}, whole);
  for (const sim::WayPoint& point : way.points) {
    if (point.link < 0) continue;
    table.Add({model.LinkId(point.link), model.NodeId(point.node),
               fmt::format("{:.0f}", 1000 * sim::Bore_m(model, point.link)),
               fmt::format("{:.3f}", CalcSpeed_m_s(model, state, point.link)),
               fmt::format("{:.1f}", point.distance_m), Clock(point.time_s)});
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
    table.Add({model.NodeId(point.node), NodeKind(model, point.node), model.LinkId(point.link),
               fmt::format("{:.1f}", point.distance_m), Clock(point.time_s),
               on_main == main_flow.points.end() ? "-" : Clock(on_main->time_s)});
  }
  const std::size_t count = reached.size() - 1;
  return fmt::format("\nFrom '{}' the water comes by {}; fastest ways, at the water's bulk speed\n",
                     model.NodeId(from), Counted(count, "node")) +
         (count > 0 ? table.Text("nodes") : "");
}

}  // namespace

std::string DescribeNetwork(const HydraulicModel& model, const scenarios::NetworkSolution& solution,
                            bool whole) {
  std::string text = SizeText(model) + InstantText(model, solution.steps.front(), whole);
  if (solution.steps.size() == 1) return text;
  for (std::size_t i = 1; whole && i < solution.steps.size(); ++i)
    text += InstantText(model, solution.steps[i], whole);
  text += fmt::format("\nThe period, {}\n", Counted(solution.steps.size(), "instant"));
  return text + PeriodTable(model, solution);
}

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
