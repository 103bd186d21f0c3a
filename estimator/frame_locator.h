#pragma once

#include <vector>

#include "estimator/band_frames.h"
#include "estimator/leak_locator.h"
#include "estimator/nav_track.h"

namespace piperun::estimator {

/// A frame of sound and where the ball was in the middle of it.
struct LocatedFrame {
  BandFrame sound;
  TrackPoint ball;
};

/// What all locators here share: frames of band energy, each placed on the filter's track. A frame waits
/// until the track has passed it; frames without a valid track or without any sound are left out.
class FrameLocator : public LeakLocator {
 public:
  explicit FrameLocator(const BandParams& params);

  void IngestNav(const NavState& nav) final;
  void IngestAudio(const AudioBlock& block) final;
  void Finish() final;
  const std::vector<LeakEstimate>& leaks() const final { return leaks_; }

 protected:
  virtual void Consume(const LocatedFrame& frame) = 0;
  /// No more frames will come.
  virtual void Complete() = 0;
  /// Keeps leaks() in order of t_cpa.
  void Report(const LeakEstimate& leak);

 private:
  void Deliver(bool to_the_end);

  BandFrames frames_;
  NavTrack track_;
  std::vector<BandFrame> waiting_;  // ring
  std::size_t first_ = 0, count_ = 0;
  std::vector<LeakEstimate> leaks_;
};

}  // namespace piperun::estimator
