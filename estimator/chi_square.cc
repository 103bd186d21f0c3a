#include "estimator/chi_square.h"

#include <cmath>
#include <limits>

#include "base/check.h"

namespace piperun::estimator {
namespace {

constexpr int kMostTerms = 100000;
constexpr double kSmallestTerm = 1e-16;
constexpr double kManyDof = 1e6;

/// x^a e^-x / Gamma(a)
double CalcDensityFactor(double a, double x) { return std::exp(a * std::log(x) - x - std::lgamma(a)); }

double SumSeries(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < kMostTerms && term > kSmallestTerm * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum;
}

/// Gamma(a, x) / (x^a e^-x) by Lentz's method.
double EvalContinuedFraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, value = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    c = b + numerator / c;
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = std::abs(c) < kTiny ? kTiny : c;
    value *= d * c;
    if (std::abs(d * c - 1) < kSmallestTerm) break;
  }
  return value;
}

double Cube(double x) { return x * x * x; }

/// Root of an increasing function within [low, high] by bisection, to the last bits.
template <class Function>
double Bisect(double low, double high, const Function& is_above) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (is_above(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double CalcGammaP(double a, double x) {
  Demand(a > 0 && x >= 0, "the incomplete gamma function takes a > 0 and x >= 0");
  if (x == 0) return 0;
  if (x < a + 1) return CalcDensityFactor(a, x) * SumSeries(a, x);
  return 1 - CalcDensityFactor(a, x) * EvalContinuedFraction(a, x);
}

double CalcNormalQuantile(double p) {
  Demand(p > 0 && p < 1, "a quantile belongs to a probability between 0 and 1");
  return Bisect(-40, 40, [p](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)) > p; });
}

double CalcChiSquareQuantile(double p, double dof) {
  Demand(p > 0 && p < 1 && dof > 0, "a chi-square quantile takes 0 < p < 1 and dof > 0");
  const double spread = 2 / (9 * dof);
  if (dof > kManyDof) return dof * Cube(1 - spread + CalcNormalQuantile(p) * std::sqrt(spread));
  double high = dof + 10;
  while (CalcGammaP(0.5 * dof, 0.5 * high) < p) high *= 2;
  return Bisect(0, high, [&](double x) { return CalcGammaP(0.5 * dof, 0.5 * x) > p; });
}

Interval CalcVarianceInterval(double variance, double dof, double confidence) {
  const double tail = 0.5 * (1 - confidence);
  if (!(dof > 0)) return {0, std::numeric_limits<double>::infinity()};
  if (std::isinf(dof)) return {variance, variance};
  return {dof * variance / CalcChiSquareQuantile(1 - tail, dof),
          dof * variance / CalcChiSquareQuantile(tail, dof)};
}

}  // namespace piperun::estimator
