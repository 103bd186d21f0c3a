#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "estimator/estimator.h"

namespace piperun::estimator {

/// Finds leak passages in the hydrophone's record and places them on the filter's own track.
class LeakLocator {
 public:
  virtual ~LeakLocator() = default;
  /// The filter's state, at least once per audio block and before it, stamps increasing.
  virtual void IngestNav(const NavState& nav) = 0;
  virtual void IngestAudio(const AudioBlock& block) = 0;
  virtual void Finish() = 0;
  virtual const std::vector<LeakEstimate>& leaks() const = 0;
};

struct LocatorKind {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  std::unique_ptr<LeakLocator> (*make)(const Params& params, const EstimatorStart& start);
};

/// Generated from estimator/locators/*.cc.
const std::vector<LocatorKind>& LocatorKinds();

}  // namespace piperun::estimator
