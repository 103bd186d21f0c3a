#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "acoustics/hydrophone.h"
#include "base/leak.h"
#include "base/route.h"
#include "base/water.h"
#include "scenarios/channel.h"
#include "scenarios/pipeline.h"
#include "scenarios/scenario.h"
#include "scenarios/wall_feature_list.h"
#include "sim/motion.h"
#include "sim/pipe_magnetism.h"

namespace piperun::scenarios {

/// A scenario made ready to run. Parts refer to each other, so it stays where it was built.
struct Assembly {
  WaterProperties water;
  std::optional<Pipeline> pipeline;
  std::optional<Route> plan;                    ///< the way the crew expects
  std::optional<sim::Bore> bore;                ///< what is open to the ball
  std::vector<WallFeatureLabel> wall_features;  ///< of the bore; a contact's `feature` indexes them
  std::vector<sim::StickJoint> stick_joints;    ///< those among the wall features
  acoustics::AcousticScene scene;
  ClockModel clock;
  std::unique_ptr<sim::Motion> motion;
  std::vector<std::string> channel_names;  ///< sorted; Measurement::channel indexes it
  std::vector<std::unique_ptr<Channel>> channels;
  const SensorChannel* imu = nullptr;  ///< the first inertial channel, if any

  const Network* network() const { return pipeline ? &pipeline->network : nullptr; }
};

/// Builds everything a scenario describes. Throws InputError with key path, and with file and line where the
/// scenario's sources know them, for whatever does not fit together.
std::unique_ptr<Assembly> Assemble(const Scenario& scenario);

}  // namespace piperun::scenarios
