#pragma once

#include <optional>
#include <vector>

#include "estimator/estimator.h"

namespace piperun::estimator {

/// The filter's track at an instant.
struct TrackPoint {
  RobotTime time{};
  double chainage_m = 0;
  double chainage_sd_m = 0;
  Vector3d p_W = Vector3d::Zero();
};

/// The last seconds of a filter's track, for looking up where the ball was when a sound was heard. Keeps at
/// most one point per kSpacing, so that its memory and its bits depend on the track alone.
class NavTrack {
 public:
  static constexpr Duration kSpacing{5'000'000};
  static constexpr std::size_t kCapacity = 8192;  // 41 s

  NavTrack() { ring_.resize(kCapacity); }
  /// States that are not valid yet are left out.
  void Push(const NavState& nav);
  bool empty() const { return size_ == 0; }
  RobotTime latest() const { return At(size_ - 1).time; }
  /// Linear between neighbours; beyond the newest point along the last two; nothing before the oldest.
  std::optional<TrackPoint> Eval(RobotTime t) const;

 private:
  const TrackPoint& At(std::size_t i) const { return ring_[(begin_ + i) % kCapacity]; }

  std::vector<TrackPoint> ring_;
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
};

}  // namespace piperun::estimator
