#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/wall_feature.h"

namespace piperun::scenarios {

/// What people call a wall feature, for truth/features.csv and whoever labels data.
struct WallFeatureLabel {
  std::string id;  ///< of the entry, or "ID[k]" for the k-th (from 1) of several
  std::string kind;
  int pipe = -1;
  double s_m = 0;
};

/// The features of a scenario; both lists have the same order, and WallFoot::feature indexes them.
struct WallFeatureList {
  std::vector<sim::WallFeature> features;
  std::vector<WallFeatureLabel> labels;
};

/// Makes the features that a scenario lists, in its bores. "*" stands for every pipe open to the ball. Their
/// scatter is drawn from the stream "wall_features.ENTRY.PIPE" of seed and run. Throws InputError
/// ("wall_features[i]...") for ids used twice, unknown pipes and pipes shut to the ball, and what the kind
/// refuses.
WallFeatureList MakeWallFeatures(const Scenario& scenario, const sim::Bore& bore);

}  // namespace piperun::scenarios
