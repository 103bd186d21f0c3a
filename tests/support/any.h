#pragma once

#include <rapidcheck.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/pose.h"

namespace piperun::any {

/// Integers and numbers drawn evenly over their whole range, for property tests. (rapidcheck's own ranges
/// grow with the number of the case.)
template <class T>
T Integer(T low, T high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<T>(low, high + 1));
}

inline double Between(double low, double high) {
  constexpr std::int64_t kSteps = 1'000'000;
  return low + (high - low) * static_cast<double>(Integer<std::int64_t>(0, kSteps)) / kSteps;
}

/// Each component between -size and size.
inline Vector3d Vector(double size) {
  return {Between(-size, size), Between(-size, size), Between(-size, size)};
}

/// Evenly over the sphere (Archimedes: z is uniform).
inline Vector3d UnitVector() {
  const double z = Between(-1, 1), angle = Between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace piperun::any
