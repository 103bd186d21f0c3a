// A network's solution as JSON and CSV.
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number.h"
#include "scenarios/network_report.h"

namespace piperun::scenarios {
namespace {

using sim::HydraulicModel;
using sim::HydraulicStep;

std::string Quoted(const std::string& text) { return nlohmann::json(text).dump(); }

/// Appends members of a JSON object; written by hand, as a long period has millions.
class JsonObject {
 public:
  explicit JsonObject(std::string& out) : out_(out) { out_ += '{'; }
  ~JsonObject() { out_ += '}'; }
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;

  /// The key, with what parts it from the member before; the value is the caller's.
  std::string& Key(const std::string& key) {
    if (!first_) out_ += ", ";
    first_ = false;
    out_ += Quoted(key) + ": ";
    return out_;
  }
  void Add(const std::string& key, double value) {
    Key(key);
    std::isfinite(value) ? AppendNumber(out_, value) : static_cast<void>(out_ += "null");
  }
  void Add(const std::string& key, const std::string& text) { Key(key) += Quoted(text); }

 private:
  std::string& out_;
  bool first_ = true;
};

void AppendNodes(const HydraulicModel& model, const HydraulicStep& step, std::string& out) {
  const std::vector<NodeReport> reports = ReportNodes(model, step.state);
  JsonObject nodes(out);
  for (int i = 0; i < model.node_count(); ++i) {
    nodes.Key(model.NodeId(i));
    JsonObject node(out);
    node.Add("head_m", reports[i].head_m);
    node.Add("demand_m3_s", reports[i].demand_m3_s);
  }
}

void AppendLinks(const HydraulicModel& model, const HydraulicStep& step, std::string& out) {
  const std::vector<LinkReport> reports = ReportLinks(model, step.state);
  JsonObject links(out);
  for (int i = 0; i < model.link_count(); ++i) {
    links.Key(model.LinkId(i));
    JsonObject link(out);
    link.Add("flow_m3_s", reports[i].flow_m3_s);
    link.Add("velocity_m_s", reports[i].velocity_m_s);
    link.Add("status", std::string(sim::StatusText(step.state.status[i])));
  }
}

void AppendSteps(const HydraulicModel& model, const NetworkSolution& solution, std::string& out) {
  out += '[';
  for (const HydraulicStep& step : solution.steps) {
    if (&step != &solution.steps.front()) out += ",\n ";
    JsonObject object(out);
    object.Key("time_s") += std::to_string(step.time_s);
    AppendNodes(model, step, object.Key("nodes"));
    AppendLinks(model, step, object.Key("links"));
  }
  out += ']';
}

void AppendBall(const HydraulicModel& model, const sim::HydraulicState& state, double diameter_m,
                std::string& out) {
  JsonObject ball(out);
  ball.Add("diameter_m", diameter_m);
  JsonObject links(ball.Key("links"));
  for (int i = 0; i < model.link_count(); ++i) {
    links.Add(model.LinkId(i), std::string(sim::ObstacleText(FindObstacle(model, state, i, diameter_m))));
  }
}

void AppendWay(const HydraulicModel& model, const sim::WaterWay& way, std::string& out) {
  out += '[';
  for (const sim::WayPoint& point : way.points) {
    if (&point != &way.points.front()) out += ", ";
    JsonObject object(out);
    object.Add("node", model.NodeId(point.node));
    if (point.link >= 0) object.Add("link", model.LinkId(point.link));
    object.Add("time_s", point.time_s);
    object.Add("distance_m", point.distance_m);
  }
  out += ']';
}

void AppendRoutes(const HydraulicModel& model, const sim::HydraulicState& state, const BallQuestion& question,
                  std::string& out) {
  const sim::WaterWays ways(model, state, question.ball_diameter_m);
  JsonObject routes(out);
  routes.Add("from", model.NodeId(*question.from));
  {
    JsonObject reachable(routes.Key("reachable"));
    for (const sim::WayPoint& point : ways.FindReachable(*question.from)) {
      JsonObject node(reachable.Key(model.NodeId(point.node)));
      node.Add("time_s", point.time_s);
      node.Add("distance_m", point.distance_m);
    }
  }
  AppendWay(model, ways.FollowMainFlow(*question.from, question.to), routes.Key("main_flow"));
  if (!question.to) return;
  if (const auto fastest = ways.FindFastest(*question.from, *question.to)) {
    AppendWay(model, *fastest, routes.Key("fastest"));
  } else {
    routes.Key("fastest") += "null";
  }
}

/// A cell of a CSV file, in quotes where it needs them (RFC 4180).
void AppendCell(const std::string& text, std::string& out) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  out += '"';
}

void AppendCells(std::initializer_list<double> values, std::string& out) {
  for (const double value : values) {
    out += ',';
    AppendNumber(out, value);
  }
}

void AppendNodeRows(const HydraulicModel& model, const HydraulicStep& step, std::string& out) {
  const std::vector<NodeReport> reports = ReportNodes(model, step.state);
  for (int i = 0; i < model.node_count(); ++i) {
    out += std::to_string(step.time_s) + ",node,";
    AppendCell(model.NodeId(i), out);
    out += std::string(",") + NodeKind(model, i);
    const NodeReport& node = reports[i];
    AppendCells({model.Elevation_m(i), node.head_m, node.pressure_m, node.demand_m3_s}, out);
    out += ",,,,,,\n";
  }
}

void AppendLinkRows(const HydraulicModel& model, const HydraulicStep& step, std::string& out) {
  const std::vector<LinkReport> reports = ReportLinks(model, step.state);
  for (int i = 0; i < model.link_count(); ++i) {
    out += std::to_string(step.time_s) + ",link,";
    AppendCell(model.LinkId(i), out);
    out += std::string(",") + LinkKind(model, i) + ",,,,,";
    AppendCell(model.NodeId(model.From(i)), out);
    out += ',';
    AppendCell(model.NodeId(model.To(i)), out);
    AppendCells({reports[i].flow_m3_s, reports[i].velocity_m_s, reports[i].head_loss_m}, out);
    out += std::string(",") + sim::StatusText(step.state.status[i]) + "\n";
  }
}

}  // namespace

std::string WriteNetworkJson(const HydraulicModel& model, const NetworkSolution& solution,
                             const BallQuestion& question) {
  std::string out;
  const HydraulicStep& first = solution.steps.front();
  {
    JsonObject object(out);
    object.Key("converged") += solution.converged() ? "true" : "false";
    object.Key("iterations") += std::to_string(first.report.iterations);
    AppendSteps(model, solution, object.Key("steps"));
    if (question.ask_passage) AppendBall(model, first.state, question.ball_diameter_m, object.Key("ball"));
    if (question.from) AppendRoutes(model, first.state, question, object.Key("routes"));
  }
  return out + "\n";
}

std::string WriteNetworkCsv(const HydraulicModel& model, const NetworkSolution& solution) {
  std::string out =
      "time_s,element,id,kind,elevation_m,head_m,pressure_m,demand_m3_s,from,to,flow_m3_s,velocity_m_s,"
      "head_loss_m,status\n";
  for (const HydraulicStep& step : solution.steps) {
    AppendNodeRows(model, step, out);
    AppendLinkRows(model, step, out);
  }
  return out;
}

}  // namespace piperun::scenarios
