#include "sim/drag.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>

#include "base/check.h"

namespace piperun::sim {
namespace {

constexpr double kLog10E = std::numbers::log10e;

constexpr std::array<DragLawInfo, 6> kLaws{{
    {DragLaw::kBrownLawler, "brown_lawler", "Brown & Lawler", 2e5, INFINITY},
    {DragLaw::kCliftGauvin, "clift_gauvin", "Clift & Gauvin (refit)", 2e5, INFINITY},
    {DragLaw::kCliftGauvin1970, "clift_gauvin_1970", "Clift & Gauvin", 3e5, INFINITY},
    // the last maxima of C_D: dC_D/dRe = 0
    {DragLaw::kCliftGraceWeber, "clift_grace_weber", "Clift, Grace & Weber", 1e6, 129680},
    {DragLaw::kMorrison, "morrison", "Morrison", 1e6, 153420},
    {DragLaw::kBaratiHigh, "barati_high", "Barati et al.", 1e6, 201163},
}};

/// Re to a power.
double Power(const Reynolds& re, double exponent) { return std::exp(exponent * re.log); }

double BrownLawler(const Reynolds& re) {
  return 24 * (1 + 0.150 * Power(re, 0.681)) + 0.407 * re.value * re.value / (re.value + 8710);
}

double CliftGauvin(const Reynolds& re) {
  const double q = Power(re, 0.94);
  return 24 * (1 + 0.152 * Power(re, 0.677)) + 0.417 * re.value * q / (q + 5070);
}

double CliftGauvin1970(const Reynolds& re) {
  const double q = Power(re, 1.16);
  return 24 * (1 + 0.15 * Power(re, 0.687)) + 0.42 * re.value * q / (q + 42500);
}

constexpr std::array<double, 9> kSegmentEnds{0.01, 20, 260, 1500, 1.2e4, 4.4e4, 3.38e5, 4e5, 1e6};

/// One segment of Clift, Grace & Weber as C_D Re.
double CliftGraceWeberSegment(std::size_t segment, const Reynolds& re) {
  const double x = kLog10E * re.log;
  const auto power_of_ten = [&](double exponent) { return re.value * std::exp(exponent / kLog10E); };
  switch (segment) {
    case 0:
      return 24 + 3.0 / 16 * re.value;
    case 1:
      return 24 * (1 + 0.1315 * Power(re, 0.82 - 0.05 * x));
    case 2:
      return 24 * (1 + 0.1935 * Power(re, 0.6305));
    case 3:
      return power_of_ten(1.6435 + x * (-1.1242 + x * 0.1558));
    case 4:
      return power_of_ten(-2.4571 + x * (2.5558 + x * (-0.9295 + x * 0.1049)));
    case 5:
      return power_of_ten(-1.9181 + x * (0.6370 - x * 0.0636));
    case 6:
      return power_of_ten(-4.3390 + x * (1.5809 - x * 0.1546));
    case 7:
      return re.value * (29.78 - 5.3 * x);
    case 8:
      return re.value * (0.10 * x - 0.49);
    default:
      return 0.19 * re.value - 8e4;
  }
}

double CliftGraceWeber(const Reynolds& re) {
  constexpr double kJoin = 0.05;  // share of Re below a segment's end
  std::size_t i = 0;
  while (i < kSegmentEnds.size() && re.value >= kSegmentEnds[i]) ++i;
  const double own = CliftGraceWeberSegment(i, re);
  if (i == kSegmentEnds.size()) return own;
  const double past = (re.value / kSegmentEnds[i] - (1 - kJoin)) / kJoin;
  if (past <= 0) return own;
  return std::lerp(own, CliftGraceWeberSegment(i + 1, re), past * past * (3 - 2 * past));
}

double Morrison(const Reynolds& re) {
  constexpr double kLog5 = 1.6094379124341003, kLog263000 = 12.479909311159902;
  const double x = re.value / 263000, x2 = x * x, x4 = x2 * x2;
  const double wake = 0.52 * re.value / (1 + std::exp(1.52 * (re.log - kLog5)));
  const double crisis = 0.411 * std::exp(0.06 * (re.log - kLog263000)) / (1 + x4 * x4);
  return 24 + re.value * (wake + crisis + Power(re, 0.8) / 461000);
}

double BaratiHighAbove(const Reynolds& re) {
  const double x = re.value, x2 = x * x, tanh_x = std::tanh(x);
  const double a = x / 6530, b = x / 1620, c = kLog10E * std::log(x2 + 10.7563), d = (x + x2) * (x + x2);
  const double sum = 8e-6 * (a * a + tanh_x - 8 * kLog10E * re.log) - 0.4119 * std::exp(-2.08e43 / (d * d)) -
                     2.1344 * std::exp(-(c * c + 9.9867) / x) + 0.1357 * std::exp(-(b * b + 10370) / x) +
                     2.4795;
  return x * sum - 8.5e-3 * (2 * kLog10E * std::log(std::tanh(tanh_x)) - 2825.7162);
}

double BaratiHigh(const Reynolds& re) {
  constexpr double kLow = 0.01;
  if (re.value >= kLow) return BaratiHighAbove(re);
  return std::lerp(24, BaratiHighAbove(kLow), re.value / kLow);
}

}  // namespace

const DragLawInfo& FindDragLaw(DragLaw law) { return kLaws[static_cast<std::size_t>(law)]; }

const DragLawInfo& FindDragLaw(std::string_view key) {
  const auto found = std::ranges::find(kLaws, key, &DragLawInfo::key);
  Demand(found != kLaws.end(), "every drag law that scenarios may name is known");
  return *found;
}

double CalcDragTimesReynolds(DragLaw law, const Reynolds& reynolds) {
  switch (law) {
    case DragLaw::kBrownLawler:
      return BrownLawler(reynolds);
    case DragLaw::kCliftGauvin:
      return CliftGauvin(reynolds);
    case DragLaw::kCliftGauvin1970:
      return CliftGauvin1970(reynolds);
    case DragLaw::kCliftGraceWeber:
      return CliftGraceWeber(reynolds);
    case DragLaw::kMorrison:
      return Morrison(reynolds);
    case DragLaw::kBaratiHigh:
      return BaratiHigh(reynolds);
  }
  return 0;
}

double CalcDragCoefficient(DragLaw law, const Reynolds& reynolds) {
  return CalcDragTimesReynolds(law, reynolds) / reynolds.value;
}

double SphereDrag::TimesReynolds(const Reynolds& reynolds) const {
  const double held_from = crisis ? INFINITY : FindDragLaw(law).crisis_reynolds;
  if (reynolds.value <= held_from) return CalcDragTimesReynolds(law, reynolds);
  return CalcDragCoefficient(law, held_from) * reynolds.value;
}

double CalcSpinTorqueTimesReynolds(double spin_reynolds) {
  if (spin_reynolds <= 32) return 64 * std::numbers::pi;
  return 12.9 * std::sqrt(spin_reynolds) + 128.4;
}

}  // namespace piperun::sim
