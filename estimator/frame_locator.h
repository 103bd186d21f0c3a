#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "estimator/band_frames.h"
#include "estimator/leak_locator.h"
#include "estimator/nav_track.h"

namespace piperun::estimator {

/// A frame of sound and where the ball was in the middle of it.
template <class Frame>
struct Located {
  Frame sound;
  TrackPoint ball;
};

/// What all locators here share: frames cut out of the sound by an Analyser, each placed on the filter's
/// track. A frame waits until the track has passed it; frames without a valid track or without any sound are
/// left out. An Analyser has a type Frame with `time` and `silent()`, and Ingest(block, sink).
template <class Analyser>
class PlacedFrameLocator : public LeakLocator {
 public:
  using Frame = typename Analyser::Frame;

  explicit PlacedFrameLocator(Analyser analyser) : analyser_(std::move(analyser)), waiting_(kMaxWaiting) {
    leaks_.reserve(kExpectedLeaks);
  }

  void IngestNav(const NavState& nav) final {
    track_.Push(nav);
    Deliver(false);
  }
  void IngestAudio(const AudioBlock& block) final {
    analyser_.Ingest(block, [this](const Frame& frame) { Wait(frame); });
    Deliver(false);
  }
  void Finish() final {
    Deliver(true);
    Complete();
  }
  const std::vector<LeakEstimate>& leaks() const final { return leaks_; }

 protected:
  virtual void Consume(const Located<Frame>& frame) = 0;
  /// No more frames will come.
  virtual void Complete() = 0;
  /// Keeps leaks() in order of t_cpa.
  void Report(const LeakEstimate& leak) {
    const auto later = std::upper_bound(leaks_.begin(), leaks_.end(), leak,
                                        [](const auto& a, const auto& b) { return a.t_cpa < b.t_cpa; });
    leaks_.insert(later, leak);
  }

 private:
  static constexpr std::size_t kMaxWaiting = 4096;
  static constexpr std::size_t kExpectedLeaks = 256;

  void Wait(const Frame& frame) {
    if (count_ == kMaxWaiting) {  // the track has stopped: the oldest frame has no place on it
      first_ = (first_ + 1) % kMaxWaiting;
      --count_;
    }
    waiting_[(first_ + count_++) % kMaxWaiting] = frame;
  }
  void Deliver(bool to_the_end) {
    for (; count_ > 0; --count_) {
      const Frame& frame = waiting_[first_];
      if (!to_the_end && (track_.empty() || track_.latest() < frame.time)) return;
      const auto ball = track_.Eval(frame.time);
      if (ball && !frame.silent()) Consume({frame, *ball});
      first_ = (first_ + 1) % kMaxWaiting;
    }
  }

  Analyser analyser_;
  NavTrack track_;
  std::vector<Frame> waiting_;  // ring
  std::size_t first_ = 0, count_ = 0;
  std::vector<LeakEstimate> leaks_;
};

/// Locators that listen to the energy of two bands.
using LocatedFrame = Located<BandFrame>;
using FrameLocator = PlacedFrameLocator<BandFrames>;

}  // namespace piperun::estimator
