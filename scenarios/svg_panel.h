#pragma once

#include <span>
#include <string>

namespace piperun::scenarios {

/// A linear axis of a drawing: `low` lies at pixel `from`, `high` at pixel `to`.
struct SvgAxis {
  double low = 0, high = 1;
  double from = 0, to = 1;
  double At(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

/// Over the values, 1e-3 at least.
SvgAxis MakeSvgAxis(std::span<const double> values, double from, double to);

/// A white drawing of this size around `content`.
std::string DrawSvg(double width, double height, const std::string& content);
/// Text at a place; `style`: attributes.
std::string DrawSvgText(double x, double y, const std::string& text, const std::string& style);
/// Five lines across and five numbers along each axis.
std::string DrawSvgGrid(const SvgAxis& x, const SvgAxis& y, int decimals = 1);
std::string DrawSvgCurve(const SvgAxis& x, const SvgAxis& y, std::span<const double> places,
                         std::span<const double> levels);
/// A dashed line across a panel at a place.
std::string DrawSvgMark(double x, const SvgAxis& y);

}  // namespace piperun::scenarios
