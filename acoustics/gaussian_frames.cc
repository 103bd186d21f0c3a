#include "acoustics/gaussian_frames.h"

#include <cmath>
#include <numbers>

#include "base/function_clones.h"
#include "base/check.h"

namespace piperun::acoustics {
namespace {

std::vector<float> TabulateWindow(std::size_t size) {
  std::vector<float> window;
  for (std::size_t n = 0; n < size; ++n) {
    const double phase = (static_cast<double>(n) + 0.5) / static_cast<double>(size);
    window.push_back(static_cast<float>(std::sin(std::numbers::pi * phase)));
  }
  return window;
}

}  // namespace

GaussianSpectrum::GaussianSpectrum(std::size_t bins, double bin_width_Hz, const RandomStream& random,
                                   std::uint64_t first_slot)
    : random_(random),
      first_slot_(first_slot),
      half_bin_width_Hz_(static_cast<float>(0.5 * bin_width_Hz)),
      exponentials_(bins),
      spectrum_(bins) {}

/// X_k = sqrt(S df) z_k / 2 = sqrt(S df E / 2) e^(i phi).
PIPERUN_CLONE_FOR("avx2")
std::span<const std::complex<float>> GaussianSpectrum::Draw(std::int64_t frame, std::span<const float> psd) {
  Demand(psd.size() == spectrum_.size(), "one spectral value per bin");
  normals_.Draw(random_, static_cast<std::uint64_t>(frame), first_slot_, exponentials_, spectrum_);
  for (std::size_t k = 0; k < psd.size(); ++k)
    spectrum_[k] *= std::sqrt(half_bin_width_Hz_ * psd[k] * exponentials_[k]);
  spectrum_.front() = spectrum_.back() = 0;
  return spectrum_;
}

OverlapAdd::OverlapAdd(std::size_t size)
    : fft_(size), window_(TabulateWindow(size)), signal_(size), tail_(size / 2), hop_(size / 2) {}

PIPERUN_CLONE_FOR("avx2")
std::span<const float> OverlapAdd::Advance(std::span<const std::complex<float>> spectrum) {
  fft_.Transform(spectrum, signal_);
  const std::size_t half = hop_.size();
  for (std::size_t n = 0; n < half; ++n) {
    hop_[n] = tail_[n] + window_[n] * signal_[n];
    tail_[n] = window_[half + n] * signal_[half + n];
  }
  return hop_;
}

GaussianFrames::GaussianFrames(std::size_t size, double rate_Hz, const RandomStream& random)
    : bin_width_Hz_(rate_Hz / static_cast<double>(size)),
      frames_(size),
      draw_(frames_.bins(), bin_width_Hz_, random) {}

std::span<const float> GaussianFrames::Advance(std::int64_t frame, std::span<const float> psd) {
  spectrum_ = draw_.Draw(frame, psd);
  return frames_.Advance(spectrum_);
}

}  // namespace piperun::acoustics
