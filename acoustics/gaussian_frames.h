#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "acoustics/complex_normals.h"
#include "acoustics/inverse_fft.h"
#include "base/random.h"

namespace piperun::acoustics {

/// Gaussian noise with a given spectrum that may change from frame to frame. Frame m of N samples is centred
/// at sample m N/2. Its bins are independent complex normal numbers,
///   x[n] = sum over 0 < k < N/2 of sqrt(S(f_k) df) Re(z_k exp(2 pi i k n / N)),
/// so its expected power is the sum of S(f_k) df. Frames are windowed with sin(pi (n + 1/2) / N), whose
/// squares add up to one at half a frame's overlap, and added.
class GaussianFrames {
 public:
  /// `size`: N, a power of two from 32 on.
  GaussianFrames(std::size_t size, double rate_Hz, const RandomStream& random);

  std::size_t hop() const { return hop_.size(); }
  std::size_t bins() const { return spectrum_.size(); }
  double bin_width_Hz() const { return bin_width_Hz_; }

  /// Draws frame `frame` with the one-sided spectrum `psd` (units^2/Hz, `bins()` values) and returns the N/2
  /// samples before its centre: the first half of this frame plus the second half of the one drawn before.
  /// Frames are drawn in order from 0 on; what frame 0 returns lies before sample 0. Does not allocate.
  std::span<const float> Advance(std::int64_t frame, std::span<const float> psd);

 private:
  void DrawSpectrum(std::int64_t frame, std::span<const float> psd);

  RandomStream random_;
  double bin_width_Hz_;
  ComplexNormals normals_;
  InverseRealFft fft_;
  std::vector<float> window_;
  std::vector<float> exponentials_;
  std::vector<std::complex<float>> spectrum_;
  std::vector<float> signal_;
  std::vector<float> tail_;
  std::vector<float> hop_;
};

}  // namespace piperun::acoustics
