#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/run.h"

namespace piperun::scenarios {

struct RestOptions {
  double duration_s = 0;
  std::optional<double> rate_Hz;       ///< of the inertial sensors; nothing: their own
  std::vector<std::string> overrides;  ///< "key=value", on top of everything else
};

/// The sensors of a scenario at rest: a scenario of motion `scripted`, script `rest`, without anything that
/// is not about sensors (pipes, leaks, filters, hydrophones). `source` is a scenario by path or name, a
/// file that holds only `sensors:`, or a preset of sensors by name or file, at 25 degC. Its physics rate is
/// the highest sampling rate, where nothing hangs on it, or 1 kHz where an IMU's filters run at it. Throws
/// InputError.
Scenario LoadRestScenario(const std::string& source, const RestOptions& options);

struct RestChannel {
  std::string name;
  std::int64_t samples = 0;  ///< written
  std::int64_t lost = 0;
};

/// Records `duration_s` of a rest scenario into a run folder that holds mav0, scenario.yaml and run.json: the
/// rows that Run() writes, from the same channels, but with the truth of a body at rest instead of a motion
/// that is stepped and recorded. Channels are recorded one after the other.
std::vector<RestChannel> RecordRest(const Scenario& scenario, double duration_s, const RunOptions& options);

}  // namespace piperun::scenarios
