#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "estimator/drift_filter.h"
#include "estimator/frame_locator.h"
#include "estimator/impact_gate.h"
#include "estimator/pipe_loss.h"
#include "estimator/roof_fit.h"

namespace piperun::estimator::locators::matched_filter {
namespace {

constexpr double kWindow_dB = 12;  // a window reaches as far as the flattest roof falls by this
constexpr double kBin_dB = 0.3;    // and a bin as far as the steepest one does
constexpr double kApart_dB = 6;    // width, on the flattest roof, in which only the highest place is a leak
constexpr double kRefineShare = 0.4;  // of the window: the top of the roof, where the leak drowns all else
constexpr double kNeighbourShare = 0.45;  // of the way to the next leak
constexpr double kBandShare = 0.5;        // of the ratio's roof that the band alone must show
constexpr double kMinZ = 3;               // below this a peak is not worth remembering
constexpr double kMaxReach_m = 200;
constexpr double kHampelLimit = 3.5, kHampelFloor_dB = 1.5;
constexpr double kPriorLeaks_per_km = 1;
constexpr double kFramesPerBin[] = {1, 3, 10};  // for which filters are made: fast, usual and slow balls
constexpr double kEdgeShare = 0.25;             // of the reach, whose mean stands for what was not heard

struct MatchedFilterParams : ParamsOf<MatchedFilterParams> {
  BandParams bands;
  double reference_weight = 1;
  std::optional<double> slope_dB_m;
  double false_alarms_per_km = 0.1;
  double min_height_dB = 1;
  LevelModel background;

  void Visit(ParamVisitor& v) override {
    bands.Visit(v);
    v.Number({"reference_weight",
              "How much of the reference band's level is taken off the band's: 1 cancels a "
              "background that drifts in both alike, 0 uses the band alone."},
             Range::Between(0, 1), reference_weight);
    v.NumberOr({"slope_dB_m",
                "How steeply a leak's level falls along the pipe; automatic: from the map's wall, "
                "or plastic's range of slopes without a map."},
               Range::Positive(), "automatic", slope_dB_m);
    v.Number({"false_alarms_per_km", "False alarms accepted per kilometre of quiet pipe."}, Range::Positive(),
             false_alarms_per_km);
    v.Number({"min_height_dB", "A leak must stand out of its background by this much."}, Range::NonNegative(),
             min_height_dB);
    v.Number(
        {"common_drift_dB", "How far the background's level drifts along the way in all bands alike, rms."},
        Range::NonNegative(), background.common_drift_dB);
    v.Number({"own_drift_dB", "How far each band drifts for itself, rms."}, Range::Positive(),
             background.own_drift_dB);
    v.Number({"drift_length_m", "Distance over which the drift forgets itself."}, Range::Positive(),
             background.drift_length_m);
  }
};

/// Slopes to try. The level of a band falls less steeply than its middle frequency does, because the lower
/// end carries further, and the reference band falls too: hence fractions of the nominal slope.
std::vector<double> ChooseSlopes(const MatchedFilterParams& params, const EstimatorStart& start) {
  std::optional<double> nominal_dB_m = params.slope_dB_m;
  if (!nominal_dB_m && start.map) {
    const Pipe& pipe = start.map->network.pipe(start.map->route.pieces().front().pipe);
    nominal_dB_m =
        CalcAttenuation_dB_m(pipe, std::sqrt(params.bands.band_low_Hz * params.bands.band_high_Hz));
  }
  if (!nominal_dB_m || !(*nominal_dB_m > 0)) return {1, 2, 4, 8};
  return {0.35 * *nominal_dB_m, 0.6 * *nominal_dB_m, *nominal_dB_m};
}

struct Heard {
  TrackPoint ball;
  SoundLevels levels_dB{};
};

/// Where a roof fits best, to a fraction of a bin.
struct Place {
  double chainage_m = 0;
  double variance_m2 = std::numeric_limits<double>::infinity();
};

/// A place where some roof fits better than anywhere near.
struct Peak {
  std::int64_t bin = 0;
  double z = 0;
  std::size_t roof = 0;
};

/// Matched filter along the pipe: at every place the best of a small bank of roofs is fitted to the level of
/// the band over the reference band, together with a constant and a trend (which cancels a background that
/// drifts linearly). The statistic is the fit's significance z, whose noise is estimated from its own
/// residuals and their correlation. Local maxima of z above the threshold become leaks, if the band itself
/// rises there: the reference band carries further, so some way off a loud leak the ratio falls, and the
/// shoulder before that looks like a roof although the band is flat. Each leak is then fitted
/// again on the top of its roof, on a window that stops short of its neighbours: once to the ratio of the
/// bands and once to the band alone, which is steeper and less noisy where the leak drowns the background.
/// The fit with the smaller variance gives the place; its sigma is that and the track's own. confidence:
/// lambda / (lambda + f), where f is the density of false alarms of at least this z in quiet pipe and lambda,
/// one per km, the density of leaks expected: the probability that this is a leak.
class MatchedFilter final : public FrameLocator {
 public:
  MatchedFilter(const MatchedFilterParams& params, const EstimatorStart& start);

