#include "scenarios/score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace piperun::scenarios {
namespace {

double Rms(double sum_of_squares, std::int64_t n) {
  return std::sqrt(sum_of_squares / static_cast<double>(n));
}
double Mean(double sum, std::int64_t n) { return n > 0 ? sum / static_cast<double>(n) : std::nan(""); }

struct Pair {
  std::size_t estimate, leak;
  double distance_m;
};

std::vector<Pair> PairsByDistance(const std::vector<estimator::LeakEstimate>& estimates,
                                  const std::vector<TrueLeak>& truth, double radius_m) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    for (std::size_t j = 0; j < truth.size(); ++j) {
      if (!truth[j].chainage_m) continue;
      const double distance = std::abs(estimates[i].chainage_m - *truth[j].chainage_m);
      if (distance <= radius_m) pairs.push_back({i, j, distance});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_m < b.distance_m; });
  return pairs;
}

}  // namespace

void TrackScorer::Add(const estimator::NavState& nav, const TrackTruth& truth) {
  if (!nav.valid) return;
  if (rows_ == 0) first_chainage_m_ = truth.chainage_m;
  ++rows_;
  const Vector3d rotation_error = LogSO3(nav.q_WB * truth.q_WB.conjugate());
  const Vector3d position_error = nav.p_W - truth.p_W;
  last_chainage_error_m_ = nav.chainage_m - truth.chainage_m;
  last_position_error_m_ = position_error.norm();
  last_chainage_m_ = truth.chainage_m;
  attitude_ += rotation_error.squaredNorm();
  chainage_ += last_chainage_error_m_ * last_chainage_error_m_;
  position_ += position_error.squaredNorm();
  const Eigen::LLT<Matrix3d> covariance(nav.attitude_covariance_rad2);
  if (covariance.info() == Eigen::Success && nav.attitude_covariance_rad2.trace() > 0) {
    nees_ += rotation_error.dot(covariance.solve(rotation_error)) / 3;
    ++nees_rows_;
  }
  if (nav.nis && nav.nis_dof > 0) {
    nis_ += *nav.nis / nav.nis_dof;
    ++nis_rows_;
  }
}

std::optional<TrackScore> TrackScorer::Score() const {
  if (rows_ == 0) return std::nullopt;
  const double travelled_m = std::abs(last_chainage_m_ - first_chainage_m_);
  TrackScore score;
  score.attitude_rmse_deg = Rms(attitude_, rows_) * 180 / std::numbers::pi;
  score.chainage_rmse_m = Rms(chainage_, rows_);
  score.chainage_final_error_m = last_chainage_error_m_;
  score.position_rmse_m = Rms(position_, rows_);
  score.position_final_error_m = last_position_error_m_;
  score.final_error_percent = travelled_m > 0 ? 100 * last_position_error_m_ / travelled_m : std::nan("");
  score.nees_mean = Mean(nees_, nees_rows_);
  score.nis_mean = Mean(nis_, nis_rows_);
  return score;
}

LeakScore ScoreLeaks(const std::vector<estimator::LeakEstimate>& estimates,
                     const std::vector<TrueLeak>& truth, double match_radius_m) {
  LeakScore score;
  std::vector<bool> found(truth.size(), false);
  for (const auto& estimate : estimates) {
    score.leaks.push_back({estimate, std::nullopt, std::nullopt});
  }
  for (const Pair& pair : PairsByDistance(estimates, truth, match_radius_m)) {
    ScoredLeak& scored = score.leaks[pair.estimate];
    if (scored.match || found[pair.leak]) continue;
    found[pair.leak] = true;
    scored.match = truth[pair.leak].id;
    scored.error_m = scored.estimate.chainage_m - *truth[pair.leak].chainage_m;
    scored.covered = scored.estimate.interval.Holds(*truth[pair.leak].chainage_m);
    if (scored.estimate.flow_m3_s && truth[pair.leak].flow_m3_s > 0)
      scored.flow_error_dB = 20 * std::log10(*scored.estimate.flow_m3_s / truth[pair.leak].flow_m3_s);
  }
  for (std::size_t j = 0; j < truth.size(); ++j) {
    if (!found[j] && truth[j].chainage_m) score.missed.push_back(truth[j].id);
  }
  for (const ScoredLeak& scored : score.leaks) {
    if (!scored.match) ++(scored.estimate.at ? score.false_alarms_at_fittings : score.false_alarms);
  }
  return score;
}

}  // namespace piperun::scenarios
