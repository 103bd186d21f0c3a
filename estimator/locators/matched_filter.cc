#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

#include "estimator/drift_filter.h"
#include "estimator/frame_locator.h"
#include "estimator/impact_gate.h"
#include "estimator/leak_flow.h"
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
constexpr std::int64_t kSteps = 6;              // of the reach: how much of it has been heard on each side

struct MatchedFilterParams : ParamsOf<MatchedFilterParams> {
  BandParams bands;
  double reference_weight = 1;
  std::optional<double> slope_dB_m;
  double false_alarms_per_km = 0.1;
  double min_height_dB = 1;
  LevelModel background;
  JetModel jet;

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
    v.Number({"leak_pressure_Pa", "Pressure assumed at a leak, inside minus outside, for telling its flow."},
             Range::Positive(), jet.pressure_Pa);
    v.Number({"relative_fluctuation",
              "Rms fluctuation of a leak's flow over the flow, assumed for telling its flow; levels in the "
              "literature differ by 15 dB."},
             Range::Positive(), jet.relative_fluctuation);
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
  void FillTo(const ProfileBin& bin, std::int64_t from, std::int64_t to);
  const DriftFilter& FilterFor(double frames_per_bin, std::int64_t behind, std::int64_t ahead);
  void RememberNoise(std::int64_t bin, double z);
  double CalcNoiseScale(std::int64_t bin);
  void ReportSettled(std::int64_t up_to_bin);
  Place Refine(const Peak& peak, const BinRange& bins) const;
  Place RefineInDrift(const Peak& peak);
  double Significance(std::int64_t bin, std::size_t roof);
  void ReportPeak(const Peak& peak, double reach_m);
  void TellFlow(const Peak& peak, BinRange band, double chainage_m, LeakEstimate& leak) const;
  BinRange Window(std::int64_t bin, double reach_m) const;
  double FalseAlarms_per_km(double z) const { return trials_per_km_ * CalcNormalTail(z); }

