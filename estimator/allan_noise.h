#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace piperun::estimator {

/// Terms of a resting inertial sensor's noise (IEEE Std 952-1997, annex C).
enum class NoiseTerm {
  kQuantisation,    ///< Q, u s: difference of a rounded integral
  kWhite,           ///< N, u / sqrt(Hz): angle or velocity random walk
  kFlicker,         ///< B, u: bias instability
  kRateRandomWalk,  ///< K, u / s / sqrt(Hz)
  kRamp,            ///< R, u / s
  kGaussMarkov,     ///< sigma, u, with its correlation time
};
inline constexpr std::size_t kNoiseTerms = 6;
inline constexpr std::size_t Index(NoiseTerm term) { return static_cast<std::size_t>(term); }

/// What stands for flicker noise of coefficient B.
enum class FlickerForm {
  /// The eight Gauss-Markov processes of base/flicker.h: what the simulator's sensors generate.
  kPoles,
  /// Density B^2 / (2 pi f) at every frequency: flat at (2 ln 2 / pi) B^2 for ever.
  kIdeal,
};

/// What a term of coefficient 1 looks like.
struct NoiseShape {
  double period_s = 0.01;  ///< dt
  FlickerForm flicker = FlickerForm::kPoles;
  double gauss_markov_time_s = 1;
};

/// Coefficients of the terms, in the order of NoiseTerm.
using NoiseCoefficients = std::array<double, kNoiseTerms>;

struct NoiseModel {
  NoiseShape shape;
  NoiseCoefficients coefficients{};
};

/// Allan variance at tau = m dt of a term of coefficient 1, exact for rates that are means over dt:
///
///   Q: 3 / tau^2   N: 1 / tau   K: dt (2 m^2 + 1) / (6 m)   R: tau^2 / 2   flicker, ideal: 2 ln 2 / pi
///   Gauss-Markov, and each pole of flicker: (4 D(m) - D(2 m)) / (2 m^2), D of SumVariance
///
/// (IEEE Std 952-1997, annex C; the discrete forms by summing the process's covariance.)
double CalcUnitAllanVariance(NoiseTerm term, const NoiseShape& shape, std::int64_t m);

double CalcAllanVariance(const NoiseModel& model, std::int64_t m);

/// Variance D(t) of the sum of t successive samples of a Gauss-Markov process of variance 1 whose samples are
/// correlated by phi = exp(-a): t (1 + phi) / (1 - phi) - 2 phi (1 - phi^t) / (1 - phi)^2. Where that
/// cancels, a t < 0.01, by the series in a. Relative error of its departure from t^2 below 2e-9 for any a >
/// 0.
class SumVariance {
 public:
  explicit SumVariance(double a);
  double Eval(double t) const;

 private:
  double a_;
  double p_;  ///< 1 - phi
};

/// E[z1_i z2_(i+k)] of second differences z1, z2 of theta (estimator/allan.h) over clusters of m1 and m2
/// samples, without the ramp, which only shifts their mean. By the generalised covariance g of theta,
///
///   sum_(a, b = 0, 1, 2) c_a c_b g(k + b m2 - a m1),   c = (1, -2, 1)
///   Q: delta(t) / dt^2   N: -|t| / (2 dt)   K: dt (|t|^3 - |t|) / 12   ideal flicker: t^2 ln|t| / (2 pi)
///   Gauss-Markov: -D(|t|) / 2
///
/// (Greenhall & Riley, "Uncertainty of stability variances based on finite differences", PTTI 2003, whose s_x
/// this is, with K made exact for sampled rates.)
class DifferenceCovariance {
 public:
  DifferenceCovariance(const NoiseModel& model, std::int64_t m1, std::int64_t m2);
  double Eval(double k) const;

 private:
  struct Markov {
    SumVariance sum;
    double variance;
  };
  double EvalShort(double t) const;
  double EvalLong(double t) const;

  double m1_, m2_;
  double rounding_, white_, walk_, ideal_flicker_;
  std::vector<Markov> markov_;
};

/// What the ramp adds to every second difference: R dt m^2.
double CalcDifferenceMean(const NoiseModel& model, std::int64_t m);

}  // namespace piperun::estimator
