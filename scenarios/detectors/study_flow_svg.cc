#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "scenarios/detectors/study_flow.h"

namespace piperun::scenarios::detectors {
namespace {

constexpr double kPanel = 260, kHeight = 220, kLeft = 60, kTop = 50;
constexpr double kLow_L_min = 0.01, kHigh_L_min = 3;
constexpr const char* kColours[] = {"#1f77b4", "#d62728", "#2ca02c"};

std::string Number(double x) { return FormatFixed(x, 1); }

struct Panel {
  double left = 0;
  double X(double flow_L_min) const {
    return left + kPanel * std::log(flow_L_min / kLow_L_min) / std::log(kHigh_L_min / kLow_L_min);
  }
  double Y(double share) const { return kTop + kHeight * (1 - share); }
};

std::string Text(double x, double y, const std::string& text, const std::string& style) {
  return "<text x=\"" + Number(x) + "\" y=\"" + Number(y) + "\" " + style + ">" + text + "</text>\n";
}

std::string Rule(double x1, double y1, double x2, double y2) {
  return "<line x1=\"" + Number(x1) + "\" y1=\"" + Number(y1) + "\" x2=\"" + Number(x2) + "\" y2=\"" +
         Number(y2) + "\" stroke=\"#ddd\"/>\n";
}

std::string DrawGrid(const Panel& panel, const std::string& title) {
  std::string svg = Text(panel.left, kTop - 12, title, "font-size=\"13\"");
  for (int i = 0; i <= 5; ++i) {
    const double y = panel.Y(0.2 * i);
    svg += Rule(panel.left, y, panel.left + kPanel, y);
    svg += Text(panel.left - 6, y + 4, FormatFixed(0.2 * i, 1), "text-anchor=\"end\"");
  }
  for (const double flow_L_min : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0}) {
    svg += Rule(panel.X(flow_L_min), panel.Y(0), panel.X(flow_L_min), panel.Y(1));
    svg += Text(panel.X(flow_L_min), panel.Y(0) + 16, FormatNumber(flow_L_min), "text-anchor=\"middle\"");
  }
  return svg + Text(panel.left + 0.5 * kPanel, panel.Y(0) + 34, "leak, L/min", "text-anchor=\"middle\"");
}

/// The band between the bounds.
std::string DrawBand(const Panel& panel, const FlowCurve& curve, const std::string& colour) {
  std::string upper, lower;
  for (const FlowPoint& point : curve.points) {
    const std::string x = Number(panel.X(point.flow_L_min));
    upper += x + "," + Number(panel.Y(point.any_loudness.high)) + " ";
    lower = x + "," + Number(panel.Y(point.any_loudness.low)) + " " + lower;
  }
  return "<polygon points=\"" + upper + lower + "\" fill=\"" + colour + "\" fill-opacity=\"0.25\" stroke=\"" +
         colour + "\"/>\n";
}

}  // namespace

std::string DrawFlowSvg(const std::vector<FlowCurve>& curves) {
  std::vector<std::string> pipes;
  for (const FlowCurve& curve : curves)
    if (std::find(pipes.begin(), pipes.end(), curve.pipe) == pipes.end()) pipes.push_back(curve.pipe);
  const double width = static_cast<double>(pipes.size()) * (kPanel + kLeft) + 100;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Number(width) + "\" height=\"" +
                    Number(kTop + kHeight + 50) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"white\"/>\n";
  for (std::size_t p = 0; p < pipes.size(); ++p) {
    const Panel panel{kLeft + static_cast<double>(p) * (kPanel + kLeft)};
    svg += DrawGrid(panel, "Pd of leaks of any loudness, " + pipes[p]);
    std::size_t colour = 0;
    for (const FlowCurve& curve : curves) {
      if (curve.pipe != pipes[p]) continue;
      const std::string stroke = kColours[colour++ % std::size(kColours)];
      svg += DrawBand(panel, curve, stroke);
      if (p == 0) {
        svg += Text(width - 80, kTop + 16 * static_cast<double>(colour),
                    FormatNumber(curve.pressure_bar) + " bar", "fill=\"" + stroke + "\"");
      }
    }
  }
  return svg + "</svg>\n";
}

}  // namespace piperun::scenarios::detectors
