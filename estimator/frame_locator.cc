#include "estimator/frame_locator.h"

#include <algorithm>

namespace piperun::estimator {
namespace {

constexpr std::size_t kMaxWaiting = 4096;
constexpr std::size_t kExpectedLeaks = 256;

}  // namespace

FrameLocator::FrameLocator(const BandParams& params) : frames_(params), waiting_(kMaxWaiting) {
  params.Check();
  leaks_.reserve(kExpectedLeaks);
}

void FrameLocator::IngestNav(const NavState& nav) {
  track_.Push(nav);
  Deliver(false);
}

void FrameLocator::IngestAudio(const AudioBlock& block) {
  frames_.Ingest(block, [this](const BandFrame& frame) {
    if (count_ == kMaxWaiting) {  // the track has stopped: the oldest frame has no place on it
      first_ = (first_ + 1) % kMaxWaiting;
      --count_;
    }
    waiting_[(first_ + count_++) % kMaxWaiting] = frame;
  });
  Deliver(false);
}

void FrameLocator::Finish() {
  Deliver(true);
  Complete();
}

void FrameLocator::Deliver(bool to_the_end) {
  for (; count_ > 0; --count_) {
    const BandFrame& frame = waiting_[first_];
    if (!to_the_end && (track_.empty() || track_.latest() < frame.time)) return;
    const auto ball = track_.Eval(frame.time);
    if (ball && frame.power_Pa2 > 0 && frame.reference_power_Pa2 > 0) Consume({frame, *ball});
    first_ = (first_ + 1) % kMaxWaiting;
  }
}

void FrameLocator::Report(const LeakEstimate& leak) {
  const auto later = std::upper_bound(leaks_.begin(), leaks_.end(), leak,
                                      [](const auto& a, const auto& b) { return a.t_cpa < b.t_cpa; });
  leaks_.insert(later, leak);
}

}  // namespace piperun::estimator
