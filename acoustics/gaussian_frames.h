#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "acoustics/complex_normals.h"
#include "acoustics/inverse_fft.h"
#include "base/random.h"

namespace piperun::acoustics {

/// Spectra of frames of Gaussian noise that may change from frame to frame. Bins are independent complex
/// normal numbers z_k,
///   x[n] = sum over 0 < k < N/2 of sqrt(S(f_k) df) Re(z_k exp(2 pi i k n / N)),
/// so the expected power of x is the sum of S(f_k) df; InverseRealFft takes X_k = sqrt(S(f_k) df) z_k / 2.
class GaussianSpectrum {
 public:
  /// Of N/2 + 1 = `bins` bins. Words of the stream are taken from slot `first_slot` on, N/8 + 1 slots of
  /// sample `frame`.
  GaussianSpectrum(std::size_t bins, double bin_width_Hz, const RandomStream& random,
                   std::uint64_t first_slot = 0);

  /// With the one-sided spectrum `psd` (units^2/Hz) per bin; the first and the last bin are silent. Valid
  /// until the next call. Does not allocate.
  std::span<const std::complex<float>> Draw(std::int64_t frame, std::span<const float> psd);

 private:
  RandomStream random_;
  std::uint64_t first_slot_;
  float half_bin_width_Hz_;
  ComplexNormals normals_;
  std::vector<float> exponentials_;
  std::vector<std::complex<float>> spectrum_;
};

/// Adds up frames of N samples, frame m centred at sample m N/2, windowed with sin(pi (n + 1/2) / N), whose
/// squares add up to one at half a frame's overlap.
class OverlapAdd {
 public:
  /// `size`: N, a power of two from 32 on.
  explicit OverlapAdd(std::size_t size);

  std::size_t hop() const { return hop_.size(); }
  std::size_t bins() const { return hop_.size() + 1; }

  /// Takes the next frame's spectrum, `bins()` values, and returns the N/2 samples before its centre: the
  /// first half of this frame plus the second half of the one before. What frame 0 returns lies before sample
  /// 0. Does not allocate.
  std::span<const float> Advance(std::span<const std::complex<float>> spectrum);

 private:
  InverseRealFft fft_;
  std::vector<float> window_;
  std::vector<float> signal_;
  std::vector<float> tail_;
  std::vector<float> hop_;
};

/// Gaussian noise with a given spectrum that may change from frame to frame: the two of them.
class GaussianFrames {
 public:
  /// `size`: N, a power of two from 32 on.
  GaussianFrames(std::size_t size, double rate_Hz, const RandomStream& random);

  std::size_t hop() const { return frames_.hop(); }
  std::size_t bins() const { return frames_.bins(); }
  double bin_width_Hz() const { return bin_width_Hz_; }

  /// Draws frame `frame` with the one-sided spectrum `psd` and returns the samples before its centre, as the
  /// classes above do. Frames are drawn in order from 0 on. Does not allocate.
  std::span<const float> Advance(std::int64_t frame, std::span<const float> psd);
  /// Of the frame drawn last.
  std::span<const std::complex<float>> spectrum() const { return spectrum_; }

 private:
  double bin_width_Hz_;
  OverlapAdd frames_;
  GaussianSpectrum draw_;
  std::span<const std::complex<float>> spectrum_;
};

}  // namespace piperun::acoustics
