#pragma once

#include <array>
#include <span>
#include <vector>

#include "estimator/allan.h"
#include "estimator/allan_noise.h"
#include "estimator/chi_square.h"

namespace piperun::estimator {

struct AllanFitOptions {
  FlickerForm flicker = FlickerForm::kPoles;
  /// By NoiseTerm. Gauss-Markov stands apart: with flicker beside it, few records tell the two from each
  /// other.
  std::array<bool, kNoiseTerms> terms{true, true, true, true, true, false};
  std::int64_t shortest_cluster = 1;  ///< samples; shorter ones are left out of the fit
  double confidence = 0.95;           ///< two-sided
};

/// A coefficient and where it lies with the confidence asked for.
struct FittedTerm {
  double value = 0;
  Interval interval;
  /// Interval no wider than half the value. If not, the value says nothing; interval.high bounds it.
  bool identifiable = false;
};

struct AllanFit {
  NoiseModel model;
  std::array<FittedTerm, kNoiseTerms> terms;
  FittedTerm gauss_markov_time_s;
  /// Of every point given, under the fitted model.
  std::vector<double> degrees_of_freedom;
  /// Largest distance of a fitted point from the model, in its standard deviations: about 2 to 3 where the
  /// model holds.
  double worst_misfit = 0;
  double worst_misfit_tau_s = 0;
};

/// The noise model whose Allan variance comes nearest: weighted least squares on the variance,
///
///   min sum_i ((V_i - sum_j c_j^2 A_j(m_i)) / sd_i)^2,   c_j^2 >= 0
///
/// with A_j from CalcUnitAllanVariance. sd_i^2 is the point's variance under the model itself
/// (CalcAllanCovariance), found by iterating: weights from the measured V_i would favour those that came out
/// low. The non-negative solution is exact, the best of all subsets of the terms. A Gauss-Markov time is
/// found by golden section on its logarithm. Clusters above ten samples are used two by two. Range: points of
/// one channel, two or more; throws InputError when fewer are left, or when all are zero.
NoiseModel FitNoiseModel(std::span<const AllanPoint> points, std::span<const SegmentGroup> segments,
                         double period_s, const AllanFitOptions& options);

/// The same with intervals. The covariance of the squared coefficients is that of the weighted estimate under
/// the full covariance S of the points (sandwich): (A^T W A)^-1 A^T W S W A (A^T W A)^-1, all terms asked for
/// taken as free, also those that came out as zero. A squared coefficient of relative variance r is taken as
/// a chi-square of 2 / r degrees of freedom (Welch 1947, Satterthwaite 1946), a Gauss-Markov time as
/// lognormal.
AllanFit FitAllan(std::span<const AllanPoint> points, std::span<const SegmentGroup> segments, double period_s,
                  const AllanFitOptions& options);

}  // namespace piperun::estimator
