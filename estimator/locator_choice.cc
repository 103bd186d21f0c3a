#include "estimator/locator_choice.h"

#include <algorithm>

#include "base/check.h"
#include "estimator/fitting_flags.h"

namespace piperun::estimator {
namespace {

constexpr std::string_view kNone = "none";

const LocatorKind* FindKind(std::string_view name) {
  const auto& kinds = LocatorKinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == name; });
  return kind == kinds.end() ? nullptr : &*kind;
}

std::unique_ptr<Params> MakeParamsOf(std::string_view name) {
  if (name == kNone) return nullptr;
  const LocatorKind* kind = FindKind(name);
  Demand(kind != nullptr, "a locator's kind was checked when it was read");
  return kind->make_params();
}

std::vector<std::string_view> Names() {
  std::vector<std::string_view> names{kNone};
  for (const LocatorKind& kind : LocatorKinds()) names.push_back(kind.name);
  return names;
}

}  // namespace

LocatorChoice::LocatorChoice(const std::string& kind) : kind_(kind), params_(MakeParamsOf(kind)) {}

LocatorChoice::LocatorChoice(const LocatorChoice& other)
    : kind_(other.kind_), params_(other.params_ ? other.params_->Clone() : nullptr) {}

LocatorChoice& LocatorChoice::operator=(const LocatorChoice& other) {
  kind_ = other.kind_;
  params_ = other.params_ ? other.params_->Clone() : nullptr;
  return *this;
}

void LocatorChoice::Visit(ParamVisitor& v) {
  const std::string before = kind_;
  v.Choice({"kind", "Which locator; none: the filter only navigates."}, Names(), kind_);
  if (kind_ != before) params_ = MakeParamsOf(kind_);
  if (params_) params_->Visit(v);
}

std::unique_ptr<LeakLocator> LocatorChoice::Make(const EstimatorStart& start) const {
  if (!params_) return nullptr;
  auto locator = FindKind(kind_)->make(*params_, start);
  if (!start.map) return locator;
  auto fittings = PlaceFittings(start.map->network, start.map->route, start.map->fittings);
  if (fittings.empty()) return locator;
  return std::make_unique<FittingFlags>(std::move(locator), std::move(fittings));
}

}  // namespace piperun::estimator