  MatchedFilterParams params_;
  std::vector<double> slopes_dB_m_;
  double reach_m_;
  std::int64_t reach_bins_;
  std::int64_t apart_bins_;
  double trials_per_km_;
  std::optional<Pipe> pipe_;  // the first of the way; nothing without a map
  std::vector<Roof> roofs_;
  LevelModel model_;
  std::vector<std::optional<DriftFilter>> filters_;
  Eigen::VectorXd levels_dB_;   // scratch: the window's
  std::vector<double> noise_;   // ring: |z| of one roof
  std::vector<double> sorted_;  // scratch
  std::optional<std::int64_t> noise_first_;
  std::int64_t noise_last_ = 0;
  SoundProfile profile_;
  ImpactGate<Heard> band_gate_{kHampelLimit, kHampelFloor_dB}, reference_gate_{kHampelLimit, kHampelFloor_dB};
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
  if (start.map) pipe_ = start.map->network.pipe(start.map->route.pieces().front().pipe);
  model_ = params.background;
  const BandParams& bands = params.bands;
  model_.band_scatter_dB = CalcFrameScatter_dB(bands.band_low_Hz, bands.band_high_Hz, bands.frame_s);
  model_.reference_scatter_dB =
      CalcFrameScatter_dB(bands.reference_low_Hz, bands.reference_high_Hz, bands.frame_s);
  filters_.resize(std::size(kFramesPerBin) * (kSteps + 1) * (kSteps + 1));
  levels_dB_.setZero(2 * (2 * reach_bins_ + 1));
  noise_.assign(static_cast<std::size_t>(10 * reach_bins_), 0);
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
  const auto unstruck = band_gate_.Step(heard, band_dB);
  if (!unstruck) return;
  const auto passed = reference_gate_.Step(*unstruck, unstruck->levels_dB[2]);
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
/// between them. Returns the mean number of
/// frames per bin; 0 when nothing was heard.
double MatchedFilter::FillLevels(std::int64_t bin) {
  const BinRange heard = Window(bin, reach_m_);
  const std::int64_t first = bin - reach_bins_;
  double frames = 0;
  std::int64_t before = -1;
  for (std::int64_t i = heard.first; i <= heard.last; ++i) {
    const ProfileBin& here = profile_.At(i);
    if (here.weight == 0) continue;
    frames += here.weight;
    if (before < 0) before = i - first;
    FillTo(here, before, i - first);
    before = i - first;
  }
  if (before < 0) return 0;
  return frames / static_cast<double>(heard.last - heard.first + 1);
}

/// Puts a bin's levels at index `to` of the window, and a line between them and those at `from` <= to.
void MatchedFilter::FillTo(const ProfileBin& bin, std::int64_t from, std::int64_t to) {
  std::int64_t base = 0;
  for (const Channel channel : {Channel::kBand, Channel::kReference}) {
    const double level_dB = bin.levels_dB[static_cast<std::size_t>(channel)];
    levels_dB_[base + to] = level_dB;
    const double step_dB =
        from < to ? (level_dB - levels_dB_[base + from]) / static_cast<double>(to - from) : 0;
    for (std::int64_t k = from + 1; k < to; ++k) levels_dB_[base + k] = levels_dB_[base + k - 1] + step_dB;
    base += 2 * reach_bins_ + 1;
  }
}

/// The filter for so many frames per bin and so much of the reach heard on each side; made when it is first
/// needed, which for all but the ends of a record is at its beginning.
const DriftFilter& MatchedFilter::FilterFor(double frames_per_bin, std::int64_t behind, std::int64_t ahead) {
  std::size_t speed = 0;
  while (speed + 1 < std::size(kFramesPerBin) &&
         frames_per_bin > std::sqrt(kFramesPerBin[speed] * kFramesPerBin[speed + 1]))
    ++speed;
  const auto steps = [this](std::int64_t bins) { return std::min(kSteps, bins * kSteps / reach_bins_); };
  const auto at = static_cast<std::size_t>(
      (static_cast<std::int64_t>(speed) * (kSteps + 1) + steps(behind)) * (kSteps + 1) + steps(ahead));
  if (!filters_[at]) {
    filters_[at].emplace(
        model_, roofs_,
        DriftFilter::Window{reach_bins_, std::max(apart_bins_, steps(behind) * reach_bins_ / kSteps),
                            std::max(apart_bins_, steps(ahead) * reach_bins_ / kSteps), profile_.bin_m(),
                            kFramesPerBin[speed]});
  }
  return *filters_[at];
}

Peak MatchedFilter::Score(std::int64_t bin) {
  const BinRange bins = Window(bin, reach_m_);
  Peak peak{bin, 0, 0};
  // a roof needs both its sides
  if (bin - bins.first < apart_bins_ || bins.last - bin < apart_bins_) return peak;
  const double frames_per_bin = FillLevels(bin);
  if (frames_per_bin == 0) return peak;
  const DriftFilter& filter = FilterFor(frames_per_bin, bin - bins.first, bins.last - bin);
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
  if (!noise_first_) noise_first_ = bin;
  const auto n = static_cast<std::int64_t>(noise_.size());
  noise_[static_cast<std::size_t>(((bin % n) + n) % n)] = std::abs(z);
  noise_last_ = bin;
}

/// How much the statistic scatters where a leak at `bin` cannot be heard: two reaches and more before it.
/// Median deviation over that of a standard normal, at least 1; 1 while less than a reach of that is known.
double MatchedFilter::CalcNoiseScale(std::int64_t bin) {
  const auto n = static_cast<std::int64_t>(noise_.size());
  const std::int64_t first = std::max(noise_first_.value_or(0), noise_last_ - n + 1);
  sorted_.clear();
  for (std::int64_t i = first; i < bin - 2 * reach_bins_; ++i)
    sorted_.push_back(noise_[static_cast<std::size_t>(((i % n) + n) % n)]);
  if (static_cast<std::int64_t>(sorted_.size()) < reach_bins_) return 1;
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
    peak.z /= CalcNoiseScale(peak.bin);
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

double MatchedFilter::Significance(std::int64_t bin, std::size_t roof) {
  const BinRange bins = Window(bin, reach_m_);
  const double frames_per_bin = FillLevels(bin);
  if (frames_per_bin == 0 || bin < bins.first || bin > bins.last) return 0;
  return FilterFor(frames_per_bin, bin - bins.first, bins.last - bin).Eval(roof, levels_dB_).z;
}

/// The place by the drift filter: z^2/2 is the logarithm of the likelihood ratio, so its top is the place and
/// its curvature there the inverse of the variance (times the noise's scale). By the parabola through the
/// top and a quarter of apart_bins_ on both sides.
Place MatchedFilter::RefineInDrift(const Peak& peak) {
  const std::int64_t step = std::max<std::int64_t>(1, apart_bins_ / 4);
  double log_likelihood[3];
  for (int i = 0; i < 3; ++i) {
    const double z = Significance(peak.bin + (i - 1) * step, peak.roof);
    log_likelihood[i] = z > 0 ? 0.5 * z * z : 0;
  }
  Place place{profile_.Centre_m(peak.bin)};
  const double h_m = profile_.bin_m() * static_cast<double>(step);
  const double curvature = (2 * log_likelihood[1] - log_likelihood[0] - log_likelihood[2]) / (h_m * h_m);
  if (!(curvature > 0)) return place;
  place.chainage_m +=
      std::clamp(0.5 * (log_likelihood[2] - log_likelihood[0]) / (curvature * h_m), -h_m, h_m);
  place.variance_m2 = std::pow(CalcNoiseScale(peak.bin), 2) / curvature;
  return place;
}

void MatchedFilter::ReportPeak(const Peak& peak, double reach_m) {
  BinRange bins = Window(peak.bin, reach_m);
  Place best = Refine(peak, bins);
  bins.channel = Channel::kBand;
  const Place by_band = Refine(peak, bins);
  if (by_band.variance_m2 < best.variance_m2) best = by_band;
  if (reach_m >= kRefineShare * reach_m_) best = RefineInDrift(peak);  // no neighbour in its wide window
  if (!std::isfinite(best.variance_m2)) return;
  const TrackPoint place = profile_.Interpolate(best.chainage_m);
  LeakEstimate leak;
  leak.t_cpa = place.time;
  leak.chainage_m = best.chainage_m;
  leak.sigma_m = std::sqrt(best.variance_m2 + place.chainage_sd_m * place.chainage_sd_m);
  leak.p_W = place.p_W;
  leak.confidence = kPriorLeaks_per_km / (kPriorLeaks_per_km + FalseAlarms_per_km(peak.z));
  TellFlow(peak, bins, best.chainage_m, leak);
  Report(leak);
}

/// The leak's own power at the hole is what the band has there beyond its background, the trough of the fit.
/// The level's standard deviation is taken from the fit's residuals on a bin of the top and one of the
/// trough.
void MatchedFilter::TellFlow(const Peak& peak, BinRange band, double chainage_m, LeakEstimate& leak) const {
  if (!pipe_) return;
  const RoofFit fit = FitRoof(band, chainage_m, roofs_[peak.roof]);
  const double height_dB = fit.amplitude * roofs_[peak.roof].Level_dB(0);
  if (!(height_dB > 0)) return;
  const double background_Pa2 = std::pow(10, 0.1 * fit.trough_dB);
  const double excess = std::pow(10, 0.1 * height_dB) - 1;
  const double top_sigma_dB = std::sqrt(CalcQuality(band, chainage_m, roofs_[peak.roof], fit).variance_dB2 /
                                        static_cast<double>(apart_bins_));
  const auto flow = CalcLeakFlow(params_.jet, *pipe_, params_.bands.band_low_Hz, params_.bands.band_high_Hz,
                                 background_Pa2 * excess, top_sigma_dB * (excess + 1) / excess);
  if (!flow) return;
  leak.flow_m3_s = flow->flow_m3_s;
  leak.flow_sigma_dB = flow->sigma_dB;
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
