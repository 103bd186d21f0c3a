#include "estimator/sound_profile.h"

#include <algorithm>
#include <cmath>

namespace piperun::estimator {

SoundProfile::SoundProfile(double bin_m, double length_m)
    : bin_m_(bin_m), ring_(static_cast<std::size_t>(std::ceil(length_m / bin_m)) + 1) {}

std::int64_t SoundProfile::IndexOf(double chainage_m) const {
  return static_cast<std::int64_t>(std::floor(chainage_m / bin_m_));
}

void SoundProfile::Add(const TrackPoint& ball, const SoundLevels& levels_dB) {
  const std::int64_t i = IndexOf(ball.chainage_m);
  if (empty()) {
    first_ = i;
    last_ = i - 1;
  }
  const auto capacity = static_cast<std::int64_t>(ring_.size());
  for (std::int64_t k = std::max(last_ + 1, i - capacity + 1); k <= i; ++k) ring_[Slot(k)] = ProfileBin{};
  last_ = std::max(last_, i);
  first_ = std::max(first_, last_ - capacity + 1);
  if (i < first_) return;  // the ball has rolled back further than we remember
  ProfileBin& bin = ring_[Slot(i)];
  bin.weight += 1;
  const double share = 1 / bin.weight;
  bin.chainage_m += share * (ball.chainage_m - bin.chainage_m);
  bin.chainage_sd_m += share * (ball.chainage_sd_m - bin.chainage_sd_m);
  for (std::size_t c = 0; c < levels_dB.size(); ++c) {
    bin.levels_dB[c] += share * (levels_dB[c] - bin.levels_dB[c]);
  }
  bin.time_s += share * (Seconds(ball.time) - bin.time_s);
  bin.p_W += share * (ball.p_W - bin.p_W);
}

TrackPoint SoundProfile::Interpolate(double chainage_m) const {
  const std::int64_t middle = std::clamp(IndexOf(chainage_m), first_, last_);
  const ProfileBin* before = nullptr;
  const ProfileBin* after = nullptr;
  for (std::int64_t i = middle; i >= first_ && !before; --i) {
    if (At(i).weight > 0 && At(i).chainage_m <= chainage_m) before = &At(i);
  }
  for (std::int64_t i = middle; i <= last_ && !after; ++i) {
    if (At(i).weight > 0 && At(i).chainage_m > chainage_m) after = &At(i);
  }
  if (!before) before = after;
  if (!after) after = before;
  Demand(before != nullptr, "a sound profile that is asked for a place holds one");
  const double step = after->chainage_m - before->chainage_m;
  const double u = step > 0 ? (chainage_m - before->chainage_m) / step : 0;
  const auto mix = [u](const auto& a, const auto& b) { return a + u * (b - a); };
  return {RobotTime(FromSeconds(mix(before->time_s, after->time_s))), chainage_m,
          mix(before->chainage_sd_m, after->chainage_sd_m),
          Vector3d(before->p_W + u * (after->p_W - before->p_W))};
}

}  // namespace piperun::estimator
