#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "acoustics/phase_row.h"

namespace piperun::acoustics {

/// Power per bin of one source's sound along one stretch of pipe (bin_field.h). With forward and backward
/// waves A and B at its ends, L its length and x the place in it, the mean of |Z|^2 over a bin is
///
///   <|A|^2> exp(-2 alpha x) + <|B|^2> exp(-2 alpha (L - x)) + Re <C exp(-i Re k(f) (2 x - L))>,
///   C = 2 exp(-alpha L) A B*, alpha of the bin's middle.
///
/// The last mean is split: bin k's frequencies are (k + o_j) df, and with u = df (2 x - L) / c turns the
/// factors exp(-i 2 pi o_j u) are slow. Their sum is interpolated from multiples of 1/64 in u, within 0.03 %.
/// c is the speed at the last bin; where it is another one (phase_row.h), the o_j are stretched by the ratio
/// to the group velocity and the bin's own phase has an excess over k u.
class StretchField {
 public:
  static constexpr std::size_t kParts = 4;  ///< frequencies per bin

  /// Where the frequencies of a bin lie, in bins from its middle: one in each quarter and even about the
  /// middle, at places that differ from bin to bin (multiples of the golden ratio and of sqrt 2, less whole
  /// numbers), so that no echo falls in step with all of them.
  static double OffsetInBin(std::size_t bin, std::size_t part);
  StretchField(double length_m, const PhaseRow& phases, std::size_t bins);
  /// The waves at the four frequencies of a bin, with the spectrum that the power multiplies.
  void Set(std::size_t bin, const std::complex<double> (&forward)[kParts],
           const std::complex<double> (&backward)[kParts], double attenuation_Np_m, double weight);

  /// Adds the spectrum at x. `power_loss_1_m` is 2 alpha per bin and does not fall. Does not allocate.
  void Add(double x_m, std::span<const float> power_loss_1_m, std::span<float> psd);

 private:
  /// One of a bin's frequencies, over the bins: its offset and C.
  struct Part {
    std::vector<float> offset, re, im;
  };

  std::size_t bins() const { return forward_.size(); }
  void AddWave(const std::vector<float>& wave, float way_m, std::span<const float> power_loss_1_m, int bins);
  void AddStandingWave(double from_middle_m, int bins);
  void MoveSlowPhase(int step);
  void SumSlowPhase(float turns, std::vector<float>& re, std::vector<float>& im) const;

  double length_m_;
  double turns_1_m_;  // of u: 2 df / c
  std::vector<float> excess_turns_1_m_;
  std::vector<float> forward_, backward_;
  int forward_bins_ = 0, backward_bins_ = 0, cross_bins_ = 0;  // up to the last one that is not zero
  Part parts_[kParts];
  std::vector<float> re_0_, im_0_, re_1_, im_1_;  // sums at slow_step_ / 64 and the next
  std::vector<float> power_;                      // scratch
  int slow_step_;
};

}  // namespace piperun::acoustics
