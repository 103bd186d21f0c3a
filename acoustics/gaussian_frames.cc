#include "acoustics/gaussian_frames.h"

#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

using std::numbers::pi;

constexpr std::uint64_t kPhasors = 4096;

std::vector<std::complex<float>> TabulatePhasors() {
  std::vector<std::complex<float>> phasors;
  for (std::uint64_t i = 0; i < kPhasors; ++i) {
    const double angle = 2 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(kPhasors);
    phasors.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
  }
  return phasors;
}

std::vector<float> TabulateWindow(std::size_t size) {
  std::vector<float> window;
  for (std::size_t n = 0; n < size; ++n) {
    window.push_back(
        static_cast<float>(std::sin(pi * (static_cast<double>(n) + 0.5) / static_cast<double>(size))));
  }
  return window;
}

/// Exponential with mean 1 from the upper 52 bits of a word: half the squared modulus of a complex normal.
double Exponential(std::uint64_t word) {
  return -std::log((static_cast<double>(word >> 12) + 0.5) * 0x1p-52);
}

}  // namespace

GaussianFrames::GaussianFrames(std::size_t size, double rate_Hz, const RandomStream& random)
    : random_(random),
      bin_width_Hz_(rate_Hz / static_cast<double>(size)),
      fft_(size),
      phasors_(TabulatePhasors()),
      window_(TabulateWindow(size)),
      spectrum_(size / 2 + 1),
      signal_(size),
      tail_(size / 2),
      hop_(size / 2) {
  Demand(size >= 16 && (size & (size - 1)) == 0, "a frame is a power of two long");
}

std::span<const float> GaussianFrames::Advance(std::int64_t frame, std::span<const double> psd) {
  DrawSpectrum(frame, psd);
  fft_.Transform(spectrum_, signal_);
  const std::size_t half = hop_.size();
  for (std::size_t n = 0; n < half; ++n) {
    hop_[n] = tail_[n] + window_[n] * signal_[n];
    tail_[n] = window_[half + n] * signal_[half + n];
  }
  return hop_;
}

/// One 64-bit word per bin: the upper 52 bits give the modulus, the lower 12 the phase. 4096 equally spaced
/// phases have the moments of a uniform one up to order 4095.
void GaussianFrames::DrawSpectrum(std::int64_t frame, std::span<const double> psd) {
  Demand(psd.size() == bins(), "one spectral value per bin");
  const std::size_t nyquist = bins() - 1;
  const double half_width_Hz = 0.5 * bin_width_Hz_;
  std::array<std::uint64_t, 4> words{};
  for (std::size_t k = 0; k < nyquist; ++k) {
    if (k % 4 == 0) words = random_.Bits(static_cast<std::uint64_t>(frame), k / 4);
    const std::uint64_t word = words[k % 4];
    const double modulus = std::sqrt(half_width_Hz * psd[k] * Exponential(word));
    spectrum_[k] = static_cast<float>(modulus) * phasors_[word % kPhasors];
  }
  spectrum_[0] = spectrum_[nyquist] = 0;
}

}  // namespace piperun::acoustics
