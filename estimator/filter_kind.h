#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "estimator/estimator.h"

namespace piperun::estimator {

/// Channels without which a filter can do nothing.
struct ChannelNeeds {
  bool imu = true;
  bool audio = false;
};

struct FilterKind {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Params> (*make_params)();
  std::unique_ptr<Estimator> (*make)(const Params& params, const EstimatorStart& start);
  ChannelNeeds (*needs)(const Params& params);
};

/// Generated from estimator/filters/*.cc.
const std::vector<FilterKind>& FilterKinds();

}  // namespace piperun::estimator
