#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/contact_log.h"
#include "scenarios/scenario.h"
#include "scenarios/score.h"

namespace piperun::scenarios {

/// Thrown when the user asks to stop.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// Progress of a run: simulated seconds, and the fraction of the route travelled.
using ProgressFunction = std::function<void(double simulated_s, double fraction)>;

struct RunOptions {
  std::filesystem::path out;
  bool force = false;
  const std::atomic<bool>* stop = nullptr;  ///< set: Interrupted is thrown, nothing is left behind
  ProgressFunction progress;
};

/// What run.json says.
struct RunResult {
  std::string scenario;
  std::int64_t seed = 0;
  std::int64_t run = 0;
  std::string status;  ///< ok, time_limit, hydraulics_diverged, or what stopped the ball (Name in run.cc)
  double duration_s = 0;
  double wall_s = 0;
  double route_length_m = 0;  ///< of the pipes of the way taken
  std::vector<std::string> route_pipes;
  std::vector<std::string> planned_pipes;
  std::vector<std::string> notes;     ///< what was assumed where the input is silent
  std::vector<std::string> warnings;  ///< where the motion went beyond what its laws or its step are good for
  std::vector<TrueLeak> leaks;
  std::optional<ContactSummary> contacts;  ///< nothing: no pipes
  std::vector<EstimatorResult> estimators;
  std::map<std::string, std::string> file_hashes;  ///< SHA-256 by path in the folder
  std::string json;                                ///< run.json, to the byte
};

/// Runs a scenario into a run folder, which appears complete or not at all. A run that goes wrong is a
/// status, and its folder is kept. Throws InputError for what does not fit together, std::system_error when
/// the disk fails, Interrupted.
RunResult Run(const Scenario& scenario, const RunOptions& options);

struct ReplayOptions {
  std::filesystem::path run_folder;
  std::vector<std::string> estimators;  ///< names of the run's estimators, or kinds of filter; empty: all
  std::filesystem::path out;
  bool force = false;
  const std::atomic<bool>* stop = nullptr;
};

/// Feeds a run folder's record to estimators again and scores them where the folder holds the truth.
RunResult Replay(const ReplayOptions& options);

}  // namespace piperun::scenarios
