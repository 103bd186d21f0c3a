#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "scenarios/detect.h"

namespace piperun::scenarios {
namespace {

constexpr double kWidth = 1000, kPanel = 200, kLeft = 70, kRight = 20, kTop = 40, kGap = 50;

std::string Number(double x) { return FormatFixed(x, 1); }

std::string Text(double x, double y, const std::string& text, const std::string& style) {
  return "<text x=\"" + Number(x) + "\" y=\"" + Number(y) + "\" " + style + ">" + text + "</text>\n";
}

/// A linear axis.
struct Axis {
  double low = 0, high = 1, from = 0, to = 1;
  double At(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

Axis MakeAxis(const std::vector<double>& values, double from, double to) {
  if (values.empty()) return {0, 1, from, to};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, std::max(*high, *low + 1e-3), from, to};
}

std::string DrawTicks(const Axis& x, const Axis& y) {
  std::string svg;
  for (int i = 0; i <= 4; ++i) {
    const double u = 0.25 * i, level = y.low + u * (y.high - y.low), place = x.low + u * (x.high - x.low);
    svg += "<line x1=\"" + Number(x.from) + "\" y1=\"" + Number(y.At(level)) + "\" x2=\"" + Number(x.to) +
           "\" y2=\"" + Number(y.At(level)) + "\" stroke=\"#ddd\"/>\n";
    svg += Text(x.from - 6, y.At(level) + 4, FormatFixed(level, 1), "text-anchor=\"end\"");
    svg += Text(x.At(place), y.from + 16, FormatFixed(place, 1), "text-anchor=\"middle\"");
  }
  return svg;
}

std::string DrawCurve(const Axis& x, const Axis& y, const std::vector<double>& places,
                      const std::vector<double>& levels) {
  std::string points;
  for (std::size_t i = 0; i < places.size(); ++i)
    points += Number(x.At(places[i])) + "," + Number(y.At(levels[i])) + " ";
  return "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"#1f77b4\"/>\n";
}

}  // namespace

std::string DrawDetectionsSvg(const Detections& detections) {
  std::vector<double> places, band_dB, ratio_dB;
  for (const DetectedLevel& level : detections.levels) {
    places.push_back(detections.placed ? level.chainage_m : level.time_s);
    band_dB.push_back(level.band_dB);
    ratio_dB.push_back(level.ratio_dB);
  }
  const double height = kTop + 2 * (kPanel + kGap);
  const Axis x = MakeAxis(places, kLeft, kWidth - kRight);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Number(kWidth) + "\" height=\"" +
                    Number(height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"white\"/>\n";
  const std::string along = detections.placed ? "chainage, m" : "time, s";
  double top = kTop;
  for (const auto& [title, levels] : {std::pair{"band 1-4 kHz, dB re 1 uPa", &band_dB},
                                      std::pair{"band over 200-1000 Hz, dB", &ratio_dB}}) {
    const Axis y = MakeAxis(*levels, top + kPanel, top);
    svg += DrawTicks(x, y) + DrawCurve(x, y, places, *levels);
    svg += Text(kLeft, top - 8, std::string(title) + " against " + along, "font-size=\"13\"");
    for (const estimator::LeakEstimate& leak : detections.leaks) {
      const double at = x.At(detections.placed ? leak.chainage_m : Seconds(leak.t_cpa));
      svg += "<line x1=\"" + Number(at) + "\" y1=\"" + Number(top) + "\" x2=\"" + Number(at) + "\" y2=\"" +
             Number(top + kPanel) + "\" stroke=\"#d62728\" stroke-dasharray=\"5 3\"/>\n";
    }
    top += kPanel + kGap;
  }
  return svg + "</svg>\n";
}

}  // namespace piperun::scenarios
