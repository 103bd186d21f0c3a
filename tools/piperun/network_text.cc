#include "tools/piperun/network_text.h"

#include <fmt/core.h>

#include <algorithm>

#include "tools/piperun/long_table.h"
#include "tools/piperun/number_text.h"

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

constexpr std::size_t kMostTankColumns = 6;

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
  for (int k = 0; k < model.node_count(); ++k) {  // reservoirs and tanks first, where a cut leaves them
    const int i = (model.junction_count() + k) % model.node_count();
    const NodeReport& node = nodes[i];
    const bool known = supplied[i], in_pipes = i < model.junction_count() || i >= model.first_tank();
    const auto cell = [&](bool shown, int digits, double value) {
      return !shown ? std::string("-") : known ? Fixed(value, digits) : std::string("?");
    };
    table.Add({model.NodeId(i), NodeKind(model, i), Fixed(model.Elevation_m(i), 2),
               cell(true, 4, node.head_m), cell(in_pipes, 3, node.pressure_m),
               cell(in_pipes, 3, Bar(model, node.pressure_m)), Fixed(1000 * node.demand_m3_s, 4)});
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
               is_pipe ? Fixed(model.pipes[i].length_m, 1) : "-", bore > 0 ? Fixed(1000 * bore, 0) : "-",
               Fixed(1000 * links[i].flow_m3_s, 4), Fixed(links[i].velocity_m_s, 3),
               Fixed(links[i].head_loss_m, 4), StatusText(step.state.status[i])});
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
        Fixed(1000 * demand, 3),
        lowest < 0 ? "-" : Fixed(step.state.head_m[lowest] - model.Elevation_m(lowest), 2),
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

}  // namespace piperun::tools
