#pragma once

namespace piperun::estimator {

/// Regularised lower incomplete gamma function P(a, x) = 1/Gamma(a) int_0^x t^(a-1) e^-t dt, by its series
/// for x < a + 1 and by its continued fraction beyond (Abramowitz & Stegun 6.5.29 and 6.5.31). Range: a > 0,
/// x >= 0; relative error below 1e-12 for a up to 1e6, 1e-9 up to 1e9.
double CalcGammaP(double a, double x);

/// The value that a chi-square variable of `dof` degrees of freedom (any positive number) stays below with
/// probability `p`. Range: 0 < p < 1, dof > 0. Beyond 1e6 degrees of freedom by Wilson and Hilferty (1931),
/// which is then exact to 1e-9.
double CalcChiSquareQuantile(double p, double dof);

/// Quantile of the standard normal distribution. Range: 0 < p < 1.
double CalcNormalQuantile(double p);

struct Interval {
  double low = 0;
  double high = 0;
};

/// Two-sided confidence interval of a variance estimated as `variance` with `dof` equivalent degrees of
/// freedom: dof variance / chi^2 quantiles (NIST SP 1065, section 5.3.1).
Interval CalcVarianceInterval(double variance, double dof, double confidence);

}  // namespace piperun::estimator
