#include "estimator/drift_filter_bank.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace piperun::estimator {
namespace {

constexpr double kFramesPerBin[] = {1, 3, 10, 30, 100};  // fast balls and short bins to slow and long
constexpr std::int64_t kSteps = 6;  // of the window's half: how much of it has been heard

}  // namespace

DriftFilterBank::DriftFilterBank(const LevelModel& model, std::vector<Roof> roofs, const Geometry& geometry)
    : model_(model), roofs_(std::move(roofs)), geometry_(geometry) {
  filters_.resize(std::size(kFramesPerBin) * (kSteps + 1) * (kSteps + 1));
  levels_dB_.setZero(2 * (2 * geometry.half + 1));
  alone_dB_ = levels_dB_;
}

bool DriftFilterBank::Look(const SoundProfile& profile, std::int64_t bin) {
  const std::int64_t first = std::max(profile.first(), bin - geometry_.half);
  const std::int64_t last = std::min(profile.last(), bin + geometry_.half);
  if (bin - first < geometry_.least || last - bin < geometry_.least) return false;
  const double frames_per_bin = FillLevels(profile, first, last, bin - geometry_.half);
  if (frames_per_bin == 0) return false;
  current_ = &FilterFor(frames_per_bin, bin - first, last - bin);
  return true;
}

/// Returns the mean number of frames per bin; 0 when nothing was heard.
double DriftFilterBank::FillLevels(const SoundProfile& profile, std::int64_t first, std::int64_t last,
                                   std::int64_t base) {
  double frames = 0;
  std::int64_t before = -1;
  for (std::int64_t i = first; i <= last; ++i) {
    const ProfileBin& here = profile.At(i);
    if (here.weight == 0) continue;
    frames += here.weight;
    FillTo(here, before < 0 ? i - base : before, i - base);
    before = i - base;
  }
  return frames / static_cast<double>(last - first + 1);
}

/// Puts a bin's levels at index `to` of the window, and a line between them and those at `from` <= to.
void DriftFilterBank::FillTo(const ProfileBin& bin, std::int64_t from, std::int64_t to) {
  std::int64_t base = 0;
  for (const Channel channel : {Channel::kBand, Channel::kReference}) {
    const double level_dB = bin.levels_dB[static_cast<std::size_t>(channel)];
    levels_dB_[base + to] = level_dB;
    const double step_dB =
        from < to ? (level_dB - levels_dB_[base + from]) / static_cast<double>(to - from) : 0;
    for (std::int64_t k = from + 1; k < to; ++k) levels_dB_[base + k] = levels_dB_[base + k - 1] + step_dB;
    base += 2 * geometry_.half + 1;
  }
}

const DriftFilter& DriftFilterBank::FilterFor(double frames_per_bin, std::int64_t behind,
                                              std::int64_t ahead) {
  std::size_t speed = 0;
  while (speed + 1 < std::size(kFramesPerBin) &&
         frames_per_bin > std::sqrt(kFramesPerBin[speed] * kFramesPerBin[speed + 1]))
    ++speed;
  const auto steps = [this](std::int64_t bins) { return std::min(kSteps, bins * kSteps / geometry_.half); };
  const auto at = static_cast<std::size_t>(
      (static_cast<std::int64_t>(speed) * (kSteps + 1) + steps(behind)) * (kSteps + 1) + steps(ahead));
  if (!filters_[at]) {
    const auto heard = [&](std::int64_t bins) {
      return std::max(geometry_.least, steps(bins) * geometry_.half / kSteps);
    };
    filters_[at].emplace(model_, roofs_,
                         DriftFilter::Window{geometry_.half, heard(behind), heard(ahead), geometry_.bin_m,
                                             kFramesPerBin[speed]});
  }
  return *filters_[at];
}

double DriftFilterBank::CalcCrosstalk(std::size_t roof, std::size_t other, std::int64_t offset) {
  for (std::int64_t i = 0; i <= 2 * geometry_.half; ++i) {
    const auto bins = static_cast<double>(i - geometry_.half - offset);
    alone_dB_[i] = roofs_[other].Level_dB(bins * geometry_.bin_m);
  }
  return current_->Eval(roof, alone_dB_).z;
}

double DriftFilterBank::CalcLogLikelihood(double noise_scale) const {
  double top = 0, sum = 0;  // sum of exp(l - top)
  for (std::size_t i = 0; i < roofs_.size(); ++i) {
    const double z = std::max(0.0, Eval(i).z) / noise_scale;
    const double l = 0.5 * z * z;
    if (l > top) sum *= std::exp(top - l);
    top = std::max(top, l);
    sum += std::exp(l - top);
  }
  return top + std::log(sum / static_cast<double>(roofs_.size()));
}

}  // namespace piperun::estimator
