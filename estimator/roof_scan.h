#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "estimator/drift_filter_bank.h"
#include "estimator/nav_track.h"
#include "estimator/noise_scale.h"
#include "estimator/place_posterior.h"
#include "estimator/roof_fit.h"
#include "estimator/sound_profile.h"

namespace piperun::estimator {

/// The leak's own sound in the band at the hole.
struct LeakLevel {
  double pressure_Pa2 = 0;
  double sigma_dB = 0;
};

/// A leak as a scan reports it.
struct ScannedLeak {
  TrackPoint place;
  PlacePosterior posterior;
  double z = 0;  ///< significance as a standard normal deviate
  double false_alarms_per_km = 0;
  double apart_m = 0;  ///< two reports closer than this are one leak
  std::optional<LeakLevel> level;
};

struct ScanParams {
  std::vector<double> slopes_dB_m;  ///< to try, rising
  double false_alarms_per_km = 0.1;
  double min_height_dB = 1;
};

/// Matched filter along the pipe for walls that damp alike: at every place a small bank of roofs, all slopes
/// with two heights, is held against the levels of a band and of a reference band by generalised least
/// squares (DriftFilter). Templates adapt to the wall: the window reaches as far as the flattest roof falls
/// by 12 dB (metres in plastic, at most 200 m in iron), bins are as wide as the steepest falls by 0.3 dB. The
/// statistic is the largest z of the bank over its scatter in what came before. Local maxima whose false
/// alarms
///
///     f(z) = 1000 n s_max / 4.34 (1 - Phi(z))      per km: independent places times roofs times chance of
///     one
///
/// fall below the accepted rate are leaks, if the band itself rises there: the reference band carries
/// further, so some way off a loud leak the ratio falls, and the shoulder before that looks like a roof
/// although the band is flat. What stronger leaks near by make of a place is taken off its z first,
///
///     z' = (z - sum c_j A_j) / sqrt(1 + sum (e h_j z_j)^2)
///
/// c_j the response to the roof of leak j alone, A_j its amplitude, h_j the part of its height that it still
/// has where the window ends, e = 0.1 the part of a roof that the bank does not describe. The place's
/// posterior comes from z at all places of the peak. Where a neighbour's sound reaches into that window the
/// top of the roof alone is fitted, once to the ratio of the bands and once to the band, and the smaller
/// variance decides.
class RoofScan {
 public:
  using Sink = std::function<void(const ScannedLeak&)>;
  RoofScan(const ScanParams& params, const LevelModel& model, Sink sink);

  double reach_m() const { return reach_m_; }
  /// Levels heard at a place; reports what has been left behind far enough.
  void Add(const TrackPoint& ball, const SoundLevels& levels_dB);
  /// No more will come.
  void Complete();

 private:
  /// A place where some roof fits better than anywhere near.
  struct Peak {
    std::int64_t bin = 0;
    double z = 0;
    std::size_t roof = 0;
    double amplitude = 0;
  };

  void ScanUpTo(std::int64_t bin);
  Peak Score(std::int64_t bin);
  /// Remembers the place kept back by apart_bins_ if nothing within that distance scored as high.
  void KeepMaximum(const Peak& scored);
  bool BandRises(const Peak& peak) const;
  bool IsLeak(const Peak& peak) const { return FalseAlarms_per_km(peak.z) <= params_.false_alarms_per_km; }
  double FalseAlarms_per_km(double z) const { return trials_per_km_ * CalcNormalTail(z); }
  double CalcNoiseScale(const Peak& peak);
  double CalcOwnZ(const Peak& peak);
  void ReportSettled(std::int64_t up_to_bin);
  /// How far a fit may reach before it meets the neighbours that are leaks.
  double CalcFreeReach_m(const Peak& peak) const;
  void ReportPeak(const Peak& peak, double reach_m);
  std::optional<PlacePosterior> Localise(const Peak& peak);
  std::optional<PlacePosterior> FitTop(const Peak& peak, const BinRange& bins) const;
  std::optional<PlacePosterior> LocaliseAmongNeighbours(const Peak& peak, double reach_m) const;
  std::optional<LeakLevel> MeasureLevel(const Peak& peak, BinRange bins, double chainage_m) const;
  BinRange Window(std::int64_t bin, double reach_m, Channel channel) const;

  ScanParams params_;
  Sink sink_;
  double reach_m_;
  SoundProfile profile_;
  std::int64_t reach_bins_;
  std::int64_t apart_bins_;
  DriftFilterBank bank_;
  double trials_per_km_;
  NoiseScale noise_;
  std::optional<std::int64_t> next_scan_;
  std::vector<Peak> scored_;  // ring: the last places, twice apart_bins_ and one
  std::size_t next_scored_ = 0;
  std::vector<Peak> peaks_;    // of the last stretch, not yet reported, in order of bin
  std::vector<Peak> settled_;  // those before them that reach here
  std::optional<std::int64_t> last_reported_;
  std::vector<double> log_likelihood_;  // scratch
};

}  // namespace piperun::estimator
