#include "estimator/cross_correlation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include "base/check.h"
#include "base/number.h"
#include "estimator/real_fft.h"

namespace piperun::estimator {
namespace {

constexpr std::int64_t kLeastSegments = 8;
constexpr std::size_t kGridPerSample = 4;
constexpr double kTwoPi = 2 * std::numbers::pi;

/// Bins first .. last of the band.
struct Band {
  std::size_t first = 0, last = 0;
};

/// psi_k S_ab(f_k), zero outside the band, and psi_k^2 S_aa S_bb.
struct WeightedSpectrum {
  double bin_width_Hz = 0;
  Band band;
  std::vector<std::complex<double>> cross;
  std::vector<double> power;

  double Omega(std::size_t k) const { return kTwoPi * bin_width_Hz * static_cast<double>(k); }
};

void RequireRecord(std::span<const float> record, const char* key) {
  bool silent = true;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!std::isfinite(record[i]))
      throw InputError("sample " + std::to_string(i) + " is not a finite number", key);
    silent = silent && record[i] == record[0];
  }
  if (silent) throw InputError("is silent: all samples are equal", key);
}

void RequireLength(std::size_t a, std::size_t b, double rate_Hz, std::size_t segment) {
  const std::size_t least = segment * static_cast<std::size_t>(kLeastSegments);
  if (std::min(a, b) >= least) return;
  throw InputError("the records have " + FormatNumber(static_cast<double>(std::min(a, b)) / rate_Hz) +
                       " s in common; delays of this length need at least " +
                       FormatNumber(static_cast<double>(least) / rate_Hz) +
                       " s: record longer, or state a shorter distance",
                   a < b ? "a" : "b");
}

Band FindBand(const CorrelationOptions& options, double rate_Hz, double bin_width_Hz) {
  const double high_Hz = options.band_high_Hz > 0 ? options.band_high_Hz : 0.45 * rate_Hz;
  if (!(options.band_low_Hz >= 0 && high_Hz > options.band_low_Hz && high_Hz < 0.5 * rate_Hz)) {
    throw InputError("the band " + FormatNumber(options.band_low_Hz) + " to " + FormatNumber(high_Hz) +
                         " Hz is not one between 0 and " + FormatNumber(0.5 * rate_Hz) +
                         " Hz, half the sampling rate",
                     "band");
  }
  const double low_bin = std::max(2.0, std::ceil(options.band_low_Hz / bin_width_Hz));
  const double high_bin = std::floor(high_Hz / bin_width_Hz);
  if (high_bin - low_bin < 4) {
    throw InputError("the band " + FormatNumber(options.band_low_Hz) + " to " + FormatNumber(high_Hz) +
                         " Hz holds fewer than five bins of " + FormatNumber(bin_width_Hz) + " Hz: widen it",
                     "band");
  }
  return {static_cast<std::size_t>(low_bin), static_cast<std::size_t>(high_bin)};
}

double CalcWeight(CorrelationWeight weight, const CrossSpectra& spectra, std::size_t k) {
  const double magnitude = weight == CorrelationWeight::kPhat   ? std::abs(spectra.ab[k])
                           : weight == CorrelationWeight::kScot ? std::sqrt(spectra.aa[k] * spectra.bb[k])
                                                                : 1;
  return magnitude > 0 ? 1 / magnitude : 0;
}

WeightedSpectrum CalcWeighted(CorrelationWeight weight, const CrossSpectra& spectra, const Band& band) {
  WeightedSpectrum weighted{spectra.bin_width_Hz, band, {}, {}};
  weighted.cross.resize(spectra.bins());
  weighted.power.resize(spectra.bins());
  for (std::size_t k = band.first; k <= band.last; ++k) {
    const double psi = CalcWeight(weight, spectra, k);
    weighted.cross[k] = psi * spectra.ab[k];
    weighted.power[k] = psi * psi * spectra.aa[k] * spectra.bb[k];
  }
  return weighted;
}