 private:
  void Consume(const LocatedFrame& frame) override;
  void Complete() override;
  void ScanUpTo(std::int64_t bin);
  /// Remembers the place kept back by apart_bins_ if nothing within that distance scored as high.
  void KeepMaximum(const Peak& scored);
  bool BandRises(const Peak& peak) const;
  bool IsLeak(const Peak& peak) const;
  Peak Score(std::int64_t bin);
  double FillLevels(std::int64_t bin);
  void HoldEdges(std::int64_t first, std::int64_t last);
  const DriftFilter& FilterFor(double frames_per_bin) const;
  void RememberNoise(std::int64_t bin, double z);
  double CalcNoiseScale();
  void ReportSettled(std::int64_t up_to_bin);
  Place Refine(const Peak& peak, const BinRange& bins) const;
  void ReportPeak(const Peak& peak, double reach_m);
  BinRange Window(std::int64_t bin, double reach_m) const;
  double FalseAlarms_per_km(double z) const { return trials_per_km_ * CalcNormalTail(z); }

  MatchedFilterParams params_;
  std::vector<double> slopes_dB_m_;
  double reach_m_;
  std::int64_t reach_bins_;
  std::int64_t apart_bins_;
  double trials_per_km_;
  std::vector<Roof> roofs_;
  std::vector<DriftFilter> filters_;
  Eigen::VectorXd levels_dB_;   // scratch: the window's
  std::vector<double> noise_;   // ring: |z| of one roof; -1: not yet
  std::vector<double> sorted_;  // scratch
  std::int64_t noise_count_ = 0;
  SoundProfile profile_;
  ImpactGate<Heard> gate_{kHampelLimit, kHampelFloor_dB};
  std::optional<std::int64_t> next_scan_;
  std::vector<Peak> scored_;  // ring: the last places, twice apart_bins_ and one
  std::size_t next_scored_ = 0;
  std::vector<Peak> peaks_;  // of the last stretch, not yet reported, in order of bin
  std::optional<std::int64_t> last_reported_;
};

double Reach_m(const std::vector<double>& slopes_dB_m) {
  return std::min(kWindow_dB / slopes_dB_m.front(), kMaxReach_m);
}

MatchedFilter::MatchedFilter(const MatchedFilterParams& params, const EstimatorStart& start)
    : FrameLocator(params.bands),
      params_(params),
      slopes_dB_m_(ChooseSlopes(params, start)),
      reach_m_(Reach_m(slopes_dB_m_)),
      profile_(kBin_dB / slopes_dB_m_.back(), 6 * reach_m_) {
  reach_bins_ = static_cast<std::int64_t>(reach_m_ / profile_.bin_m());
  apart_bins_ = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(kApart_dB / kWindow_dB * 0.5 * static_cast<double>(reach_bins_)));
  for (const double slope : slopes_dB_m_) {
    for (const double height_dB : {3.0, 20.0}) roofs_.emplace_back(slope, height_dB, 2 * reach_m_);
  }
  LevelModel model = params.background;
  const BandParams& bands = params.bands;
  model.band_scatter_dB = CalcFrameScatter_dB(bands.band_low_Hz, bands.band_high_Hz, bands.frame_s);
  model.reference_scatter_dB =
      CalcFrameScatter_dB(bands.reference_low_Hz, bands.reference_high_Hz, bands.frame_s);
  for (const double frames : kFramesPerBin)
    filters_.emplace_back(model, roofs_, profile_.bin_m(), reach_bins_, frames);
  levels_dB_.resize(2 * (2 * reach_bins_ + 1));
  noise_.assign(static_cast<std::size_t>(6 * reach_bins_), -1);
  sorted_.reserve(noise_.size());
  // places a decibel's fall apart are told apart by the steepest roof
  trials_per_km_ = 1000 * slopes_dB_m_.back() / 4.34 * static_cast<double>(roofs_.size());
  scored_.resize(2 * static_cast<std::size_t>(apart_bins_) + 1);
  peaks_.reserve(64);
}

void MatchedFilter::Consume(const LocatedFrame& frame) {
  const double band_dB = 10 * std::log10(frame.sound.power_Pa2);
  const double reference_dB = 10 * std::log10(frame.sound.reference_power_Pa2);
  const Heard heard{frame.ball, {band_dB - params_.reference_weight * reference_dB, band_dB, reference_dB}};
  const auto passed = gate_.Step(heard, heard.levels_dB[0]);
  if (!passed) return;
  profile_.Add(passed->ball, passed->levels_dB);
  ScanUpTo(profile_.last() - reach_bins_ - 1);
  ReportSettled(profile_.last() - 3 * reach_bins_ - 2 * apart_bins_);
}

void MatchedFilter::Complete() {
  if (profile_.empty()) return;
  ScanUpTo(profile_.last());
  for (std::int64_t i = 0; i < apart_bins_; ++i) KeepMaximum({});  // flush
  ReportSettled(profile_.last());
}

BinRange MatchedFilter::Window(std::int64_t bin, double reach_m) const {
  const auto reach = static_cast<std::int64_t>(reach_m / profile_.bin_m());
  return {&profile_, std::max(profile_.first(), bin - reach), std::min(profile_.last(), bin + reach)};
}

/// The window's levels, band first, then reference. What was not heard between two places is put on the line
/// between them; beyond what was heard stands the mean of the stretch there.
double MatchedFilter::FillLevels(std::int64_t bin) {
  const BinRange heard = Window(bin, reach_m_);
  const std::int64_t first = bin - reach_bins_, bins = 2 * reach_bins_ + 1;
  double frames = 0;
  std::int64_t before = -1;
  for (std::int64_t i = std::max(heard.first, first); i <= std::min(heard.last, first + bins - 1); ++i) {
    const ProfileBin& here = profile_.At(i);
    if (here.weight == 0) continue;
    frames += here.weight;
    const std::int64_t at = i - first;
    const std::int64_t gap = before < 0 ? 1 : at - before;
    for (const Eigen::Index base : {Eigen::Index{0}, static_cast<Eigen::Index>(bins)}) {
      const double level_dB =
          here.levels_dB[static_cast<std::size_t>(base == 0 ? Channel::kBand : Channel::kReference)];
      const double from_dB = before < 0 ? level_dB : levels_dB_[base + before];
      for (std::int64_t k = 1; k <= gap; ++k) {
        const double u = static_cast<double>(k) / static_cast<double>(gap);
        levels_dB_[base + at - gap + k] = from_dB + u * (level_dB - from_dB);
      }
    }
    before = at;
  }
  HoldEdges(heard.first - first, before);
  return frames / static_cast<double>(heard.last - heard.first + 1);
}

void MatchedFilter::HoldEdges(std::int64_t first, std::int64_t last) {
  const std::int64_t bins = 2 * reach_bins_ + 1;
  const auto stretch = std::min(last - first + 1,
                                static_cast<std::int64_t>(kEdgeShare * static_cast<double>(reach_bins_)) + 1);
  for (const std::int64_t base : {std::int64_t{0}, bins}) {
    if (first > 0)
      levels_dB_.segment(base, first).setConstant(levels_dB_.segment(base + first, stretch).mean());
    if (last < bins - 1)
      levels_dB_.segment(base + last + 1, bins - 1 - last)
          .setConstant(levels_dB_.segment(base + last + 1 - stretch, stretch).mean());
  }
}

const DriftFilter& MatchedFilter::FilterFor(double frames_per_bin) const {
  std::size_t i = 0;
  while (i + 1 < filters_.size() && frames_per_bin > std::sqrt(kFramesPerBin[i] * kFramesPerBin[i + 1])) ++i;
  return filters_[i];
}

Peak MatchedFilter::Score(std::int64_t bin) {
  const BinRange bins = Window(bin, reach_m_);
  Peak peak{bin, 0, 0};
  // a roof needs both its sides
  if (bin - bins.first < apart_bins_ || bins.last - bin < apart_bins_) return peak;
  if (profile_.At(bins.first).weight == 0 && profile_.At(bin).weight == 0) return peak;
  const DriftFilter& filter = FilterFor(FillLevels(bin));
  DriftFilter::Response best;
  for (std::size_t i = 0; i < roofs_.size(); ++i) {
    const DriftFilter::Response response = filter.Eval(i, levels_dB_);
    if (i == roofs_.size() / 2) RememberNoise(bin, response.z);
    if (response.z <= best.z) continue;
    best = response;
    peak.roof = i;
  }
  if (best.amplitude * roofs_[peak.roof].Level_dB(0) >= params_.min_height_dB) peak.z = best.z;
  return peak;
}

void MatchedFilter::RememberNoise(std::int64_t bin, double z) {
  const auto n = static_cast<std::int64_t>(noise_.size());
  noise_[static_cast<std::size_t>(((bin % n) + n) % n)] = std::abs(z);
  noise_count_ = std::min(noise_count_ + 1, n);
}

/// How much the statistic scatters along the stretch that is remembered: its median deviation over that of a
/// standard normal, at least 1.
double MatchedFilter::CalcNoiseScale() {
  if (noise_count_ < static_cast<std::int64_t>(noise_.size())) {
    sorted_.assign(noise_.begin(), noise_.end());
    std::erase(sorted_, -1.0);
  } else {
    sorted_.assign(noise_.begin(), noise_.end());
  }
  if (sorted_.empty()) return 1;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return std::max(1.0, 1.4826 * *middle);
}

void MatchedFilter::ScanUpTo(std::int64_t bin) {
  if (!next_scan_) next_scan_ = profile_.first();
  for (; *next_scan_ <= bin; ++*next_scan_) KeepMaximum(Score(*next_scan_));
}

void MatchedFilter::KeepMaximum(const Peak& scored) {
  const std::size_t n = scored_.size();
  scored_[next_scored_++ % n] = scored;
  if (next_scored_ < n) return;
  const Peak& middle = scored_[(next_scored_ - 1 - n / 2) % n];
  const auto lower = [&](const Peak& other) { return other.z < middle.z || &other == &middle; };
  if (middle.z < kMinZ || !std::all_of(scored_.begin(), scored_.end(), lower)) return;
  if (BandRises(middle)) peaks_.push_back(middle);
}

bool MatchedFilter::BandRises(const Peak& peak) const {
  BinRange bins = Window(peak.bin, reach_m_);
  const double x0_m = profile_.Centre_m(peak.bin);
  const double ratio = FitRoof(bins, x0_m, roofs_[peak.roof]).amplitude;
  bins.channel = Channel::kBand;
  return FitRoof(bins, x0_m, roofs_[peak.roof]).amplitude >= kBandShare * ratio;
}

bool MatchedFilter::IsLeak(const Peak& peak) const {
  return FalseAlarms_per_km(peak.z) <= params_.false_alarms_per_km;
}

void MatchedFilter::ReportSettled(std::int64_t up_to_bin) {
  while (!peaks_.empty() && peaks_.front().bin <= up_to_bin) {
    Peak peak = peaks_.front();
    peaks_.erase(peaks_.begin());
    peak.z /= CalcNoiseScale();
    if (!IsLeak(peak)) continue;
    const auto next = std::find_if(peaks_.begin(), peaks_.end(), [&](const Peak& p) { return IsLeak(p); });
    double reach_m = kRefineShare * reach_m_;
    const auto stop_short_of = [&](std::int64_t neighbour) {
      const auto distance = static_cast<double>(std::abs(neighbour - peak.bin));
      reach_m = std::min(reach_m, kNeighbourShare * distance * profile_.bin_m());
    };
    if (last_reported_) stop_short_of(*last_reported_);
    if (next != peaks_.end()) stop_short_of(next->bin);
    ReportPeak(peak, reach_m);
    last_reported_ = peak.bin;
  }
}

Place MatchedFilter::Refine(const Peak& peak, const BinRange& bins) const {
  const Roof& roof = roofs_[peak.roof];
  const double h_m = 0.25 * profile_.bin_m() * static_cast<double>(apart_bins_);
  const auto reduction = [&](double x_m) { return FitRoof(bins, x_m, roof).reduction_dB2; };
  Place place{profile_.Centre_m(peak.bin)};
  double curvature = 0;
  for (int iteration = 0; iteration < 3; ++iteration) {
    const double x_m = place.chainage_m;
    const double before = reduction(x_m - h_m), here = reduction(x_m), after = reduction(x_m + h_m);
    curvature = (2 * here - before - after) / (h_m * h_m);
    if (!(curvature > 0)) return place;
    place.chainage_m += std::clamp(0.5 * (after - before) / (curvature * h_m), -h_m, h_m);
  }
  const RoofFit fit = FitRoof(bins, place.chainage_m, roof);
  // the sum of squares grows by curvature / 2 dx^2 away from its minimum: variance = 2 sigma^2 / curvature
  place.variance_m2 = 2 * CalcQuality(bins, place.chainage_m, roof, fit).variance_dB2 / curvature;
  return place;
}

void MatchedFilter::ReportPeak(const Peak& peak, double reach_m) {
  BinRange bins = Window(peak.bin, reach_m);
  Place best = Refine(peak, bins);
  bins.channel = Channel::kBand;
  const Place by_band = Refine(peak, bins);
  if (by_band.variance_m2 < best.variance_m2) best = by_band;
  if (!std::isfinite(best.variance_m2)) return;
  const TrackPoint place = profile_.Interpolate(best.chainage_m);
  LeakEstimate leak;
  leak.t_cpa = place.time;
  leak.chainage_m = best.chainage_m;
  leak.sigma_m = std::sqrt(best.variance_m2 + place.chainage_sd_m * place.chainage_sd_m);
  leak.p_W = place.p_W;
  leak.confidence = kPriorLeaks_per_km / (kPriorLeaks_per_km + FalseAlarms_per_km(peak.z));
  Report(leak);
}

std::unique_ptr<LeakLocator> Make(const Params& params, const EstimatorStart& start) {
  return std::make_unique<MatchedFilter>(dynamic_cast<const MatchedFilterParams&>(params), start);
}

}  // namespace

LocatorKind Kind() {
  return {
      "matched_filter",
      "Fits the two-sided exponential of a leak's sound along the pipe to a ratio of bands; rejects impacts.",
      MakeParams<MatchedFilterParams>, Make};
}

}  // namespace piperun::estimator::locators::matched_filter
