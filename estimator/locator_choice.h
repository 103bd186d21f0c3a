#pragma once

#include <memory>
#include <string>

#include "estimator/leak_locator.h"

namespace piperun::estimator {

/// Which leak locator listens beside a filter, and its parameters: a field for the parameters of filter
/// kinds.
class LocatorChoice {
 public:
  LocatorChoice() : LocatorChoice("matched_filter") {}
  /// `kind` is the name of a locator kind, or "none".
  explicit LocatorChoice(const std::string& kind);
  LocatorChoice(const LocatorChoice& other);
  LocatorChoice& operator=(const LocatorChoice& other);

  /// The kind first, then its parameters.
  void Visit(ParamVisitor& v);
  bool none() const { return !params_; }
  const std::string& kind() const { return kind_; }
  /// Nothing for "none". A map with fittings or tees has the locator's leaks judged by them (FittingFlags).
  std::unique_ptr<LeakLocator> Make(const EstimatorStart& start) const;

 private:
  std::string kind_;
  std::unique_ptr<Params> params_;
};

}  // namespace piperun::estimator
