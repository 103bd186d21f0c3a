#include "acoustics/stem_frames.h"

#include <algorithm>

#include "base/function_clones.h"

namespace piperun::acoustics {
namespace {

/// Far from the slots of the mixture and of the knocks, and 2^20 apart from one name to another.
std::uint64_t FindFirstSlot(const std::string& name) {
  return (HashName(name) | (std::uint64_t{1} << 63)) & ~((std::uint64_t{1} << 20) - 1);
}

}  // namespace

StemFrames::StemFrames(std::size_t size, double bin_width_Hz, const RandomStream& random,
                       const std::vector<std::string>& names)
    : power_(size / 2 + 1), missing_(size / 2 + 1) {
  const std::size_t bins = power_.size();
  for (const std::string& name : names) {
    stems_.push_back({GaussianSpectrum(bins, bin_width_Hz, random, FindFirstSlot(name)),
                      OverlapAdd(size),
                      std::vector<float>(bins),
                      std::vector<std::complex<float>>(bins),
                      {}});
  }
}

PIPERUN_CLONE_FOR("avx2")
void StemFrames::Advance(std::int64_t frame, std::span<const std::complex<float>> mixture) {
  std::fill(power_.begin(), power_.end(), 0.F);
  std::copy(mixture.begin(), mixture.end(), missing_.begin());
  for (Stem& stem : stems_) {
    const auto drawn = stem.draw.Draw(frame, stem.psd);
    std::copy(drawn.begin(), drawn.end(), stem.spectrum.begin());
    for (std::size_t k = 0; k < power_.size(); ++k) {
      power_[k] += stem.psd[k];
      missing_[k] -= drawn[k];
    }
  }
  for (std::size_t k = 1; k < power_.size(); ++k) missing_[k] *= power_[k] > 0 ? 1 / power_[k] : 0;
  for (Stem& stem : stems_) {
    for (std::size_t k = 1; k < power_.size(); ++k) stem.spectrum[k] += stem.psd[k] * missing_[k];
    stem.hop = stem.frames.Advance(stem.spectrum);
  }
}

}  // namespace piperun::acoustics
