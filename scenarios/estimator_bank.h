#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/time.h"
#include "estimator/estimator.h"
#include "scenarios/estimator_input.h"
#include "scenarios/score.h"

namespace piperun::scenarios {

/// Asks for the true state at an instant of the robot's clock, in increasing order; nothing when it is not
/// known.
using TruthAt = std::function<std::optional<TrackTruth>(RobotTime)>;

/// All estimators of a run: feeds them, samples their tracks at the track rate, writes estimates/NAME,
/// scores. Live and replay go through this same class.
class EstimatorBank {
 public:
  EstimatorBank(const EstimatorInput& input, const std::filesystem::path& estimates_folder, TruthAt truth);
  ~EstimatorBank();

  void Ingest(const Measurement& measurement);
  /// Last track rows, smoothing, leaks.csv. Returns one result per estimator. `reopened_truth` makes a
  /// TruthAt that begins again at the start, for tracks that are only known at the end.
  std::vector<EstimatorResult> Finish(const std::vector<TrueLeak>& leaks, double match_radius_m,
                                      const std::function<TruthAt()>& reopened_truth);

 private:
  struct Member;
  void FollowTime(RobotTime stamp);
  void SampleTracksBefore(RobotTime t);
  void CompleteTracks();

  Rate track_rate_;
  GeoOrigin origin_;
  std::optional<std::int64_t> next_track_;  ///< the grid begins with the first measurement
  TruthAt truth_;
  RobotTime last_stamp_{};
  std::vector<std::unique_ptr<Member>> members_;
};

}  // namespace piperun::scenarios
