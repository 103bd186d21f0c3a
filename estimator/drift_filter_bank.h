#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/drift_filter.h"
#include "estimator/sound_profile.h"

namespace piperun::estimator {

/// Drift filters of a bank of roofs, moved along a profile. The window reaches `half` bins to both sides;
/// near the ends of a record, and at other speeds, other filters are right: they are made when they are first
/// needed, in steps of a sixth of the window and for 1, 3, 10, 30 and 100 frames per bin.
class DriftFilterBank {
 public:
  struct Geometry {
    std::int64_t half = 0;
    std::int64_t least = 0;  ///< bins that must have been heard on each side: a roof needs both
    double bin_m = 0;
  };
  DriftFilterBank(const LevelModel& model, std::vector<Roof> roofs, const Geometry& geometry);

  const std::vector<Roof>& roofs() const { return roofs_; }
  /// Lays the window around a bin; what was not heard between two bins is put on the line between them. False
  /// when too little was heard on either side.
  bool Look(const SoundProfile& profile, std::int64_t bin);
  /// The response of a roof on top of the bin that was looked at last.
  DriftFilter::Response Eval(std::size_t roof) const { return current_->Eval(roof, levels_dB_); }
  /// What a roof on top of the bin that was looked at last would respond to another roof alone, of amplitude
  /// one and `offset` bins further on: z.
  double CalcCrosstalk(std::size_t roof, std::size_t other, std::int64_t offset);
  /// log of the mean over the bank of exp(z^2 / (2 scale^2)): the likelihood of a leak at that bin, height
  /// free, over none, with the shape of the roof marginalised.
  double CalcLogLikelihood(double noise_scale) const;

 private:
  double FillLevels(const SoundProfile& profile, std::int64_t first, std::int64_t last, std::int64_t base);
  void FillTo(const ProfileBin& bin, std::int64_t from, std::int64_t to);
  const DriftFilter& FilterFor(double frames_per_bin, std::int64_t behind, std::int64_t ahead);

  LevelModel model_;
  std::vector<Roof> roofs_;
  Geometry geometry_;
  std::vector<std::optional<DriftFilter>> filters_;
  const DriftFilter* current_ = nullptr;
  Eigen::VectorXd levels_dB_;  // the window's, band first, then reference
  Eigen::VectorXd alone_dB_;   // scratch: of one roof
};

}  // namespace piperun::estimator
