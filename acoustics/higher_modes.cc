#include "acoustics/higher_modes.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace piperun::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr double kFirstTransverseMode = 1.8412;        // k a at cut-on
constexpr double kTakeOver = 0.43;                     // of a mode's cut-on: how far near_field.h is good
constexpr double kFirstDistance = 0.1, kGrowth = 1.1;  // in radii
constexpr int kDistances = 90;
constexpr int kPartsOfBin = 8;
constexpr double kInaudible = 1e-9;  // of the plane wave

/// Distance of a row in radii.
double CalcDistance(int row) {
  static const std::vector<double> distances = [] {
    std::vector<double> all{0, kFirstDistance};
    while (all.size() <= kDistances) all.push_back(all.back() * kGrowth);
    return all;
  }();
  return distances[static_cast<std::size_t>(row)];
}

/// The row at or below a distance, with parts of rows. Range: below the last row's distance.
double FindRow(double radii) {
  if (radii <= kFirstDistance) return radii / kFirstDistance;
  const double row =
      std::min(kDistances - 1.0, 1 + std::floor(std::log(radii / kFirstDistance) / std::log(kGrowth)));
  const double begin = CalcDistance(static_cast<int>(row));
  return row + (radii - begin) / (begin * (kGrowth - 1));
}

double CalcKa(const PipeWave& wave, double f_Hz) { return kFirstTransverseMode * f_Hz / wave.cut_on_Hz; }

double CalcCutOn_Hz(const PipeWave& wave, const DuctMode& mode) {
  return wave.cut_on_Hz * mode.root / kFirstTransverseMode;
}

/// The first bin in which a mode counts.
std::size_t FindFirstBin(const PipeWave& wave, const DuctMode& mode, double bin_width_Hz) {
  return static_cast<std::size_t>(kTakeOver * CalcCutOn_Hz(wave, mode) / bin_width_Hz) + 1;
}

double CalcTakeOver(double share_of_cut_on) {
  const double u = std::clamp((share_of_cut_on - kTakeOver) / (1 - kTakeOver), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

}  // namespace

ModeWave CalcModeWave(const PipeWave& wave, const DuctMode& mode, double f_Hz) {
  const double ka = CalcKa(wave, f_Hz), a_m = wave.bore_radius_m, ratio = mode.m / mode.root;
  const double loss = 2 * ka * wave.Attenuation_Np_m(f_Hz) * a_m / (1 - ratio * ratio);
  const Complex kz_a = std::sqrt(Complex(ka * ka - mode.root * mode.root, -loss));
  return {CalcTakeOver(ka / mode.root) * mode.at_source * ka * ka / std::norm(kz_a), -2 * kz_a.imag() / a_m};
}

double CalcHigherModes(const PipeWave& wave, double r_over_a, double z_m, double f_Hz) {
  if (wave.X > kLargestCompliance) return 0;
  double sum = 0;
  for (const DuctMode& mode : DuctModes()) {
    if (kTakeOver * mode.root >= CalcKa(wave, f_Hz)) break;
    const ModeWave mode_wave = CalcModeWave(wave, mode, f_Hz);
    sum += mode_wave.power * std::exp(-mode_wave.decay_1_m * std::abs(z_m)) * mode.CalcShape(r_over_a);
  }
  return sum;
}

HigherModeTable::HigherModeTable(const PipeWave& wave, double r_over_a, double bin_width_Hz, std::size_t bins)
    : radius_m_(wave.bore_radius_m),
      first_bin_(std::min(bins, FindFirstBin(wave, DuctModes().front(), bin_width_Hz))) {
  if (first_bin_ == bins || wave.X > kLargestCompliance) return;
  rows_.assign(kDistances + 1, std::vector<float>(bins - first_bin_, 0));  // the last one stays silent
  for (const DuctMode& mode : DuctModes()) {
    if (FindFirstBin(wave, mode, bin_width_Hz) >= bins) break;
    AddMode(wave, mode, mode.CalcShape(r_over_a), bin_width_Hz);
  }
}

/// At its cut-on a mode is a sharp resonance: there the mean over a bin is taken, elsewhere the bin's middle.
void HigherModeTable::AddMode(const PipeWave& wave, const DuctMode& mode, double shape, double bin_width_Hz) {
  const double cut_on_Hz = CalcCutOn_Hz(wave, mode);
  for (std::size_t k = FindFirstBin(wave, mode, bin_width_Hz); k < first_bin_ + rows_[0].size(); ++k) {
    const double f_Hz = static_cast<double>(k) * bin_width_Hz;
    const int parts = std::abs(f_Hz - cut_on_Hz) < 4 * bin_width_Hz ? kPartsOfBin : 1;
    for (int i = 0; i < parts; ++i)
      AddWave(CalcModeWave(wave, mode, f_Hz + ((i + 0.5) / parts - 0.5) * bin_width_Hz), shape / parts, k);
  }
}

void HigherModeTable::AddWave(const ModeWave& wave, double share, std::size_t bin) {
  for (int row = 0; row < kDistances; ++row) {
    const double n = share * wave.power * std::exp(-wave.decay_1_m * CalcDistance(row) * radius_m_);
    if (n < kInaudible) return;
    rows_[static_cast<std::size_t>(row)][bin - first_bin_] += static_cast<float>(n);
  }
}

void HigherModeTable::AddTo(std::span<float> psd, std::span<const float> at_hole, double z_m,
                            float share) const {
  const double radii = std::abs(z_m) / radius_m_;
  if (rows_.empty() || radii >= CalcDistance(kDistances)) return;
  const double place = FindRow(radii);
  const auto row = static_cast<std::size_t>(place);
  const auto far = static_cast<float>(place - static_cast<double>(row));
  const float* __restrict near_n = rows_[row].data(), * __restrict far_n = rows_[row + 1].data();
  const float* __restrict hole = at_hole.data() + first_bin_;
  float* __restrict sum = psd.data() + first_bin_;
  const std::size_t count = rows_[row].size();
  for (std::size_t k = 0; k < count; ++k)
    sum[k] += share * hole[k] * (near_n[k] + far * (far_n[k] - near_n[k]));
}

}  // namespace piperun::acoustics
