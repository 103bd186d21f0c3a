#include "scenarios/svg_panel.h"

#include <algorithm>

#include "base/number.h"

namespace piperun::scenarios {
namespace {

std::string Pixel(double x) { return FormatFixed(x, 1); }

std::string DrawLine(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + Pixel(x1) + "\" y1=\"" + Pixel(y1) + "\" x2=\"" + Pixel(x2) + "\" y2=\"" +
         Pixel(y2) + "\" " + style + "/>\n";
}

}  // namespace

SvgAxis MakeSvgAxis(std::span<const double> values, double from, double to) {
  if (values.empty()) return {0, 1, from, to};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, std::max(*high, *low + 1e-3), from, to};
}

std::string DrawSvg(double width, double height, const std::string& content) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Pixel(width) + "\" height=\"" +
         Pixel(height) +
         "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"white\"/>\n" +
         content + "</svg>\n";
}

std::string DrawSvgText(double x, double y, const std::string& text, const std::string& style) {
  return "<text x=\"" + Pixel(x) + "\" y=\"" + Pixel(y) + "\" " + style + ">" + text + "</text>\n";
}

std::string DrawSvgGrid(const SvgAxis& x, const SvgAxis& y, int decimals) {
  std::string svg;
  for (int i = 0; i <= 4; ++i) {
    const double share = 0.25 * i;
    const double level = y.low + share * (y.high - y.low), place = x.low + share * (x.high - x.low);
    svg += DrawLine(x.from, y.At(level), x.to, y.At(level), "stroke=\"#ddd\"");
    svg += DrawSvgText(x.from - 6, y.At(level) + 4, FormatFixed(level, decimals), "text-anchor=\"end\"");
    svg += DrawSvgText(x.At(place), y.from + 16, FormatFixed(place, decimals), "text-anchor=\"middle\"");
  }
  return svg;
}

std::string DrawSvgCurve(const SvgAxis& x, const SvgAxis& y, std::span<const double> places,
                         std::span<const double> levels) {
  std::string points;
  for (std::size_t i = 0; i < places.size(); ++i)
    points += Pixel(x.At(places[i])) + "," + Pixel(y.At(levels[i])) + " ";
  return "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"#1f77b4\"/>\n";
}

std::string DrawSvgMark(double x, const SvgAxis& y) {
  return DrawLine(x, y.from, x, y.to, "stroke=\"#d62728\" stroke-dasharray=\"5 3\"");
}

}  // namespace piperun::scenarios