/// R on a grid of 1 / (kGridPerSample rate) from -N/2 to N/2 samples, by a transform padded with zeros.
std::vector<float> CalcGrid(const WeightedSpectrum& weighted) {
  const std::size_t size = kGridPerSample * 2 * (weighted.cross.size() - 1);
  double greatest = 0;
  for (const auto& value : weighted.cross) greatest = std::max(greatest, std::abs(value));
  std::vector<std::complex<float>> spectrum(size / 2 + 1);
  if (greatest > 0) {
    for (std::size_t k = weighted.band.first; k <= weighted.band.last; ++k)
      spectrum[k] = std::complex<float>(weighted.cross[k] / greatest);
  }
  std::vector<float> grid(size);
  RealFft(size).Inverse(spectrum, grid);
  std::rotate(grid.begin(), grid.begin() + static_cast<std::ptrdiff_t>(size / 2), grid.end());
  return grid;
}

/// R, R' and R'' at a lag.
struct Derivatives {
  double value = 0, slope = 0, curvature = 0;
};

Derivatives CalcDerivatives(const WeightedSpectrum& weighted, double lag_s) {
  Derivatives sum;
  for (std::size_t k = weighted.band.first; k <= weighted.band.last; ++k) {
    const double omega = weighted.Omega(k);
    const std::complex<double> term = weighted.cross[k] * std::polar(1.0, omega * lag_s);
    sum.value += term.real();
    sum.slope -= omega * term.imag();
    sum.curvature -= omega * omega * term.real();
  }
  return sum;
}

/// The maximum next to a lag on the grid, where R is concave.
double RefinePeak(const WeightedSpectrum& weighted, double lag_s, double step_s) {
  double peak_s = lag_s;
  for (int i = 0; i < 20; ++i) {
    const Derivatives d = CalcDerivatives(weighted, peak_s);
    if (!(d.curvature < 0)) break;
    const double move_s = std::clamp(-d.slope / d.curvature, -step_s, step_s);
    peak_s += move_s;
    if (std::abs(move_s) < 1e-9 * step_s) break;
  }
  return peak_s;
}

/// The part of the grid where delays are sought, in lags of b behind a.
struct Search {
  std::vector<double> lag_s, value;
  std::size_t peak = 0;
};

Search SearchGrid(const std::vector<float>& grid, double step_s, double aligned_s, double max_delay_s) {
  Search search;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double lag_s = aligned_s + step_s * (static_cast<double>(i) - static_cast<double>(grid.size() / 2));
    if (std::abs(lag_s) > max_delay_s + 0.5 * step_s) continue;
    search.lag_s.push_back(lag_s);
    search.value.push_back(static_cast<double>(grid[i]));
  }
  search.peak = static_cast<std::size_t>(
      std::distance(search.value.begin(), std::max_element(search.value.begin(), search.value.end())));
  return search;
}

double FindSidePeak(const Search& search) {
  double side = 0;
  for (std::size_t i = 1; i + 1 < search.value.size(); ++i) {
    const bool maximum = search.value[i] >= search.value[i - 1] && search.value[i] > search.value[i + 1];
    if (maximum && i != search.peak) side = std::max(side, search.value[i]);
  }
  const double peak = search.value[search.peak];
  return peak > 0 ? side / peak : 0;
}

