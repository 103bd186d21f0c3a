#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace piperun::estimator {

/// Spectra of two records and their cross spectrum, averaged over segments. One-sided densities at
/// k * bin_width_Hz; S_ab = E[A* B], so that a record b that lags a by t has S_ab = |S_ab| exp(-i omega t).
struct CrossSpectra {
  double bin_width_Hz = 0;
  double duration_s = 0;  ///< of record that the averages stand on
  double averages = 0;    ///< as many independent segments would scatter alike
  std::vector<double> aa, bb;
  std::vector<std::complex<double>> ab;

  std::size_t bins() const { return ab.size(); }
  /// |S_ab|^2 / (S_aa S_bb), 0 to 1. Of records that share nothing its mean is 1 / averages.
  double Coherence(std::size_t k) const;
  /// The same without that bias, (n C - 1) / (n - 1), and zero where the bias is more than all.
  double UnbiasedCoherence(std::size_t k) const;
};

/// Welch's method (IEEE Trans. Audio Electroacoust. 15, 70 (1967)): segments of `segment` samples, Hann's
/// window, a new one every quarter of a segment, so that every sample within the record counts alike. Means
/// of both records are taken out. `shift`: sample n of a is held against sample n + shift of b. With K
/// segments and the window's correlation c_j at j quarters,
///   averages = K / (1 + 2 sum_j (1 - j / K) c_j^2),
/// 2.08 per segment's length. Records of one rate; at least one segment must fit both. Range: `segment` a
/// multiple of four from 16 on.
CrossSpectra CalcCrossSpectra(std::span<const float> a, std::span<const float> b, double rate_Hz,
                              std::size_t segment, std::int64_t shift = 0);

/// How many segments CalcCrossSpectra finds.
std::int64_t CountSegments(std::size_t a_samples, std::size_t b_samples, std::size_t segment,
                           std::int64_t shift = 0);

}  // namespace piperun::estimator
