#include "estimator/fitting_flags.h"

#include <utility>

namespace piperun::estimator {

FittingFlags::FittingFlags(std::unique_ptr<LeakLocator> locator, std::vector<PlacedFitting> fittings)
    : locator_(std::move(locator)), fittings_(std::move(fittings)) {}

void FittingFlags::IngestNav(const NavState& nav) {
  locator_->IngestNav(nav);
  if (locator_->leaks().size() != leaks_.size()) Judge();
}

void FittingFlags::IngestAudio(const AudioBlock& block) {
  locator_->IngestAudio(block);
  if (locator_->leaks().size() != leaks_.size()) Judge();
}

void FittingFlags::Finish() {
  locator_->Finish();
  Judge();
}

/// New leaks may stand between the old.
void FittingFlags::Judge() {
  leaks_ = locator_->leaks();
  for (LeakEstimate& leak : leaks_) {
    if (!(leak.confidence > 0)) continue;
    const FittingVerdict verdict = JudgeByFittings(fittings_, leak.chainage_m, leak.sigma_m, leak.confidence);
    leak.at = verdict.at;
    leak.confidence = verdict.confidence;
  }
}

}  // namespace piperun::estimator
