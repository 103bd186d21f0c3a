#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/pose.h"
#include "base/time.h"
#include "estimator/estimator.h"

namespace piperun::scenarios {

/// What a track is compared with, at one instant.
struct TrackTruth {
  Quaterniond q_WB;
  Vector3d p_W;
  double chainage_m;
};

/// Errors of a track against the truth, without any alignment. RMS and means are over the track's rows from
/// the moment the filter is valid.
struct TrackScore {
  double attitude_rmse_deg = 0;
  double chainage_rmse_m = 0;
  double chainage_final_error_m = 0;  ///< estimated minus true
  double position_rmse_m = 0;
  double position_final_error_m = 0;
  double final_error_percent = 0;  ///< position_final_error over the true chainage travelled
  double nees_mean = 0;            ///< attitude error squared over its covariance, per degree of freedom
  double nis_mean = 0;             ///< innovation squared over its covariance, per degree of freedom
};

/// Sums up a track row by row.
class TrackScorer {
 public:
  void Add(const estimator::NavState& nav, const TrackTruth& truth);
  std::optional<TrackScore> Score() const;  ///< nothing before the first row

 private:
  std::int64_t rows_ = 0;
  double attitude_ = 0, chainage_ = 0, position_ = 0;  // sums of squares
  double nees_ = 0, nis_ = 0;
  std::int64_t nees_rows_ = 0, nis_rows_ = 0;
  double last_chainage_error_m_ = 0, last_position_error_m_ = 0;
  double first_chainage_m_ = 0, last_chainage_m_ = 0;
};

/// A leak as it was.
struct TrueLeak {
  std::string id;
  std::string pipe;
  double s_m = 0;
  std::optional<double> chainage_m;  ///< nothing: not on the ball's way
  Vector3d p_W = Vector3d::Zero();
  double flow_m3_s = 0;
  std::optional<std::int64_t> t_cpa_ns;  ///< true time of the ball's passage; nothing when it never came
  std::optional<double> snr_dB;          ///< 1-4 kHz, at the passage; nothing without passage or hydrophone
};

struct ScoredLeak {
  estimator::LeakEstimate estimate;
  std::optional<std::string> match;
  std::optional<double> error_m;          ///< estimated minus true chainage
  std::optional<bool> covered{};          ///< the true chainage lies in the estimate's 95 % interval
  std::optional<double> flow_error_dB{};  ///< 20 lg (estimated / true flow), where both are
};

struct LeakScore {
  std::vector<ScoredLeak> leaks;
  std::vector<std::string> missed;
  int false_alarms = 0;              ///< estimates without a leak, away from the map's fittings
  int false_alarms_at_fittings = 0;  ///< those that say at which fitting they may lie: LeakEstimate::at
};

/// Matches estimates and leaks one to one by chainage: the closest pair first, then the next closest among
/// those left, up to the radius. Leaks that are not on the ball's way can be neither matched nor missed.
LeakScore ScoreLeaks(const std::vector<estimator::LeakEstimate>& estimates,
                     const std::vector<TrueLeak>& truth, double match_radius_m);

struct EstimatorResult {
  std::string name;
  std::optional<TrackScore> causal;
  std::optional<TrackScore> smoothed;
  LeakScore leaks;
};

}  // namespace piperun::scenarios
