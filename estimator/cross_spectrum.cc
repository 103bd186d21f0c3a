#include "estimator/cross_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "estimator/real_fft.h"

namespace piperun::estimator {
namespace {

constexpr std::size_t kHopsPerSegment = 4;

std::vector<float> TabulateHann(std::size_t size) {
  std::vector<float> window;
  for (std::size_t n = 0; n < size; ++n) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(size);
    window.push_back(static_cast<float>(0.5 - 0.5 * std::cos(phase)));
  }
  return window;
}

/// Correlation of Hann's window with itself, shifted by x of its length.
double CalcHannOverlap(double x) {
  const double phase = 2 * std::numbers::pi * x;
  return (1 - x) * (2 + std::cos(phase)) / 3 + std::sin(phase) / (2 * std::numbers::pi);
}

double CalcAverages(double segments) {
  double sum = 1;
  for (std::size_t j = 1; j < kHopsPerSegment; ++j) {
    const double overlap = CalcHannOverlap(static_cast<double>(j) / static_cast<double>(kHopsPerSegment));
    sum += 2 * std::max(0.0, 1 - static_cast<double>(j) / segments) * overlap * overlap;
  }
  return segments / sum;
}

float CalcMean(std::span<const float> x) {
  double sum = 0;
  for (const float value : x) sum += static_cast<double>(value);
  return static_cast<float>(sum / static_cast<double>(x.size()));
}

/// One record, cut into windowed segments and transformed.
class Segments {
 public:
  Segments(std::span<const float> record, std::size_t size)
      : record_(record), mean_(CalcMean(record)), window_(TabulateHann(size)), weighted_(size), fft_(size) {
    spectrum_.resize(fft_.bins());
  }
  std::span<const std::complex<float>> Transform(std::size_t begin) {
    for (std::size_t n = 0; n < window_.size(); ++n) weighted_[n] = window_[n] * (record_[begin + n] - mean_);
    fft_.Forward(weighted_, spectrum_);
    return spectrum_;
  }

 private:
  std::span<const float> record_;
  float mean_;
  std::vector<float> window_, weighted_;
  RealFft fft_;
  std::vector<std::complex<float>> spectrum_;
};

void Accumulate(std::span<const std::complex<float>> a, std::span<const std::complex<float>> b,
                CrossSpectra& sum) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::complex<double> x(a[k]), y(b[k]);
    sum.aa[k] += std::norm(x);
    sum.bb[k] += std::norm(y);
    sum.ab[k] += std::conj(x) * y;
  }
}

void Scale(double factor, CrossSpectra& spectra) {
  for (std::size_t k = 0; k < spectra.bins(); ++k) {
    spectra.aa[k] *= factor;
    spectra.bb[k] *= factor;
    spectra.ab[k] *= factor;
  }
}

/// Where the records begin when b is read `shift` samples ahead.
std::size_t BeginOfA(std::int64_t shift) {
  return static_cast<std::size_t>(std::max<std::int64_t>(0, -shift));
}
std::size_t BeginOfB(std::int64_t shift) {
  return static_cast<std::size_t>(std::max<std::int64_t>(0, shift));
}

}  // namespace

double CrossSpectra::Coherence(std::size_t k) const {
  const double power = aa[k] * bb[k];
  return power > 0 ? std::norm(ab[k]) / power : 0;
}

double CrossSpectra::UnbiasedCoherence(std::size_t k) const {
  return averages > 1 ? std::max(0.0, (averages * Coherence(k) - 1) / (averages - 1)) : 0;
}

std::int64_t CountSegments(std::size_t a_samples, std::size_t b_samples, std::size_t segment,
                           std::int64_t shift) {
  const std::size_t a = BeginOfA(shift), b = BeginOfB(shift);
  if (a >= a_samples || b >= b_samples) return 0;
  const std::size_t common = std::min(a_samples - a, b_samples - b);
  if (common < segment) return 0;
  return static_cast<std::int64_t>((common - segment) / (segment / kHopsPerSegment) + 1);
}

CrossSpectra CalcCrossSpectra(std::span<const float> a, std::span<const float> b, double rate_Hz,
                              std::size_t segment, std::int64_t shift) {
  Demand(segment >= 16 && segment % kHopsPerSegment == 0, "a segment is a multiple of four samples");
  const std::int64_t count = CountSegments(a.size(), b.size(), segment, shift);
  Demand(count > 0, "a segment fits the records");
  Segments of_a(a.subspan(BeginOfA(shift)), segment), of_b(b.subspan(BeginOfB(shift)), segment);
  CrossSpectra spectra;
  const std::size_t bins = segment / 2 + 1, hop = segment / kHopsPerSegment;
  spectra.aa.resize(bins);
  spectra.bb.resize(bins);
  spectra.ab.resize(bins);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::size_t begin = static_cast<std::size_t>(i) * hop;
    Accumulate(of_a.Transform(begin), of_b.Transform(begin), spectra);
  }
  const double segments = static_cast<double>(count);
  const double window_power = 3.0 / 8 * static_cast<double>(segment);  // sum of Hann's squares
  Scale(2 / (rate_Hz * window_power * segments), spectra);
  spectra.bin_width_Hz = rate_Hz / static_cast<double>(segment);
  spectra.duration_s = segments * static_cast<double>(hop) / rate_Hz;
  spectra.averages = CalcAverages(segments);
  return spectra;
}

}  // namespace piperun::estimator
