// The log-log plot of an Allan analysis.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "scenarios/allan_report.h"

namespace piperun::scenarios {
namespace {

using estimator::Index;
using estimator::NoiseTerm;

constexpr double kWidth = 860, kPanel = 460, kLeft = 90, kRight = 170, kTop = 50, kBottom = 60;
constexpr const char* kColours[] = {"#c0392b", "#1e8449", "#1f618d", "#7d3c98", "#b9770e", "#2e4053"};
constexpr const char* kTermLetters[] = {"Q", "N", "B", "K", "R", "GM"};

std::string Text(double x) {
  char text[32];
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

/// Decades of both axes, and where a point of the plot lies on the sheet.
class Panel {
 public:
  Panel(const std::vector<const AllanChannel*>& channels, double period_s, double top) : top_(top) {
    double low = std::numeric_limits<double>::infinity(), high = 0, longest = 1;
    for (const AllanChannel* channel : channels) {
      for (const auto& point : channel->points) {
        if (point.variance <= 0) continue;
        low = std::min(low, point.variance);
        high = std::max(high, point.variance);
        longest = std::max(longest, static_cast<double>(point.cluster.samples));
      }
    }
    x_low_ = std::floor(std::log10(period_s));
    x_high_ = std::ceil(std::log10(period_s * longest));
    y_low_ = std::floor(0.5 * std::log10(low) - 0.1);
    y_high_ = std::ceil(0.5 * std::log10(high) + 0.1);
  }
  double X(double tau_s) const { return Clamp(std::log10(tau_s), x_low_, x_high_) * XScale() + kLeft; }
  double Y(double deviation) const {
    const double up = Clamp(std::log10(std::max(deviation, 1e-300)), y_low_, y_high_);
    return top_ + kPanel - kBottom - up * (kPanel - kTop - kBottom) / (y_high_ - y_low_);
  }
  std::string At(double tau_s, double deviation) const {
    return Text(X(tau_s)) + "," + Text(Y(deviation)) + " ";
  }
  bool Shows(double deviation) const {
    return deviation > std::pow(10, y_low_) && deviation < std::pow(10, y_high_);
  }
  int x_low() const { return static_cast<int>(x_low_); }
  int x_high() const { return static_cast<int>(x_high_); }
  int y_low() const { return static_cast<int>(y_low_); }
  int y_high() const { return static_cast<int>(y_high_); }
  double top() const { return top_; }

 private:
  static double Clamp(double x, double low, double high) { return std::clamp(x, low, high) - low; }
  double XScale() const { return (kWidth - kLeft - kRight) / (x_high_ - x_low_); }
  double top_, x_low_, x_high_, y_low_, y_high_;
};

std::string Line(const std::string& points, const std::string& style) {
  return "<polyline points=\"" + points + "\" fill=\"none\" " + style + "/>\n";
}

std::string Label(double x, double y, const std::string& text, const std::string& style) {
  return "<text x=\"" + Text(x) + "\" y=\"" + Text(y) + "\" " + style + ">" + text + "</text>\n";
}

std::string Power(int exponent) {
  return "10<tspan dy=\"-5\" font-size=\"9\">" + std::to_string(exponent) + "</tspan>";
}

std::string DrawGrid(const Panel& panel) {
  std::string svg;
  const double bottom = std::pow(10, panel.y_low()), top = std::pow(10, panel.y_high());
  const double left = std::pow(10, panel.x_low()), right = std::pow(10, panel.x_high());
  for (int x = panel.x_low(); x <= panel.x_high(); ++x) {
    const double tau = std::pow(10, x);
    svg += Line(panel.At(tau, bottom) + panel.At(tau, top), "stroke=\"#ddd\"");
    svg += Label(panel.X(tau), panel.Y(bottom) + 18, Power(x), "text-anchor=\"middle\"");
  }
  for (int y = panel.y_low(); y <= panel.y_high(); ++y) {
    const double deviation = std::pow(10, y);
    svg += Line(panel.At(left, deviation) + panel.At(right, deviation), "stroke=\"#ddd\"");
    svg += Label(kLeft - 8, panel.Y(deviation) + 4, Power(y), "text-anchor=\"end\"");
  }
  return svg + Label(0.5 * (kLeft + kWidth - kRight), panel.Y(bottom) + 40, "averaging time tau, s",
                     "text-anchor=\"middle\"");
}

std::string DrawChannel(const Panel& panel, const AllanChannel& channel, double period_s, double confidence,
                        const std::string& colour) {
  std::string upper, lower, measured, fitted;
  for (std::size_t i = 0; i < channel.points.size(); ++i) {
    const auto& p = channel.points[i];
    if (p.variance <= 0) continue;
    const double tau = period_s * static_cast<double>(p.cluster.samples);
    const auto band =
        estimator::CalcVarianceInterval(p.variance, channel.fit.degrees_of_freedom[i], confidence);
    upper += panel.At(tau, std::sqrt(band.high));
    lower = panel.At(tau, std::sqrt(band.low)) + lower;
    measured += panel.At(tau, std::sqrt(p.variance));
    fitted += panel.At(tau, std::sqrt(CalcAllanVariance(channel.fit.model, p.cluster.samples)));
  }
  return "<polygon points=\"" + upper + lower + "\" fill=\"" + colour + "\" fill-opacity=\"0.15\"/>\n" +
         Line(measured, "stroke=\"" + colour + "\" stroke-width=\"1.8\"") +
         Line(fitted, "stroke=\"#222\" stroke-width=\"0.9\" stroke-dasharray=\"6 2\"");
}

std::string DrawTerm(const Panel& panel, const AllanChannel& channel, NoiseTerm term, double period_s) {
  const double coefficient = channel.fit.model.coefficients[Index(term)];
  std::string points, label;
  for (const auto& p : channel.points) {
    const double tau = period_s * static_cast<double>(p.cluster.samples);
    const double deviation =
        coefficient * std::sqrt(CalcUnitAllanVariance(term, channel.fit.model.shape, p.cluster.samples));
    if (!panel.Shows(deviation)) continue;
    if (points.empty())
      label = Label(panel.X(tau) + 4, panel.Y(deviation) - 4, kTermLetters[Index(term)], "fill=\"#666\"");
    points += panel.At(tau, deviation);
  }
  return Line(points, "stroke=\"#888\" stroke-width=\"0.8\" stroke-dasharray=\"2 3\"") + label;
}

std::string DrawPanel(const std::vector<const AllanChannel*>& channels, const AllanAnalysis& analysis,
                      double top) {
  const double period_s = analysis.timing.period_s;
  const Panel panel(channels, period_s, top);
  const AllanChannel& first = *channels.front();
  std::string svg =
      DrawGrid(panel) +
      Label(kLeft, top + 32, Escaped(first.group + ": Allan deviation, " + first.unit), "font-size=\"15\"");
  for (std::size_t i = 0; i < estimator::kNoiseTerms; ++i) {
    const auto term = static_cast<NoiseTerm>(i);
    if (first.fit.terms[i].identifiable) svg += DrawTerm(panel, first, term, period_s);
  }
  double y = top + kTop + 14;
  const double x = kWidth - kRight + 14;
  for (std::size_t i = 0; i < channels.size(); ++i, y += 18) {
    const std::string colour = kColours[i % std::size(kColours)];
    svg += DrawChannel(panel, *channels[i], period_s, analysis.confidence, colour) +
           Label(x, y, Escaped(channels[i]->axis), "fill=\"" + colour + "\"");
  }
  return svg + Label(x, y + 6, "band: confidence", "fill=\"#555\"") +
         Label(x, y + 22, "dashed black: fit", "fill=\"#555\"") +
         Label(x, y + 38, "dotted: its terms,", "fill=\"#555\"") +
         Label(x, y + 52, "first axis", "fill=\"#555\"");
}

}  // namespace

std::string DrawAllanSvg(const AllanAnalysis& analysis) {
  std::vector<std::vector<const AllanChannel*>> groups;
  for (const AllanChannel& channel : analysis.channels) {
    if (groups.empty() || groups.back().front()->group != channel.group) groups.emplace_back();
    groups.back().push_back(&channel);
  }
  const double height = 40 + kPanel * static_cast<double>(groups.size());
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Text(kWidth) + "\" height=\"" +
                    Text(height) + "\" viewBox=\"0 0 " + Text(kWidth) + " " + Text(height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"white\"/>\n" +
                    Label(kLeft, 26, Escaped(analysis.file), "font-size=\"16\"");
  double top = 30;
  for (const auto& group : groups) {
    svg += DrawPanel(group, analysis, top);
    top += kPanel;
  }
  return svg + "</svg>\n";
}

}  // namespace piperun::scenarios
