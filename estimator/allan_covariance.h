#pragma once

#include <span>

#include "estimator/allan.h"
#include "estimator/allan_noise.h"

namespace piperun::estimator {

/// Covariance of two points of one record's overlapping Allan variance, for Gaussian noise of the given
/// model:
///
///   cov(V1, V2) = 1 / (4 m1^2 m2^2 M1 M2) sum_k c(k) (2 R(k)^2 + 4 u1 u2 R(k))
///
/// with R(k) of DifferenceCovariance, u of CalcDifferenceMean, and c(k) the pairs of differences at
/// lag k within the same segment. Points of one record are strongly correlated (0.9 between neighbours of the
/// default grid), which is why a fit that takes them for independent believes itself too much. The sum over
/// lags is taken lag by lag where R has its kinks, by eight-point Gauss quadrature between, and ends 50
/// clusters beyond, where R^2 has fallen by 1e-6 or more. Range: segments, by groups, as the record had them.
double CalcAllanCovariance(const NoiseModel& model, std::span<const SegmentGroup> segments,
                           const AllanCluster& first, const AllanCluster& second);

/// Equivalent degrees of freedom 2 E[V]^2 / var(V) of a point; infinite for a record without noise. Greenhall
/// & Riley (2003) define it so; for pure noise types it gives their figures, for a mixture the mixture's.
double CalcDegreesOfFreedom(const NoiseModel& model, std::span<const SegmentGroup> segments,
                            const AllanCluster& cluster);

}  // namespace piperun::estimator
