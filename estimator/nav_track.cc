#include "estimator/nav_track.h"

#include <algorithm>

namespace piperun::estimator {
namespace {

TrackPoint Interpolate(const TrackPoint& a, const TrackPoint& b, RobotTime t) {
  const double u = Seconds(t - a.time) / Seconds(b.time - a.time);
  return {t, a.chainage_m + u * (b.chainage_m - a.chainage_m),
          a.chainage_sd_m + u * (b.chainage_sd_m - a.chainage_sd_m), a.p_W + u * (b.p_W - a.p_W)};
}

}  // namespace

void NavTrack::Push(const NavState& nav) {
  if (!nav.valid || (size_ > 0 && nav.stamp < latest() + kSpacing)) return;
  if (size_ == kCapacity) {
    begin_ = (begin_ + 1) % kCapacity;
    --size_;
  }
  ring_[(begin_ + size_) % kCapacity] = {nav.stamp, nav.chainage_m, nav.chainage_sd_m, nav.p_W};
  ++size_;
}

std::optional<TrackPoint> NavTrack::Eval(RobotTime t) const {
  if (size_ == 0 || t < At(0).time) return std::nullopt;
  if (size_ == 1) return t == At(0).time ? std::optional(At(0)) : std::nullopt;
  // first point later than t, but never the very first
  std::size_t low = 1, high = size_ - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (At(middle).time > t) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return Interpolate(At(low - 1), At(low), t);
}

}  // namespace piperun::estimator
