#include "scenarios/network_svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "base/water.h"
#include "scenarios/inp_network.h"
#include "scenarios/network_params.h"
#include "sim/downstream.h"
#include "sim/network/network_flow.h"

namespace piperun::scenarios {
namespace {

constexpr double kWidth = 1000, kMargin = 40, kHead = 60;
constexpr double kArcStep_rad = 0.1;
constexpr std::size_t kMostLabels = 60;

std::string Text(double x) {
  char text[24];
  std::snprintf(text, sizeof text, "%.1f", x);
  return text;
}

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return escaped;
}

/// From metres in plan to the sheet: north up.
class Sheet {
 public:
  explicit Sheet(const Network& network) {
    for (const Pipe& pipe : network.pipes()) {
      for (const CentrelinePiece& piece : pipe.centreline) {
        Include(piece.p_begin_W);
        Include(EvalCentreline(piece, piece.s_end_m()).p_W);
      }
    }
    const double width_m = std::max(high_.x() - low_.x(), 1e-3), height_m = high_.y() - low_.y();
    scale_ = (kWidth - 2 * kMargin) / std::max(width_m, height_m);
  }
  double X(const Vector3d& p_W) const { return kMargin + scale_ * (p_W.x() - low_.x()); }
  double Y(const Vector3d& p_W) const { return kHead + kMargin + scale_ * (high_.y() - p_W.y()); }
  std::string At(const Vector3d& p_W) const { return Text(X(p_W)) + "," + Text(Y(p_W)); }
  double height() const { return kHead + 2 * kMargin + scale_ * (high_.y() - low_.y()); }

 private:
  void Include(const Vector3d& p_W) {
    low_ = low_.cwiseMin(p_W);
    high_ = high_.cwiseMax(p_W);
  }
  Vector3d low_ = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high_ = -low_;
  double scale_ = 1;
};

std::string Polyline(const Pipe& pipe, const Sheet& sheet) {
  std::string points;
  for (const CentrelinePiece& piece : pipe.centreline) {
    const double turn = piece.curvature_1_m * piece.length_m;
    const int steps = std::max(1, static_cast<int>(std::ceil(turn / kArcStep_rad)));
    for (int i = 0; i < steps; ++i) {
      points += sheet.At(EvalCentreline(piece, piece.s_begin_m + piece.length_m * i / steps).p_W) + " ";
    }
  }
  return points + sheet.At(pipe.Eval(pipe.length_m).p_W);
}

/// Grey at rest, from light to dark blue up to 1 m/s, red from there on.
std::string SpeedColour(double speed_m_s) {
  if (speed_m_s < 1e-3) return "#b0b0b0";
  if (speed_m_s > 1) return "#c0392b";
  char text[8];
  const double u = std::sqrt(speed_m_s);
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(std::lround(190 - 180 * u)),
                static_cast<unsigned>(std::lround(215 - 145 * u)),
                static_cast<unsigned>(std::lround(245 - 85 * u)));
  return text;
}

double StrokeWidth(const Pipe& pipe) { return std::clamp(30 * pipe.diameter_m, 1.5, 12.0); }

std::string DrawPipe(const Pipe& pipe, double velocity_m_s, const Sheet& sheet) {
  std::string svg = "<polyline points=\"" + Polyline(pipe, sheet) + "\" fill=\"none\" stroke=\"" +
                    SpeedColour(std::abs(velocity_m_s)) + "\" stroke-width=\"" + Text(StrokeWidth(pipe)) +
                    "\"";
  if (!pipe.passable) svg += " stroke-dasharray=\"4 3\"";
  return svg + "><title>" + Escaped(pipe.id) + ": " + Text(1000 * pipe.diameter_m) + " mm, " +
         Text(pipe.length_m) + " m, " + Text(100 * velocity_m_s) + " cm/s</title></polyline>\n";
}

std::string DrawArrow(const Pipe& pipe, double velocity_m_s, const Sheet& sheet) {
  if (std::abs(velocity_m_s) < 1e-3) return "";
  const CentrelinePoint middle = pipe.Eval(0.5 * pipe.length_m);
  const Vector3d t = velocity_m_s > 0 ? middle.tangent_W : Vector3d(-middle.tangent_W);
  if (std::hypot(t.x(), t.y()) < 0.1) return "";  // a riser: nothing to see in plan
  const double degrees = std::atan2(-t.y(), t.x()) * 180 / std::numbers::pi;
  return "<path d=\"M-5,-4 L5,0 L-5,4 Z\" fill=\"#222\" transform=\"translate(" + sheet.At(middle.p_W) +
         ") rotate(" + Text(degrees) + ")\"/>\n";
}

