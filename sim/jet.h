#pragma once

#include <algorithm>

namespace piperun::sim {

/// A quantity along a line with its first two derivatives there.
struct Jet {
  double value = 0;
  double d1 = 0;
  double d2 = 0;
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.d1 + b.d1, a.d2 + b.d2}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.d1 - b.d1, a.d2 - b.d2}; }
inline Jet operator*(double k, const Jet& a) { return {k * a.value, k * a.d1, k * a.d2}; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.d1 * b.value + a.value * b.d1,
          a.d2 * b.value + 2 * a.d1 * b.d1 + a.value * b.d2};
}
inline Jet Inverse(const Jet& a) {
  const double i = 1 / a.value;
  return {i, -a.d1 * i * i, (2 * a.d1 * a.d1 * i - a.d2) * i * i};
}

/// From 0 at x = 0 to 1 at x = 1, level and straight at both ends: 10 x^3 - 15 x^4 + 6 x^5; `slope` = dx/ds.
/// Derivatives are with s.
inline Jet CalcSmoothStep(double x, double slope) {
  const double y = std::clamp(x, 0.0, 1.0), z = 1 - y;
  return {y * y * y * (10 + y * (6 * y - 15)), 30 * y * y * z * z * slope,
          60 * y * z * (z - y) * slope * slope};
}

}  // namespace piperun::sim
