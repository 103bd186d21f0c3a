#include <algorithm>

#include "base/number.h"
#include "scenarios/detectors/study_text.h"

namespace piperun::scenarios::detectors {
namespace {

constexpr double kPanel = 260, kHeight = 220, kLeft = 60, kTop = 50, kLow_dB = -7, kHigh_dB = 11;
constexpr const char* kColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b"};

template <class Get>
std::vector<std::string> NamesOf(const std::vector<Tally>& tallies, Get get) {
  std::vector<std::string> names;
  for (const Tally& t : tallies)
    if (std::find(names.begin(), names.end(), get(t)) == names.end()) names.push_back(get(t));
  return names;
}

std::string Number(double x) { return FormatFixed(x, 1); }

struct Panel {
  double left = 0;
  double X(double snr_dB) const { return left + kPanel * (snr_dB - kLow_dB) / (kHigh_dB - kLow_dB); }
  double Y(double share) const { return kTop + kHeight * (1 - share); }
};

std::string Line(double x1, double y1, double x2, double y2, const std::string& colour) {
  return "<line x1=\"" + Number(x1) + "\" y1=\"" + Number(y1) + "\" x2=\"" + Number(x2) + "\" y2=\"" +
         Number(y2) + "\" stroke=\"" + colour + "\"/>\n";
}

std::string Text(double x, double y, const std::string& text, const std::string& style) {
  return "<text x=\"" + Number(x) + "\" y=\"" + Number(y) + "\" " + style + ">" + text + "</text>\n";
}

std::string DrawGrid(const Panel& panel, const std::string& title) {
  std::string svg = Text(panel.left, kTop - 12, title, "font-size=\"13\"");
  for (int i = 0; i <= 5; ++i) {
    const double share = 0.2 * i;
    svg += Line(panel.left, panel.Y(share), panel.left + kPanel, panel.Y(share), "#ddd");
    svg += Text(panel.left - 6, panel.Y(share) + 4, FormatFixed(share, 1), "text-anchor=\"end\"");
  }
  for (const double snr_dB : {-6.0, -3.0, 0.0, 3.0, 6.0, 10.0}) {
    svg += Line(panel.X(snr_dB), panel.Y(0), panel.X(snr_dB), panel.Y(1), "#ddd");
    svg += Text(panel.X(snr_dB), panel.Y(0) + 16, FormatNumber(snr_dB), "text-anchor=\"middle\"");
  }
  return svg + Text(panel.left + 0.5 * kPanel, panel.Y(0) + 34, "SNR at the hole, 1-4 kHz, dB",
                    "text-anchor=\"middle\"");
}

std::string DrawCurve(const Panel& panel, const std::vector<const Tally*>& curve, const std::string& colour) {
  std::string points, bars;
  for (const Tally* t : curve) {
    const double share = static_cast<double>(t->found) / std::max(1, t->leaks);
    const ShareInterval interval = CalcWilsonInterval(t->found, t->leaks);
    points += Number(panel.X(*t->snr_dB)) + "," + Number(panel.Y(share)) + " ";
    bars +=
        Line(panel.X(*t->snr_dB), panel.Y(interval.low), panel.X(*t->snr_dB), panel.Y(interval.high), colour);
  }
  return "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"" + colour +
         "\" stroke-width=\"1.8\"/>\n" + bars;
}

}  // namespace

std::string DrawStudySvg(const std::vector<Tally>& tallies) {
  const auto pipes = NamesOf(tallies, [](const Tally& t) { return t.pipe; });
  const auto locators = NamesOf(tallies, [](const Tally& t) { return t.locator; });
  const double width = static_cast<double>(pipes.size()) * (kPanel + kLeft) + 160;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Number(width) + "\" height=\"" +
                    Number(kTop + kHeight + 50) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"white\"/>\n";
  for (std::size_t p = 0; p < pipes.size(); ++p) {
    const Panel panel{kLeft + static_cast<double>(p) * (kPanel + kLeft)};
    double slope_dB_m = 0;
    std::vector<std::vector<const Tally*>> curves(locators.size());
    for (const Tally& t : tallies) {
      if (t.pipe != pipes[p] || !t.snr_dB) continue;
      slope_dB_m = t.slope_dB_m;
      const auto at = std::find(locators.begin(), locators.end(), t.locator) - locators.begin();
      curves[static_cast<std::size_t>(at)].push_back(&t);
    }
    svg += DrawGrid(panel, "Pd, " + pipes[p] + ", " + FormatDigits(slope_dB_m, 2) + " dB/m at 2 kHz");
    for (std::size_t i = 0; i < curves.size(); ++i)
      svg += DrawCurve(panel, curves[i], kColours[i % std::size(kColours)]);
  }
  for (std::size_t i = 0; i < locators.size(); ++i) {
    svg += Text(width - 140, kTop + 16 * static_cast<double>(i + 1), locators[i],
                std::string("fill=\"") + kColours[i % std::size(kColours)] + "\"");
  }
  return svg + "</svg>\n";
}

}  // namespace piperun::scenarios::detectors
