#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "estimator/cross_spectrum.h"

namespace piperun::estimator {

/// What each frequency of the cross spectrum counts: psi = 1, 1 / |S_ab| (phase transform) or
/// 1 / sqrt(S_aa S_bb) (smoothed coherence transform).
enum class CorrelationWeight { kNone, kPhat, kScot };

/// Their names in files and on the command line, in that order.
inline constexpr std::array<std::string_view, 3> kCorrelationWeightNames{"none", "phat", "scot"};

struct CorrelationOptions {
  CorrelationWeight weight = CorrelationWeight::kScot;
  double band_low_Hz = 10;    ///< at least two bins of a segment
  double band_high_Hz = 0;    ///< 0: 0.45 of the sampling rate
  double max_delay_s = 0.1;   ///< sought within +- this
  double false_alarm = 1e-3;  ///< how often records that share nothing may pass as correlated
};

/// The delay of record b behind record a, and what it stands on.
struct DelayEstimate {
  bool correlated = false;  ///< false: records that share nothing have such a peak, too; no delay then
  double delay_s = 0;
  double sigma_s = 0;      ///< standard error of the delay
  double correlation = 0;  ///< mean over the band of Re(S_ab exp(i omega t)) / sqrt(S_aa S_bb)
  double false_alarm = 1;  ///< probability of such a correlation where nothing is shared
  double side_peak = 0;    ///< greatest other maximum over the peak: near 1, it may be the true one
  double band_low_Hz = 0;  ///< of the bins that were used
  double band_high_Hz = 0;
  CrossSpectra spectra;       ///< of the records held against each other in step
  double aligned_s = 0;       ///< the whole samples by which they were shifted for that
  std::vector<double> lag_s;  ///< -max_delay_s to max_delay_s
  std::vector<double> curve;  ///< the correlation sought, its maximum 1
};

/// Generalised cross-correlation (Knapp & Carter, IEEE Trans. ASSP 24, 320 (1976)) over a band:
///   R(t) = Re sum_k psi_k S_ab(f_k) exp(i omega_k t),
/// the delay is where it is greatest; found on a grid of a quarter sample, then as a zero of R' by Newton's
/// iteration, which is exact for the band-limited R. Records are first shifted into step by whole samples, so
/// that the segments' coherence does not suffer from the delay. Standard error (ibid., eq. 38), one-sided
/// densities, T the duration:
///   sigma^2 = sum psi^2 omega^2 S_aa S_bb (1 - C) df / (2 T (sum psi omega^2 Re(S_ab e^(i omega t)) df)^2),
/// C the coherence without its bias; of flat spectra it is 3 / (8 pi^2 T) (1 - C) / (C (f_2^3 - f_1^3)), the
/// bound of Cramer and Rao. A phase-transformed bin counts at most as a phase at random. That the records
/// share anything is tested on the smoothed coherence: of Gaussian noise that is not shared, the correlation
/// over a band B is normal with sigma 1 / sqrt(2 B T), and by Rice's formula (Bell Syst. Tech. J. 24, 46
/// (1945)) it crosses u sigma f_rms exp(-u^2 / 2) times per second of lag, f_rms^2 the band's mean of f^2.
/// Weights compared on leak noise: Gao, Brennan & Joseph, J. Sound Vib. 292, 552 (2006).
/// Records of one rate that begin at the same instant; a length in common of at least eight segments,
/// CalcSegment(). Positive correlation is sought: both sensors must have one polarity. A delay that is wrong
/// by a period of a narrow band is not in sigma_s; side_peak tells of it.
/// Throws InputError for a band that is empty or beyond half the rate, records too short, silent or not
/// finite (keys "a", "b").
DelayEstimate EstimateDelay(std::span<const float> a, std::span<const float> b, double rate_Hz,
                            const CorrelationOptions& options);

/// Samples of a segment: a power of two that holds eight of the longest delays, 1024 at least.
std::size_t CalcSegment(double rate_Hz, double max_delay_s);

}  // namespace piperun::estimator
