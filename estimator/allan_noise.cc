#include "estimator/allan_noise.h"

#include <cmath>
#include <numbers>

#include "base/flicker.h"

namespace piperun::estimator {
namespace {

constexpr double kSeriesBelow = 0.01;
constexpr double kForgotten = 40;  // exp(-40) is less than half an ulp of 1

double Square(double x) { return x * x; }

double CalcMarkovAllanVariance(double a, double m) {
  const SumVariance sum(a);
  return (4 * sum.Eval(m) - sum.Eval(2 * m)) / (2 * m * m);
}

/// Calls `use` with dt / T of every pole.
template <class Use>
void ForEachPole(double period_s, const Use& use) {
  for (const double time_s : kFlickerTimes_s) use(period_s / time_s);
}

double CalcFlickerVariance(const NoiseShape& shape, double m) {
  if (shape.flicker == FlickerForm::kIdeal) return 2 * std::numbers::ln2 / std::numbers::pi;
  double sum = 0;
  ForEachPole(shape.period_s, [&](double a) { sum += kFlickerVariance * CalcMarkovAllanVariance(a, m); });
  return sum;
}

}  // namespace

SumVariance::SumVariance(double a) : a_(a), p_(-std::expm1(-a)) {}

double SumVariance::Eval(double t) const {
  const double at = a_ * t;
  if (at < kSeriesBelow) {
    // t^2 less the double sum of 1 - exp(-a |i - j|), by powers of a; the sums of |i - j|^n are polynomials.
    const double t2 = t * t;
    const double s1 = (t2 - 1) * t / 3, s2 = (t2 - 1) * t2 / 6;
    const double s3 = ((t2 / 10 - 1.0 / 6) * t2 + 1.0 / 15) * t, s4 = ((t2 / 15 - 1.0 / 6) * t2 + 0.1) * t2;
    return t2 - a_ * (s1 - a_ * (s2 / 2 - a_ * (s3 / 6 - a_ * s4 / 24)));
  }
  const double decayed = at > kForgotten ? 1 : -std::expm1(-at);
  return (t * (2 - p_) - 2 * (1 - p_) * decayed / p_) / p_;
}

double CalcUnitAllanVariance(NoiseTerm term, const NoiseShape& shape, std::int64_t samples) {
  const double m = static_cast<double>(samples), dt = shape.period_s, tau = m * dt;
  switch (term) {
    case NoiseTerm::kQuantisation:
      return 3 / (tau * tau);
    case NoiseTerm::kWhite:
      return 1 / tau;
    case NoiseTerm::kFlicker:
      return CalcFlickerVariance(shape, m);
    case NoiseTerm::kRateRandomWalk:
      return dt * (2 * m * m + 1) / (6 * m);
    case NoiseTerm::kRamp:
      return 0.5 * tau * tau;
    case NoiseTerm::kGaussMarkov:
      return CalcMarkovAllanVariance(dt / shape.gauss_markov_time_s, m);
  }
  return 0;
}

double CalcAllanVariance(const NoiseModel& model, std::int64_t m) {
  double sum = 0;
  for (std::size_t i = 0; i < kNoiseTerms; ++i) {
    const double c = model.coefficients[i];
    if (c != 0) sum += c * c * CalcUnitAllanVariance(static_cast<NoiseTerm>(i), model.shape, m);
  }
  return sum;
}

DifferenceCovariance::DifferenceCovariance(const NoiseModel& model, std::int64_t m1, std::int64_t m2)
    : m1_(static_cast<double>(m1)), m2_(static_cast<double>(m2)) {
  const double dt = model.shape.period_s;
  const auto squared = [&](NoiseTerm term) { return Square(model.coefficients[Index(term)]); };
  rounding_ = squared(NoiseTerm::kQuantisation) / (dt * dt);
  white_ = -0.5 * squared(NoiseTerm::kWhite) / dt;
  walk_ = dt * squared(NoiseTerm::kRateRandomWalk) / 12;
  const double flicker = squared(NoiseTerm::kFlicker), markov = squared(NoiseTerm::kGaussMarkov);
  const bool ideal = model.shape.flicker == FlickerForm::kIdeal;
  ideal_flicker_ = ideal ? flicker / (2 * std::numbers::pi) : 0;
  if (!ideal && flicker > 0)
    ForEachPole(dt, [&](double a) { markov_.push_back({SumVariance(a), flicker * kFlickerVariance}); });
  if (markov > 0) markov_.push_back({SumVariance(dt / model.shape.gauss_markov_time_s), markov});
}

/// Terms whose second differences know nothing of each other once their windows part.
double DifferenceCovariance::EvalShort(double t) const {
  return (t == 0 ? rounding_ : 0) + t * (white_ + walk_ * (t * t - 1));
}

double DifferenceCovariance::EvalLong(double t) const {
  double sum = t > 0 ? ideal_flicker_ * t * t * std::log(t) : 0;
  for (const Markov& markov : markov_) sum -= 0.5 * markov.variance * markov.sum.Eval(t);
  return sum;
}

double DifferenceCovariance::Eval(double k) const {
  constexpr double kWeight[3] = {1, -2, 1};
  const bool apart = k > 2 * m1_ || k < -2 * m2_;
  const bool has_long = ideal_flicker_ != 0 || !markov_.empty();
  if (apart && !has_long) return 0;
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double t = std::abs(k + b * m2_ - a * m1_);
      sum += kWeight[a] * kWeight[b] * ((apart ? 0 : EvalShort(t)) + (has_long ? EvalLong(t) : 0));
    }
  }
  return sum;
}

double CalcDifferenceMean(const NoiseModel& model, std::int64_t m) {
  const double samples = static_cast<double>(m);
  return model.coefficients[Index(NoiseTerm::kRamp)] * model.shape.period_s * samples * samples;
}

}  // namespace piperun::estimator
