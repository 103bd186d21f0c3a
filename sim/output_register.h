#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/pose.h"

namespace piperun::sim {

/// What the register that a sensor's value is read from can hold: y = LSB round(clip(x, -range, range) /
/// LSB), and the last whole LSB within the range where that lies beyond it. Range and resolution (LSB) in the
/// unit of the value; a resolution of 0 means unrounded.
struct OutputRegister {
  double range = std::numeric_limits<double>::infinity();
  double resolution = 0;

  double Read(double value) const {
    const double clipped = std::clamp(value, -range, range);
    if (!(resolution > 0)) return clipped;
    const double whole = resolution * std::round(clipped / resolution);
    const bool inside = std::abs(whole) <= range * (1 + 1e-12);  // a range of whole LSBs, but for rounding
    return inside ? whole : whole - std::copysign(resolution, whole);
  }
  /// Whether the value is within the range, up to its very end.
  bool Holds(double value) const { return std::abs(value) <= range; }
  Vector3d Read(const Vector3d& value) const { return {Read(value.x()), Read(value.y()), Read(value.z())}; }
};

}  // namespace piperun::sim
