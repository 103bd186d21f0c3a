#include "sim/wall_foot.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

constexpr double kSameNormal = 1e-9;  // 1 - cos of the angle between
constexpr double kSameDistance_m = 1e-9;

bool IsSame(const WallFoot& a, const WallFoot& b) {
  return std::abs(a.distance_m - b.distance_m) < kSameDistance_m && a.normal.dot(b.normal) > 1 - kSameNormal;
}

bool IsNearer(const WallFoot& a, const WallFoot& b) { return a.distance_m < b.distance_m; }

}  // namespace

void WallFeet::Add(const WallFoot& foot) {
  for (std::size_t i = 0; i < size_; ++i) {
    if (IsSame(feet_[i], foot)) return;
  }
  if (size_ < kCapacity) {
    feet_[size_++] = foot;
    return;
  }
  WallFoot& farthest = *std::max_element(feet_.begin(), feet_.end(), IsNearer);
  if (IsNearer(foot, farthest)) farthest = foot;
}

}  // namespace piperun::sim