std::string DrawNode(const NodeSpec& node, const Vector3d& p_W, const Sheet& sheet, bool labelled) {
  const double x = sheet.X(p_W), y = sheet.Y(p_W);
  std::string svg = node.open_water
                        ? "<rect x=\"" + Text(x - 6) + "\" y=\"" + Text(y - 6) +
                              "\" width=\"12\" height=\"12\" fill=\"#1f618d\">"
                        : "<circle cx=\"" + Text(x) + "\" cy=\"" + Text(y) + "\" r=\"2.5\" fill=\"#333\">";
  svg += "<title>" + Escaped(node.id) + ", " + Text(node.position_m.z()) + " m</title>";
  svg += node.open_water ? "</rect>\n" : "</circle>\n";
  if (!labelled) return svg;
  return svg + "<text x=\"" + Text(x + 5) + "\" y=\"" + Text(y - 6) + "\">" + Escaped(node.id) + "</text>\n";
}

}  // namespace

std::string DrawNetworkSvg(const Network& network, const sim::FlowTimeline& flow, TrueTime t,
                           const NetworkSvgContent& content) {
  const Sheet sheet(network);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + Text(kWidth) + " " + Text(sheet.height()) +
      "\" font-family=\"sans-serif\" font-size=\"11\">\n" +
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"" + Text(kMargin) +
      "\" y=\"28\" font-size=\"18\">" + Escaped(content.title) + "</text>\n<text x=\"" + Text(kMargin) +
      "\" y=\"48\">speed: grey still, light to dark blue up to 1 m/s, red above; dashed: nothing "
      "solid passes; yellow: the planned way; triangles: leaks</text>\n";
  for (const RouteLeg& leg : content.way) {
    const Pipe& pipe = network.pipe(leg.pipe);
    svg += "<polyline points=\"" + Polyline(pipe, sheet) +
           "\" fill=\"none\" stroke=\"#f9e27d\" stroke-width=\"" + Text(StrokeWidth(pipe) + 10) + "\"/>\n";
  }
  std::string arrows;
  for (std::size_t i = 0; i < network.pipes().size(); ++i) {
    const Pipe& pipe = network.pipes()[i];
    const double velocity = flow.Eval(static_cast<int>(i), 0.5 * pipe.length_m, t).velocity_m_s;
    svg += DrawPipe(pipe, velocity, sheet);
    arrows += DrawArrow(pipe, velocity, sheet);
  }
  svg += arrows;
  const bool labelled = network.nodes().size() <= kMostLabels;
  for (std::size_t i = 0; i < network.nodes().size(); ++i) {
    const auto& ends = network.EndsAt(static_cast<int>(i));
    if (ends.empty()) continue;
    const Pipe& pipe = network.pipe(ends.front().pipe);
    svg += DrawNode(network.nodes()[i], pipe.Eval(pipe.EndS_m(ends.front().at_to)).p_W, sheet, labelled);
  }
  for (const Leak& leak : content.leaks) {
    svg += "<path d=\"M0,-7 L6,5 L-6,5 Z\" fill=\"#e67e22\" stroke=\"#222\" transform=\"translate(" +
           sheet.At(network.pipe(leak.pipe).Eval(leak.s_m).p_W) + ")\"><title>" + Escaped(leak.id) +
           "</title></path>\n";
  }
  return svg + "</svg>\n";
}

std::string DrawModelSvg(const sim::HydraulicModel& model, const sim::HydraulicState& state,
                         std::optional<int> from, std::optional<int> to, double ball_diameter_m) {
  const Network network = MakeNetwork(DrawNetwork(model, {}).network);
  const std::vector<sim::HydraulicStep> steps{{0, true, {}, state}};
  const sim::FlowTimeline flow =
      sim::MakeFlowTimeline(sim::InsertLeaks(model, {}), steps, 0, network, CalcWater(10));
  NetworkSvgContent content{model.name, {}, {}};
  if (from && to) {
    const sim::Bore bore(network);
    const sim::Downstream downstream(bore, flow, TrueTime{});
    content.way =
        downstream.FindFastestWay(*from, *to, 0.5 * ball_diameter_m).value_or(std::vector<RouteLeg>{});
  }
  return DrawNetworkSvg(network, flow, TrueTime{}, content);
}

}  // namespace piperun::scenarios
