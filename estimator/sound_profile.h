#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "estimator/frame_locator.h"

namespace piperun::estimator {

/// Levels of one frame: of the band's noise over the reference band's, of the band's alone, of the reference
/// band's, and of all that is in the band.
using SoundLevels = std::array<double, 4>;
enum class Channel : std::size_t { kRatio, kBand, kReference, kPower };

/// All frames heard within one short stretch of chainage, averaged.
struct ProfileBin {
  double weight = 0;  ///< frames; 0: none was heard here
  double chainage_m = 0;
  double chainage_sd_m = 0;
  SoundLevels levels_dB{};
  double time_s = 0;  ///< since the robot clock's origin
  Vector3d p_W = Vector3d::Zero();
};

/// Level against chainage over the last stretch of the way, in bins of equal width. Memory is fixed: bins
/// further than `length_m` behind the front are forgotten.
class SoundProfile {
 public:
  SoundProfile(double bin_m, double length_m);

  void Add(const TrackPoint& ball, const SoundLevels& levels_dB);
  bool empty() const { return last_ < first_; }
  std::int64_t first() const { return first_; }
  std::int64_t last() const { return last_; }
  double bin_m() const { return bin_m_; }
  std::int64_t IndexOf(double chainage_m) const;
  double Centre_m(std::int64_t i) const { return (static_cast<double>(i) + 0.5) * bin_m_; }
  /// Range: first() <= i <= last().
  const ProfileBin& At(std::int64_t i) const { return ring_[Slot(i)]; }
  /// Time and place at a chainage, linear between the bins around it that hold frames.
  TrackPoint Interpolate(double chainage_m) const;

 private:
  std::size_t Slot(std::int64_t i) const {
    const auto n = static_cast<std::int64_t>(ring_.size());
    return static_cast<std::size_t>(((i % n) + n) % n);
  }

  double bin_m_;
  std::vector<ProfileBin> ring_;
  std::int64_t first_ = 0;
  std::int64_t last_ = -1;
};

}  // namespace piperun::estimator
