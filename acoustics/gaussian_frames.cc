#include "acoustics/gaussian_frames.h"

#include <cmath>
#include <numbers>

#include "acoustics/vector_clones.h"
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

GaussianFrames::GaussianFrames(std::size_t size, double rate_Hz, const RandomStream& random)
    : random_(random),
      bin_width_Hz_(rate_Hz / static_cast<double>(size)),
      fft_(size),
      window_(TabulateWindow(size)),
      exponentials_(size / 2 + 1),
      spectrum_(size / 2 + 1),
      signal_(size),
      tail_(size / 2),
      hop_(size / 2) {
  }

PIPERUN_VECTOR_CLONES
std::span<const float> GaussianFrames::Advance(std::int64_t frame, std::span<const float> psd) {
  DrawSpectrum(frame, psd);
  fft_.Transform(spectrum_, signal_);
  const std::size_t half = hop_.size();
  for (std::size_t n = 0; n < half; ++n) {
    hop_[n] = tail_[n] + window_[n] * signal_[n];
    tail_[n] = window_[half + n] * signal_[half + n];
  }
  return hop_;
}

/// The transform adds up conjugate pairs: X_k = sqrt(S df) z_k / 2 = sqrt(S df E / 2) e^(i phi).
PIPERUN_VECTOR_CLONES
void GaussianFrames::DrawSpectrum(std::int64_t frame, std::span<const float> psd) {
  Demand(psd.size() == bins(), "one spectral value per bin");
  normals_.Draw(random_, static_cast<std::uint64_t>(frame), exponentials_, spectrum_);
  const auto half_width_Hz = static_cast<float>(0.5 * bin_width_Hz_);
  for (std::size_t k = 0; k < bins(); ++k)
    spectrum_[k] *= std::sqrt(half_width_Hz * psd[k] * exponentials_[k]);
  spectrum_.front() = spectrum_.back() = 0;
}

}  // namespace piperun::acoustics
