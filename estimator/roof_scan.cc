#include "estimator/roof_scan.h"

#include <algorithm>
#include <cmath>

namespace piperun::estimator {
namespace {

constexpr double kWindow_dB = 12;         // a window reaches as far as the flattest roof falls by this
constexpr double kBin_dB = 0.3;           // and a bin as far as the steepest one does
constexpr double kApartShare = 0.25;      // of the window, within which only the highest place is a leak
constexpr double kFreeShare = 0.4;        // of the window: a neighbour further off than this does not disturb
constexpr double kNeighbourShare = 0.45;  // of the way to the next leak
constexpr double kBandShare = 0.5;        // of the ratio's roof that the band alone must show
constexpr double kRoofError = 0.1;        // of a roof, that the bank's best does not describe
constexpr double kMinZ = 3;               // below this a peak is not worth remembering
constexpr double kMaxReach_m = 200;
constexpr double kLeastScale =
    0.75;  // of noise for the place: drift may be milder than modelled, scatter not
constexpr std::int64_t kHeardReaches = 2;   // around a leak, where it moves the statistic
constexpr std::int64_t kNoiseReaches = 10;  // before a place, from which the noise is told
constexpr double kHeights_dB[] = {3, 20};

double Reach_m(const std::vector<double>& slopes_dB_m) {
  return std::min(kWindow_dB / slopes_dB_m.front(), kMaxReach_m);
}

std::vector<Roof> MakeRoofs(const std::vector<double>& slopes_dB_m) {
  std::vector<Roof> roofs;
  for (const double slope : slopes_dB_m) {
    for (const double height_dB : kHeights_dB) roofs.emplace_back(slope, height_dB, 2 * Reach_m(slopes_dB_m));
  }
  return roofs;
}

PlacePosterior MakeNormal(double mean_m, double sigma_m) {
  const ChainageInterval interval = CalcNormalInterval(mean_m, sigma_m);
  return {mean_m, sigma_m, interval.low_m, interval.high_m};
}

}  // namespace

RoofScan::RoofScan(const ScanParams& params, const LevelModel& model, Sink sink)
    : params_(params),
      sink_(std::move(sink)),
      reach_m_(Reach_m(params.slopes_dB_m)),
      profile_(kBin_dB / params.slopes_dB_m.back(), 6 * reach_m_),
      reach_bins_(static_cast<std::int64_t>(reach_m_ / profile_.bin_m())),
      apart_bins_(std::max<std::int64_t>(
          1, static_cast<std::int64_t>(kApartShare * static_cast<double>(reach_bins_)))),
      bank_(model, MakeRoofs(params.slopes_dB_m), {reach_bins_, apart_bins_, profile_.bin_m()}),
      // places a decibel's fall apart are told apart by the steepest roof
      trials_per_km_(1000 * params.slopes_dB_m.back() / 4.34 * static_cast<double>(bank_.roofs().size())),
      noise_((kNoiseReaches + 6) * reach_bins_, reach_bins_),
      scored_(2 * static_cast<std::size_t>(apart_bins_) + 1) {
  peaks_.reserve(64);
  settled_.reserve(64);
  log_likelihood_.reserve(scored_.size());
}

void RoofScan::Add(const TrackPoint& ball, const SoundLevels& levels_dB) {
  profile_.Add(ball, levels_dB);
  ScanUpTo(profile_.last() - reach_bins_ - 1);
  ReportSettled(profile_.last() - 3 * reach_bins_ - 2 * apart_bins_);
}

void RoofScan::Complete() {
  if (profile_.empty()) return;
  ScanUpTo(profile_.last());
  for (std::int64_t i = 0; i < apart_bins_; ++i) KeepMaximum({});  // flush
  ReportSettled(profile_.last());
}

BinRange RoofScan::Window(std::int64_t bin, double reach_m, Channel channel) const {
  const auto reach = static_cast<std::int64_t>(reach_m / profile_.bin_m());
  return {&profile_, std::max(profile_.first(), bin - reach), std::min(profile_.last(), bin + reach),
          channel};
}

void RoofScan::ScanUpTo(std::int64_t bin) {
  if (!next_scan_) next_scan_ = profile_.first();
  next_scan_ = std::max(*next_scan_, profile_.first());
  for (; *next_scan_ <= bin; ++*next_scan_) KeepMaximum(Score(*next_scan_));
}

RoofScan::Peak RoofScan::Score(std::int64_t bin) {
  Peak peak{bin, 0, 0, 0};
  if (!bank_.Look(profile_, bin)) return peak;
  DriftFilter::Response best;
  for (std::size_t i = 0; i < bank_.roofs().size(); ++i) {
    const DriftFilter::Response response = bank_.Eval(i);
    if (i == bank_.roofs().size() / 2) noise_.Add(bin, response.z);
    if (response.z <= best.z) continue;
    best = response;
    peak.roof = i;
    peak.amplitude = response.amplitude;
  }
  if (best.amplitude * bank_.roofs()[peak.roof].Level_dB(0) >= params_.min_height_dB) peak.z = best.z;
  return peak;
}

void RoofScan::KeepMaximum(const Peak& scored) {
  const std::size_t n = scored_.size();
  scored_[next_scored_++ % n] = scored;
  if (next_scored_ < n) return;
  const Peak& middle = scored_[(next_scored_ - 1 - n / 2) % n];
  const auto lower = [&](const Peak& other) { return other.z < middle.z || &other == &middle; };
  if (middle.z < kMinZ || !std::all_of(scored_.begin(), scored_.end(), lower)) return;
  if (BandRises(middle)) peaks_.push_back(middle);
}

bool RoofScan::BandRises(const Peak& peak) const {
  const double x0_m = profile_.Centre_m(peak.bin);
  const auto rise = [&](Channel channel) {
    return FitRoof(Window(peak.bin, reach_m_, channel), x0_m, bank_.roofs()[peak.roof]).amplitude;
  };
  return rise(Channel::kBand) >= kBandShare * rise(Channel::kRatio);
}

/// From the stretch before, and before this leak could be heard; 1 near the beginning.
double RoofScan::CalcNoiseScale(const Peak& peak) {
  const std::int64_t last = peak.bin - 2 * reach_bins_;
  return noise_.Calc(last - kNoiseReaches * reach_bins_, last).value_or(1);
}

double RoofScan::CalcOwnZ(const Peak& peak) {
  if (!bank_.Look(profile_, peak.bin)) return 0;
  double z = peak.z, variance = 1;
  const auto take_off = [&](const Peak& other) {
    const std::int64_t offset = other.bin - peak.bin;
    if (other.z <= peak.z || std::abs(offset) > 2 * reach_bins_) return;
    z -= other.amplitude * bank_.CalcCrosstalk(peak.roof, other.roof, offset);
    const std::int64_t outside = std::max<std::int64_t>(0, std::abs(offset) - reach_bins_);
    const Roof& roof = bank_.roofs()[other.roof];
    const double seen = roof.Level_dB(static_cast<double>(outside) * profile_.bin_m()) / roof.Level_dB(0);
    const double unknown = kRoofError * seen * other.z;
    variance += unknown * unknown;
  };
  std::for_each(settled_.begin(), settled_.end(), take_off);
  std::for_each(peaks_.begin(), peaks_.end(), take_off);
  return z / std::sqrt(variance);
}

void RoofScan::ReportSettled(std::int64_t up_to_bin) {
  while (!peaks_.empty() && peaks_.front().bin <= up_to_bin) {
    Peak peak = peaks_.front();
    peaks_.erase(peaks_.begin());
    const Peak as_heard = peak;
    // a level model that promises more noise than there is stays as it is: false alarms are held to the
    // promise
    peak.z = CalcOwnZ(peak) / std::max(1.0, CalcNoiseScale(peak));
    std::erase_if(settled_, [&](const Peak& p) { return peak.bin - p.bin > 2 * reach_bins_; });
    settled_.push_back(as_heard);
    if (!IsLeak(peak)) continue;
    noise_.Forget(peak.bin - kHeardReaches * reach_bins_, peak.bin + kHeardReaches * reach_bins_);
    ReportPeak(peak, CalcFreeReach_m(peak));
    last_reported_ = peak.bin;
  }
}

double RoofScan::CalcFreeReach_m(const Peak& peak) const {
  double reach_m = kFreeShare * reach_m_;
  const auto stop_short_of = [&](std::int64_t neighbour) {
    const auto distance = static_cast<double>(std::abs(neighbour - peak.bin));
    reach_m = std::min(reach_m, kNeighbourShare * distance * profile_.bin_m());
  };
  if (last_reported_) stop_short_of(*last_reported_);
  const auto next = std::find_if(peaks_.begin(), peaks_.end(), [&](const Peak& p) { return IsLeak(p); });
  if (next != peaks_.end()) stop_short_of(next->bin);
  return reach_m;
}

std::optional<PlacePosterior> RoofScan::Localise(const Peak& peak) {
  const double scale = std::max(kLeastScale, CalcNoiseScale(peak));
  const std::int64_t half = std::max<std::int64_t>(1, apart_bins_ / 2);
  log_likelihood_.clear();
  const std::int64_t first = std::max(peak.bin - half, profile_.first() + apart_bins_);
  const std::int64_t last = std::min(peak.bin + half, profile_.last() - apart_bins_);
  for (std::int64_t i = first; i <= last; ++i) {
    if (!bank_.Look(profile_, i)) return std::nullopt;
    log_likelihood_.push_back(bank_.CalcLogLikelihood(scale));
  }
  if (log_likelihood_.size() < 3) return std::nullopt;
  // rounding into a bin, of the roof's top and of the frames around it: sd of a triangle a bin wide
  const double rounding_m = profile_.bin_m() / std::sqrt(24.0);
  const double track_sd_m = profile_.Interpolate(profile_.Centre_m(peak.bin)).chainage_sd_m;
  return CalcPlacePosterior(profile_.Centre_m(first), profile_.bin_m(), log_likelihood_,
                            std::hypot(track_sd_m, rounding_m));
}

/// Least squares for the place by Newton's method; the sum of squares grows by curvature / 2 dx^2 away from
/// its minimum: variance = 2 sigma^2 / curvature.
std::optional<PlacePosterior> RoofScan::FitTop(const Peak& peak, const BinRange& bins) const {
  const Roof& roof = bank_.roofs()[peak.roof];
  const double h_m = 0.25 * profile_.bin_m() * static_cast<double>(apart_bins_);
  const auto reduction = [&](double x_m) { return FitRoof(bins, x_m, roof).reduction_dB2; };
  double x_m = profile_.Centre_m(peak.bin), curvature = 0;
  for (int iteration = 0; iteration < 3; ++iteration) {
    const double before = reduction(x_m - h_m), here = reduction(x_m), after = reduction(x_m + h_m);
    curvature = (2 * here - before - after) / (h_m * h_m);
    if (!(curvature > 0)) return std::nullopt;
    x_m += std::clamp(0.5 * (after - before) / (curvature * h_m), -h_m, h_m);
  }
  const double variance_dB2 = CalcQuality(bins, x_m, roof, FitRoof(bins, x_m, roof)).variance_dB2;
  if (!std::isfinite(variance_dB2)) return std::nullopt;
  const double track_sd_m = profile_.Interpolate(x_m).chainage_sd_m;
  return MakeNormal(x_m, std::hypot(std::sqrt(2 * variance_dB2 / curvature), track_sd_m));
}

std::optional<PlacePosterior> RoofScan::LocaliseAmongNeighbours(const Peak& peak, double reach_m) const {
  const auto by_ratio = FitTop(peak, Window(peak.bin, reach_m, Channel::kRatio));
  const auto by_band = FitTop(peak, Window(peak.bin, reach_m, Channel::kBand));
  if (!by_ratio || !by_band) return by_ratio ? by_ratio : by_band;
  return by_band->sigma_m < by_ratio->sigma_m ? by_band : by_ratio;
}

void RoofScan::ReportPeak(const Peak& peak, double reach_m) {
  const bool alone = reach_m >= kFreeShare * reach_m_;
  const auto posterior = alone ? Localise(peak) : LocaliseAmongNeighbours(peak, reach_m);
  if (!posterior) return;
  ScannedLeak leak;
  leak.place = profile_.Interpolate(posterior->mean_m);
  leak.posterior = *posterior;
  leak.z = peak.z;
  leak.false_alarms_per_km = FalseAlarms_per_km(peak.z);
  leak.apart_m = profile_.bin_m() * static_cast<double>(apart_bins_);
  leak.level = MeasureLevel(peak, Window(peak.bin, reach_m, Channel::kPower), posterior->mean_m);
  sink_(leak);
}

/// The leak's own power at the hole is what the band has there beyond its background, the trough of the fit.
/// The level's standard deviation is taken from the fit's residuals on a bin of the top and one of the
/// trough.
std::optional<LeakLevel> RoofScan::MeasureLevel(const Peak& peak, BinRange bins, double chainage_m) const {
  const Roof& roof = bank_.roofs()[peak.roof];
  const RoofFit fit = FitRoof(bins, chainage_m, roof);
  const double height_dB = fit.amplitude * roof.Level_dB(0);
  if (!(height_dB > 0)) return std::nullopt;
  const double excess = std::pow(10, 0.1 * height_dB) - 1;
  const double variance_dB2 = CalcQuality(bins, chainage_m, roof, fit).variance_dB2;
  if (!std::isfinite(variance_dB2)) return std::nullopt;
  const double top_sigma_dB = std::sqrt(variance_dB2 / static_cast<double>(apart_bins_));
  return LeakLevel{std::pow(10, 0.1 * fit.trough_dB) * excess, top_sigma_dB * (excess + 1) / excess};
}

}  // namespace piperun::estimator
