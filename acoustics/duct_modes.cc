#include "acoustics/duct_modes.h"

#include <algorithm>
#include <cmath>

namespace piperun::acoustics {
namespace {

constexpr double kStep = 0.1;  // zeros of J_m' lie more than 2.4 apart, the first is above m

/// J_m'(x) = (m/x) J_m(x) - J_(m+1)(x)
double CalcSlope(int m, double x) {
  return m / x * std::cyl_bessel_j(static_cast<double>(m), x) - std::cyl_bessel_j(m + 1.0, x);
}

/// Zero of J_m' between two places of unlike sign, by halves.
double FindRoot(int m, double low, double high) {
  const bool rises = CalcSlope(m, low) < 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((CalcSlope(m, middle) < 0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void AddModes(int m, std::vector<DuctMode>& modes) {
  const double begin = m == 0 ? 1 : m;
  for (int i = 0; begin + kStep * (i + 1) <= kLargestRoot + kStep; ++i) {
    const double low = begin + kStep * i, high = begin + kStep * (i + 1);
    if ((CalcSlope(m, low) < 0) == (CalcSlope(m, high) < 0)) continue;
    const double root = FindRoot(m, low, high), ratio = m / root;
    if (root <= kLargestRoot) modes.push_back({m, root, (m == 0 ? 1 : 2) / (1 - ratio * ratio)});
  }
}

std::vector<DuctMode> ListModes() {
  std::vector<DuctMode> modes;
  for (int m = 0; m < kLargestRoot; ++m) AddModes(m, modes);
  std::sort(modes.begin(), modes.end(), [](const DuctMode& a, const DuctMode& b) { return a.root < b.root; });
  return modes;
}

}  // namespace

double DuctMode::CalcShape(double r_over_a) const {
  const double order = m, ratio = m / root;
  const double inside = std::cyl_bessel_j(order, root * r_over_a), at_wall = std::cyl_bessel_j(order, root);
  return inside * inside / (at_wall * at_wall * (1 - ratio * ratio));
}

const std::vector<DuctMode>& DuctModes() {
  static const std::vector<DuctMode> modes = ListModes();
  return modes;
}

}  // namespace piperun::acoustics
