#include "estimator/ricker_map.h"

#include <algorithm>
#include <cmath>

#include "estimator/roof_fit.h"

namespace piperun::estimator {
namespace {

constexpr double kBinsPerScale = 4;  // of the finest
constexpr double kReach = 4;         // scales to which the wavelet is summed: psi(4) = -0.005
constexpr double kSide = 20;         // widest scales on each side that tell the scatter
constexpr double kLeastSide = 5;     // and that must have been heard in all
constexpr double kMedianEfficiency = 0.37;
constexpr double kExpectedScatter_dB = 0.3;  // of a bin's level
constexpr double kApart = 4;

std::int64_t ToBins(double length_m, double bin_m) {
  return std::max<std::int64_t>(1, std::llround(length_m / bin_m));
}

std::vector<double> MakeRicker(double a_m, double bin_m) {
  std::vector<double> psi;
  for (std::int64_t i = 0; i <= ToBins(kReach * a_m, bin_m); ++i) {
    const double u = static_cast<double>(i) * bin_m / a_m;
    psi.push_back((1 - u * u) * std::exp(-0.5 * u * u));
  }
  return psi;
}

double CalcEnergy(const std::vector<double>& psi) {
  double sum = psi[0] * psi[0];
  for (std::size_t i = 1; i < psi.size(); ++i) sum += 2 * psi[i] * psi[i];
  return sum;
}

}  // namespace

RickerMap::RickerMap(const Params& params, Sink sink)
    : params_(params),
      sink_(std::move(sink)),
      bin_m_(params.finest_m / kBinsPerScale),
      reach_bins_(ToBins(kReach * std::ldexp(params.finest_m, kScales - 1), bin_m_)),
      side_bins_(ToBins(kSide * std::ldexp(params.finest_m, kScales - 1), bin_m_)),
      profile_(bin_m_, bin_m_ * static_cast<double>(3 * (side_bins_ + reach_bins_))) {
  const std::int64_t ring = 2 * side_bins_ + 4 * reach_bins_;
  for (std::size_t i = 0; i < kScales; ++i) {
    const double a_m = std::ldexp(params.finest_m, static_cast<int>(i));
    const std::vector<double> psi = MakeRicker(a_m, bin_m_);
    scales_.push_back({a_m, psi, CalcEnergy(psi), NoiseScale(ring, ToBins(kLeastSide * a_m, bin_m_)),
                       std::vector<double>(static_cast<std::size_t>(ring))});
  }
}

std::size_t RickerMap::Slot(std::int64_t bin) const {
  const auto n = static_cast<std::int64_t>(scales_.front().response_dB.size());
  return static_cast<std::size_t>(((bin % n) + n) % n);
}

double RickerMap::CalcFalseAlarms_per_km(double z) const {
  double places_per_km = 0;
  for (const Scale& scale : scales_) places_per_km += 1000 / (2 * scale.a_m);
  return places_per_km * CalcNormalTail(z);
}

void RickerMap::Add(const TrackPoint& ball, const SoundLevels& levels_dB) {
  profile_.Add(ball, levels_dB);
  TransformUpTo(profile_.last() - reach_bins_ - 1);
  TestUpTo(profile_.last() - side_bins_ - reach_bins_ - 1);
}

void RickerMap::Complete() {
  if (profile_.empty()) return;
  TransformUpTo(profile_.last() - reach_bins_);
  TestUpTo(profile_.last() - reach_bins_);
  ReportBest();
}

/// The mean over the window is taken off the levels first: where bins were not heard psi's sum is not zero.
double RickerMap::Respond(const Scale& scale, std::int64_t bin) {
  const auto reach = static_cast<std::int64_t>(scale.psi.size()) - 1;
  double weighted = 0, psi_sum = 0, sum = 0, heard = 0;
  for (std::int64_t i = std::max(profile_.first(), bin - reach); i <= std::min(profile_.last(), bin + reach);
       ++i) {
    const ProfileBin& here = profile_.At(i);
    if (here.weight == 0) continue;
    const double psi = scale.psi[static_cast<std::size_t>(std::abs(i - bin))];
    weighted += psi * here.levels_dB[0];
    psi_sum += psi;
    sum += here.levels_dB[0];
    heard += 1;
  }
  return heard > static_cast<double>(reach) ? weighted - psi_sum * sum / heard : 0;
}

void RickerMap::TransformUpTo(std::int64_t bin) {
  if (!next_transform_) next_transform_ = transformed_from_ = profile_.first() + reach_bins_;
  for (; *next_transform_ <= bin; ++*next_transform_) {
    for (Scale& scale : scales_) {
      const double response_dB = Respond(scale, *next_transform_);
      scale.response_dB[Slot(*next_transform_)] = response_dB;
      scale.scatter.Add(*next_transform_, response_dB);
    }
  }
}

double RickerMap::CalcZ(Scale& scale, std::int64_t bin) {
  const double response_dB = scale.response_dB[Slot(bin)];
  if (!(response_dB > 0)) return 0;
  const std::int64_t first = std::max(transformed_from_, bin - side_bins_);
  const std::int64_t end = std::min(*next_transform_, bin + side_bins_ + 1);
  const auto scatter_dB = scale.scatter.Calc(first, end, kExpectedScatter_dB * std::sqrt(scale.energy));
  if (!scatter_dB || !(*scatter_dB > 0)) return 0;
  const double freedom =
      std::max(1.0, kMedianEfficiency * static_cast<double>(end - first) * bin_m_ / (2 * scale.a_m));
  const double t = response_dB / *scatter_dB;
  return std::sqrt(freedom * std::log1p(t * t / freedom));
}

RickerMap::Point RickerMap::Test(std::int64_t bin) {
  Point point{bin, 0, 0};
  for (std::size_t i = 0; i < kScales; ++i) {
    Scale& scale = scales_[i];
    if (scale.response_dB[Slot(bin)] / scale.energy < params_.min_height_dB) continue;
    const double z = CalcZ(scale, bin);
    if (z <= point.z) continue;
    point.z = z;
    point.scale = i;
  }
  return point;
}

void RickerMap::TestUpTo(std::int64_t bin) {
  if (!next_transform_) return;
  if (!next_test_) next_test_ = transformed_from_;
  for (; *next_test_ <= std::min(bin, *next_transform_ - 1); ++*next_test_) Follow(Test(*next_test_));
}

/// Keeps the highest of a run of places that are accepted; reports it when it lies behind.
void RickerMap::Follow(const Point& point) {
  if (best_ && static_cast<double>(point.bin - best_->bin) * bin_m_ > kApart * scales_[best_->scale].a_m)
    ReportBest();
  if (CalcFalseAlarms_per_km(point.z) > params_.false_alarms_per_km) return;
  if (!best_ || point.z > best_->z) best_ = point;
}

/// A dip has shoulders half as high as it is deep.
bool RickerMap::IsShoulder(const Point& peak) const {
  const Scale& scale = scales_[peak.scale];
  const double height_dB = scale.response_dB[Slot(peak.bin)];
  const std::int64_t near = ToBins(kApart * scale.a_m, bin_m_);
  for (std::int64_t i = std::max(transformed_from_, peak.bin - near);
       i <= std::min(*next_transform_ - 1, peak.bin + near); ++i) {
    if (scale.response_dB[Slot(i)] < -height_dB) return true;
  }
  return false;
}

void RickerMap::ReportBest() {
  if (!best_) return;
  const Point peak = *best_;
  best_.reset();
  if (IsShoulder(peak)) return;
  Scale& scale = scales_[peak.scale];
  const std::int64_t half = ToBins(scale.a_m, bin_m_);
  const std::int64_t first = std::max(transformed_from_, peak.bin - half);
  const std::int64_t last = std::min(*next_transform_ - 1, peak.bin + half);
  log_likelihood_.clear();
  for (std::int64_t i = first; i <= last; ++i) {
    const double z = CalcZ(scale, i);
    log_likelihood_.push_back(0.5 * z * z);
  }
  if (log_likelihood_.size() < 3) return;
  const double track_sd_m = profile_.Interpolate(profile_.Centre_m(peak.bin)).chainage_sd_m;
  RickerPeak report;
  report.posterior = CalcPlacePosterior(profile_.Centre_m(first), bin_m_, log_likelihood_, track_sd_m);
  report.place = profile_.Interpolate(report.posterior.mean_m);
  report.z = peak.z;
  report.height_dB = scale.response_dB[Slot(peak.bin)] / scale.energy;
  sink_(report);
}

}  // namespace piperun::estimator
