#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/time.h"
#include "scenarios/score.h"

namespace piperun::scenarios {

/// Asks a truth file by the robot's clock; see EstimatorBank.
std::function<std::optional<TrackTruth>(RobotTime)> OpenTruth(const std::filesystem::path& file,
                                                              const ClockModel& clock);

/// Reads truth/leaks.csv of a run folder.
std::vector<TrueLeak> LoadTrueLeaks(const std::filesystem::path& file);

/// The truth of a run folder, for comparing tracks: interpolates between the rows of truth/ball.csv. Asked in
/// increasing order of time.
class TruthLog {
 public:
  explicit TruthLog(const std::filesystem::path& file);
  ~TruthLog();
  std::optional<TrackTruth> At(TrueTime t);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace piperun::scenarios
