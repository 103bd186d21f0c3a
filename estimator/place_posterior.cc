#include "estimator/place_posterior.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "estimator/roof_fit.h"

namespace piperun::estimator {
namespace {

constexpr int kParts = 16;  // of a step of the table
constexpr double kTail = 0.025;

/// Probability mass in cells of equal width.
struct Histogram {
  double first_m = 0;  // middle of the first cell
  double cell_m = 0;
  std::vector<double> mass;

  double Place_m(std::size_t i) const { return first_m + static_cast<double>(i) * cell_m; }
};

double CatmullRom(std::span<const double> y, std::size_t i, double u) {
  const double before = i > 0 ? y[i - 1] : 2 * y[i] - y[i + 1];
  const double after = i + 2 < y.size() ? y[i + 2] : 2 * y[i + 1] - y[i];
  const double b = 0.5 * (y[i + 1] - before), e = 0.5 * (after - y[i]), step = y[i + 1] - y[i];
  return y[i] + u * (b + u * (3 * step - 2 * b - e + u * (b + e - 2 * step)));
}

Histogram Normalise(double first_m, double step_m, std::span<const double> log_likelihood) {
  Histogram p{first_m, step_m / kParts, {}};
  const double top = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  p.mass.reserve(kParts * (log_likelihood.size() - 1) + 1);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < log_likelihood.size(); ++i) {
    for (int part = 0; part < kParts; ++part) {
      p.mass.push_back(std::exp(CatmullRom(log_likelihood, i, static_cast<double>(part) / kParts) - top));
      sum += p.mass.back();
    }
  }
  p.mass.push_back(std::exp(log_likelihood.back() - top));
  sum += p.mass.back();
  for (double& mass : p.mass) mass /= sum;
  return p;
}

/// Where the distribution function of place plus normal error reaches `share`; by bisection.
double CalcQuantile_m(const Histogram& p, double error_sd_m, double share) {
  const auto below = [&](double x_m) {
    double sum = 0;
    for (std::size_t i = 0; i < p.mass.size(); ++i)
      sum += p.mass[i] * CalcNormalTail((p.Place_m(i) - x_m) / error_sd_m);
    return sum;
  };
  double low_m = p.first_m - 8 * error_sd_m, high_m = p.Place_m(p.mass.size() - 1) + 8 * error_sd_m;
  for (int i = 0; i < 50; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (below(middle_m) < share ? low_m : high_m) = middle_m;
  }
  return 0.5 * (low_m + high_m);
}

}  // namespace

PlacePosterior CalcPlacePosterior(double first_m, double step_m, std::span<const double> log_likelihood,
                                  double track_sd_m) {
  Demand(log_likelihood.size() >= 3 && step_m > 0, "a posterior is made of three likelihoods or more");
  const Histogram p = Normalise(first_m, step_m, log_likelihood);
  PlacePosterior posterior;
  for (std::size_t i = 0; i < p.mass.size(); ++i) posterior.mean_m += p.mass[i] * p.Place_m(i);
  // a cell's own width, uniform, and the track's error
  const double error_sd_m = std::hypot(track_sd_m, p.cell_m / std::sqrt(12.0));
  double variance_m2 = error_sd_m * error_sd_m;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    const double off_m = p.Place_m(i) - posterior.mean_m;
    variance_m2 += p.mass[i] * off_m * off_m;
  }
  posterior.sigma_m = std::sqrt(variance_m2);
  posterior.low_m = CalcQuantile_m(p, error_sd_m, kTail);
  posterior.high_m = CalcQuantile_m(p, error_sd_m, 1 - kTail);
  return posterior;
}

}  // namespace piperun::estimator
