#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "acoustics/gaussian_frames.h"

namespace piperun::acoustics {

/// What each of several independent Gaussian sources contributes to a mixture that has been drawn already
/// (gaussian_frames.h). Per bin, with spectra S_i of sum S and X the mixture's, independent Y_i are drawn and
///   X_i = Y_i + (S_i / S) (X - sum_j Y_j),
/// which is a draw of the X_i under the condition that they add up to X (Matheron's rule: Journel &
/// Huijbregts, Mining Geostatistics, 1978, chapter VII). So nothing changes in a record whose stems are kept,
/// and each stem is what the source would be heard as alone. Words of the stream are keyed by a stem's name:
/// a new source changes the others' stems only through the mixture.
class StemFrames {
 public:
  /// Frames of `size` samples; a stem per name.
  StemFrames(std::size_t size, double bin_width_Hz, const RandomStream& random,
             const std::vector<std::string>& names);

  std::size_t stems() const { return stems_.size(); }
  /// The spectrum of a stem in the next frame, to be filled before Advance().
  std::span<float> psd(std::size_t stem) { return stems_[stem].psd; }
  /// `mixture`: what was drawn for the frame with the sum of the stems' spectra. Does not allocate.
  void Advance(std::int64_t frame, std::span<const std::complex<float>> mixture);
  /// The samples that frame completed.
  std::span<const float> hop(std::size_t stem) const { return stems_[stem].hop; }

 private:
  struct Stem {
    GaussianSpectrum draw;
    OverlapAdd frames;
    std::vector<float> psd;
    std::vector<std::complex<float>> spectrum;
    std::span<const float> hop;
  };

  std::vector<Stem> stems_;
  std::vector<float> power_;                  // sum of the stems' spectra
  std::vector<std::complex<float>> missing_;  // mixture less the sum of what was drawn
};

}  // namespace piperun::acoustics
