#include "scenarios/estimator_bank.h"

#include <cmath>

#include "base/check.h"
#include "base/number.h"
#include "scenarios/csv_row.h"
#include "scenarios/dig_points.h"
#include "scenarios/output_file.h"

namespace piperun::scenarios {
namespace {

constexpr Duration kLongestSilence = std::chrono::hours(1);
constexpr std::string_view kTrackHeader =
    "#timestamp [ns],chainage [m],sigma [m],p_WB_x [m],p_WB_y [m],p_WB_z [m],q_WB_w [],q_WB_x [],q_WB_y [],"
    "q_WB_z [],v_WB_x [m s^-1],v_WB_y [m s^-1],v_WB_z [m s^-1],bg_x [rad s^-1],bg_y [rad s^-1],bg_z [rad "
    "s^-1]\n";
constexpr std::string_view kLeaksHeader = "chainage_m,sigma_m,x_m,y_m,z_m,t_cpa_ns,flow_m3_s,confidence,at\n";

/// Index of the first sample at or after t.
std::int64_t FirstSampleFrom(RobotTime t, Rate rate) {
  auto k = static_cast<std::int64_t>(std::floor(Seconds(t) * rate.Hz())) - 1;
  while (RobotTime(SampleOffset(k, rate)) < t) ++k;
  return k;
}

void WriteTrackRow(OutputFile& file, const estimator::NavState& nav) {
  CsvRow(file) << static_cast<std::int64_t>(nav.stamp.time_since_epoch().count()) << nav.chainage_m
               << nav.chainage_sd_m << nav.p_W << nav.q_WB << nav.v_W_m_s << nav.gyro_bias_rad_s << kEndOfRow;
}

/// TUM: seconds with nine decimals, position, quaternion with w last, separated by blanks.
void WriteTumRow(OutputFile& file, const estimator::NavState& nav) {
  const std::int64_t ns = nav.stamp.time_since_epoch().count();
  std::string digits = std::to_string(std::abs(ns));
  if (digits.size() < 10) digits.insert(0, 10 - digits.size(), '0');
  digits.insert(digits.size() - 9, ".");
  std::string& text = file.text();
  text += (ns < 0 ? "-" : "") + digits;
  for (const double value :
       {nav.p_W.x(), nav.p_W.y(), nav.p_W.z(), nav.q_WB.x(), nav.q_WB.y(), nav.q_WB.z(), nav.q_WB.w()}) {
    text += ' ';
    AppendNumber(text, value);
  }
  file.EndRow();
}

void WriteLeaks(const std::filesystem::path& path, const std::vector<estimator::LeakEstimate>& leaks) {
  OutputFile file(path);
  file.Append(kLeaksHeader);
  for (const estimator::LeakEstimate& leak : leaks) {
    CsvRow(file) << leak.chainage_m << leak.sigma_m << leak.p_W
                 << static_cast<std::int64_t>(leak.t_cpa.time_since_epoch().count()) << leak.flow_m3_s
                 << leak.confidence << leak.at.value_or("") << kEndOfRow;
  }
  file.Close();
}

}  // namespace

struct EstimatorBank::Member {
  Member(const EstimatorInput& input, const ToldEstimator& told, const std::filesystem::path& folder_of_all)
      : name(told.name),
        estimator(MakeEstimator(input, told)),
        folder(folder_of_all / told.name),
        track((std::filesystem::create_directories(folder), folder / "track.csv")),
        tum(folder / "trajectory.tum") {
    track.Append(kTrackHeader);
  }

  void Ingest(const Measurement& measurement) {
    try {
      estimator->Ingest(measurement);
    } catch (const InputError& e) {
      throw InputError(e.problem(), "estimators." + name + (e.key_path().empty() ? "" : "." + e.key_path()),
                       e.where());
    }
  }

  void SampleTrack(RobotTime t, const TruthAt& truth_at) {
    estimator::NavState nav = estimator->nav();
    if (!nav.valid) return;
    nav.stamp = t;
    WriteTrackRow(track, nav);
    WriteTumRow(tum, nav);
    if (const auto truth = truth_at(t)) score.Add(nav, *truth);
  }

  /// Writes and scores the track that Finish() returned.
  std::optional<TrackScore> RecordSmoothed(const estimator::SmoothedTrack& smoothed,
                                           const TruthAt& truth_at) const {
    OutputFile file(folder / "track_smoothed.csv");
    file.Append(kTrackHeader);
    TrackScorer scorer;
    for (const estimator::NavState& nav : smoothed.states) {
      WriteTrackRow(file, nav);
      if (const auto truth = truth_at(nav.stamp)) scorer.Add(nav, *truth);
    }
    file.Close();
    return scorer.Score();
  }

  std::string name;
  std::unique_ptr<estimator::Estimator> estimator;
  std::filesystem::path folder;
  OutputFile track;
  OutputFile tum;
  TrackScorer score;
};

EstimatorBank::EstimatorBank(const EstimatorInput& input, const std::filesystem::path& estimates_folder,
                             TruthAt truth)
    : track_rate_(input.track_rate_Hz), origin_(input.map.origin), truth_(std::move(truth)) {
  for (const ToldEstimator& told : input.estimators) {
    members_.push_back(std::make_unique<Member>(input, told, estimates_folder));
  }
}

EstimatorBank::~EstimatorBank() = default;

void EstimatorBank::SampleTracksBefore(RobotTime t) {
  if (!next_track_) return;
  for (;; ++*next_track_) {
    const RobotTime due = RobotTime(SampleOffset(*next_track_, track_rate_));
    if (due >= t) return;
    for (const auto& member : members_) member->SampleTrack(due, truth_);
  }
}

void EstimatorBank::Ingest(const Measurement& measurement) {
  if (IsReadOutLater(measurement)) {
    CompleteTracks();  // what a filter makes of it is not causal
  } else {
    FollowTime(Stamp(measurement));
  }
  for (const auto& member : members_) member->Ingest(measurement);
}

void EstimatorBank::FollowTime(RobotTime stamp) {
  if (next_track_ && stamp - last_stamp_ > kLongestSilence) {
    throw InputError("the record jumps ahead by " + FormatNumber(Seconds(stamp - last_stamp_)) +
                     " s; allowed: up to one hour without any measurement");
  }
  last_stamp_ = stamp;
  if (!next_track_) next_track_ = FirstSampleFrom(last_stamp_, track_rate_);
  SampleTracksBefore(last_stamp_);
}

void EstimatorBank::CompleteTracks() { SampleTracksBefore(last_stamp_ + Duration(1)); }

std::vector<EstimatorResult> EstimatorBank::Finish(const std::vector<TrueLeak>& leaks, double match_radius_m,
                                                   const std::function<TruthAt()>& reopened_truth) {
  CompleteTracks();
  std::vector<EstimatorResult> results;
  for (const auto& member : members_) {
    const auto smoothed = member->estimator->Finish();
    member->track.Close();
    member->tum.Close();
    WriteLeaks(member->folder / "leaks.csv", member->estimator->leaks());
    if (origin_.known())
      WriteTextFile(member->folder / "leaks.geojson", WriteDigPoints(origin_, member->estimator->leaks()));
    EstimatorResult result;
    result.name = member->name;
    result.causal = member->score.Score();
    if (smoothed) result.smoothed = member->RecordSmoothed(*smoothed, reopened_truth());
    result.leaks = ScoreLeaks(member->estimator->leaks(), leaks, match_radius_m);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace piperun::scenarios