double CalcSigma_s(const WeightedSpectrum& weighted, CorrelationWeight weight, const CrossSpectra& spectra,
                   double lag_s) {
  double scatter = 0;
  for (std::size_t k = weighted.band.first; k <= weighted.band.last; ++k) {
    double power = weighted.power[k] * (1 - spectra.UnbiasedCoherence(k));
    if (weight == CorrelationWeight::kPhat) power = std::min(power, spectra.averages);
    scatter += weighted.Omega(k) * weighted.Omega(k) * power;
  }
  const double curvature = -CalcDerivatives(weighted, lag_s).curvature;
  if (!(curvature > 0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(scatter / (2 * spectra.duration_s * spectra.bin_width_Hz)) / curvature;
}

/// Probability that the correlation of records that share nothing gets as great at any lag within
/// +-max_delay_s: it begins above the level or crosses it, at Rice's rate.
double CalcFalseAlarm(double correlation, double low_Hz, double high_Hz, double duration_s,
                      double max_delay_s) {
  const double u = correlation * std::sqrt(2 * (high_Hz - low_Hz) * duration_s);
  const double cubes = high_Hz * high_Hz * high_Hz - low_Hz * low_Hz * low_Hz;
  const double rms_Hz = std::sqrt(cubes / (3 * (high_Hz - low_Hz)));
  const double crossings = 2 * max_delay_s * rms_Hz * std::exp(-0.5 * u * u);
  return -std::expm1(-0.5 * std::erfc(u / std::numbers::sqrt2) - crossings);
}

}  // namespace

std::size_t CalcSegment(double rate_Hz, double max_delay_s) {
  return std::bit_ceil(static_cast<std::size_t>(std::max(1024.0, std::ceil(8 * max_delay_s * rate_Hz))));
}

DelayEstimate EstimateDelay(std::span<const float> a, std::span<const float> b, double rate_Hz,
                            const CorrelationOptions& options) {
  RequireRecord(a, "a");
  RequireRecord(b, "b");
  const std::size_t segment = CalcSegment(rate_Hz, options.max_delay_s);
  RequireLength(a.size(), b.size(), rate_Hz, segment);
  const double step_s = 1 / (static_cast<double>(kGridPerSample) * rate_Hz);
  const Band band = FindBand(options, rate_Hz, rate_Hz / static_cast<double>(segment));
  const WeightedSpectrum rough = CalcWeighted(options.weight, CalcCrossSpectra(a, b, rate_Hz, segment), band);
  const Search first = SearchGrid(CalcGrid(rough), step_s, 0, options.max_delay_s);
  const std::int64_t shift = std::llround(first.lag_s[first.peak] * rate_Hz);

  DelayEstimate result;
  result.aligned_s = static_cast<double>(shift) / rate_Hz;
  result.spectra = CalcCrossSpectra(a, b, rate_Hz, segment, shift);
  const WeightedSpectrum weighted = CalcWeighted(options.weight, result.spectra, band);
  Search search = SearchGrid(CalcGrid(weighted), step_s, result.aligned_s, options.max_delay_s);
  const double peak_s = RefinePeak(weighted, search.lag_s[search.peak] - result.aligned_s, step_s);
  const WeightedSpectrum coherent = CalcWeighted(CorrelationWeight::kScot, result.spectra, band);
  result.correlation =
      CalcDerivatives(coherent, peak_s).value / static_cast<double>(band.last - band.first + 1);
  const double width_Hz = result.spectra.bin_width_Hz;
  result.band_low_Hz = static_cast<double>(band.first) * width_Hz;
  result.band_high_Hz = static_cast<double>(band.last) * width_Hz;
  result.false_alarm =
      CalcFalseAlarm(result.correlation, result.band_low_Hz - 0.5 * width_Hz,
                     result.band_high_Hz + 0.5 * width_Hz, result.spectra.duration_s, options.max_delay_s);
  result.correlated = result.false_alarm < options.false_alarm;
  result.delay_s = result.aligned_s + peak_s;
  result.sigma_s = CalcSigma_s(weighted, options.weight, result.spectra, peak_s);
  result.side_peak = FindSidePeak(search);
  const double peak = search.value[search.peak];
  for (double& value : search.value) value = peak > 0 ? value / peak : 0;
  result.lag_s = std::move(search.lag_s);
  result.curve = std::move(search.value);
  return result;
}

}  // namespace piperun::estimator
