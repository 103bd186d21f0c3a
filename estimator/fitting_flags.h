#pragma once

#include <memory>
#include <vector>

#include "estimator/fitting.h"
#include "estimator/leak_locator.h"

namespace piperun::estimator {

/// A locator whose leaks are judged by the map's fittings (JudgeByFittings): all stay in the list; those at a
/// fitting carry its label and the confidence that is left.
class FittingFlags final : public LeakLocator {
 public:
  FittingFlags(std::unique_ptr<LeakLocator> locator, std::vector<PlacedFitting> fittings);

  void IngestNav(const NavState& nav) override;
  void IngestAudio(const AudioBlock& block) override;
  void Finish() override;
  const std::vector<LeakEstimate>& leaks() const override { return leaks_; }

 private:
  void Judge();

  std::unique_ptr<LeakLocator> locator_;
  std::vector<PlacedFitting> fittings_;
  std::vector<LeakEstimate> leaks_;
};

}  // namespace piperun::estimator
