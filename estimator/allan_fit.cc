#include "estimator/allan_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/check.h"
#include "estimator/allan_covariance.h"
#include "estimator/nonnegative_fit.h"

namespace piperun::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kIterations = 6;
constexpr double kRounding = 1e-6;  ///< relative sd of a point at least: a noise-free ramp has none
constexpr std::int64_t kEveryClusterUpTo = 10;
constexpr double kWidestInterval = 0.5;  ///< of the value
constexpr int kTimesPerDecade = 6;
constexpr double kGolden = 0.6180339887498949;
constexpr int kGoldenSteps = 30;

double Square(double x) { return x * x; }

/// The points the fit looks at, with what a weighted fit of them needs.
struct Problem {
  std::vector<AllanPoint> points;
  std::span<const SegmentGroup> segments;
  std::vector<NoiseTerm> terms;
  VectorXd sd;
};

std::vector<AllanPoint> ChoosePoints(std::span<const AllanPoint> points, std::int64_t shortest_cluster) {
  std::vector<AllanPoint> chosen;
  bool take = true;
  for (const AllanPoint& point : points) {
    if (point.cluster.samples < shortest_cluster) continue;
    if (take || point.cluster.samples <= kEveryClusterUpTo) chosen.push_back(point);
    take = !take;
  }
  return chosen;
}

Problem MakeProblem(std::span<const AllanPoint> points, std::span<const SegmentGroup> segments,
                    const AllanFitOptions& options) {
  Problem problem{ChoosePoints(points, options.shortest_cluster), segments, {}, {}};
  for (std::size_t i = 0; i < kNoiseTerms; ++i) {
    if (options.terms[i]) problem.terms.push_back(static_cast<NoiseTerm>(i));
  }
  if (problem.points.size() < 2) {
    throw InputError("the record is too short: a fit needs two averaging times, there are " +
                     std::to_string(problem.points.size()));
  }
  const bool still = std::all_of(problem.points.begin(), problem.points.end(),
                                 [](const AllanPoint& p) { return p.variance == 0; });
  if (still) throw InputError("every sample has the same value; there is no noise to fit");
  return problem;
}

VectorXd MeasuredVariances(const Problem& problem) {
  VectorXd V(static_cast<Eigen::Index>(problem.points.size()));
  for (Eigen::Index i = 0; i < V.size(); ++i) V(i) = problem.points[static_cast<std::size_t>(i)].variance;
  return V;
}

/// One column per term, one row per point, each over the point's standard deviation.
MatrixXd MakeDesign(const Problem& problem, const NoiseShape& shape) {
  MatrixXd A(problem.sd.size(), static_cast<Eigen::Index>(problem.terms.size()));
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const std::int64_t m = problem.points[static_cast<std::size_t>(i)].cluster.samples;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      const NoiseTerm term = problem.terms[static_cast<std::size_t>(j)];
      A(i, j) = CalcUnitAllanVariance(term, shape, m) / problem.sd(i);
    }
  }
  return A;
}

VectorXd CalcDeviations(const Problem& problem, const NoiseModel& model) {
  VectorXd sd(static_cast<Eigen::Index>(problem.points.size()));
  for (Eigen::Index i = 0; i < sd.size(); ++i) {
    const AllanCluster& cluster = problem.points[static_cast<std::size_t>(i)].cluster;
    const double variance = CalcAllanCovariance(model, problem.segments, cluster, cluster);
    sd(i) = std::max(std::sqrt(variance), kRounding * CalcAllanVariance(model, cluster.samples));
  }
  return sd;
}

/// As if all noise were white: only the degrees of freedom are taken from it.
VectorXd GuessDeviations(const Problem& problem, const NoiseShape& shape) {
  NoiseModel white{shape, {}};
  white.coefficients[Index(NoiseTerm::kWhite)] = 1;
  VectorXd sd = CalcDeviations(problem, white);
  const VectorXd V = MeasuredVariances(problem);
  const double floor = 1e-9 * V.maxCoeff();
  for (Eigen::Index i = 0; i < sd.size(); ++i) {
    const std::int64_t m = problem.points[static_cast<std::size_t>(i)].cluster.samples;
    sd(i) *= std::max(V(i), floor) / CalcAllanVariance(white, m);
  }
  return sd;
}

NonnegativeFit Solve(const Problem& problem, const NoiseShape& shape) {
  return FitNonnegative(MakeDesign(problem, shape), MeasuredVariances(problem).cwiseQuotient(problem.sd));
}

/// The Gauss-Markov time with the smallest residual, between three samples and the longest cluster.
double FitTime_s(const Problem& problem, NoiseShape shape) {
  const auto misfit = [&](double log_time) {
    shape.gauss_markov_time_s = std::exp(log_time);
    return Solve(problem, shape).squared_residual;
  };
  const double low = std::log(3 * shape.period_s);
  const double longest_s = shape.period_s * static_cast<double>(problem.points.back().cluster.samples);
  const int steps =
      std::max(2, static_cast<int>(kTimesPerDecade * std::log10(std::max(10.0, longest_s) / shape.period_s)));
  const double step = std::log(10.0) / kTimesPerDecade;
  int best = 0;
  double best_misfit = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const double now = misfit(low + i * step);
    if (now < best_misfit) best = i, best_misfit = now;
  }
  double left = low + (best - 1) * step, right = low + (best + 1) * step;
  for (int i = 0; i < kGoldenSteps; ++i) {
    const double width = kGolden * (right - left);
    if (misfit(right - width) < misfit(left + width)) {
      right = left + width;
    } else {
      left = right - width;
    }
  }
  return std::exp(0.5 * (left + right));
}

NoiseModel FitModel(Problem& problem, const NoiseShape& start) {
  NoiseModel model{start, {}};
  problem.sd = GuessDeviations(problem, start);
  const bool has_time =
      std::find(problem.terms.begin(), problem.terms.end(), NoiseTerm::kGaussMarkov) != problem.terms.end();
  for (int i = 0; i < kIterations; ++i) {
    if (i > 0) problem.sd = CalcDeviations(problem, model);
    if (has_time) model.shape.gauss_markov_time_s = FitTime_s(problem, model.shape);
    const NonnegativeFit fit = Solve(problem, model.shape);
    for (std::size_t j = 0; j < problem.terms.size(); ++j) {
      model.coefficients[Index(problem.terms[j])] = std::sqrt(fit.x(static_cast<Eigen::Index>(j)));
    }
  }
  return model;
}

/// How the model's variances change with the logarithm of the Gauss-Markov time.
VectorXd CalcTimeColumn(const Problem& problem, const NoiseModel& model) {
  constexpr double kStep = 1e-4;
  NoiseModel longer = model, shorter = model;
  longer.shape.gauss_markov_time_s *= std::exp(kStep);
  shorter.shape.gauss_markov_time_s *= std::exp(-kStep);
  VectorXd column(problem.sd.size());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    const std::int64_t m = problem.points[static_cast<std::size_t>(i)].cluster.samples;
    column(i) = (CalcAllanVariance(longer, m) - CalcAllanVariance(shorter, m)) / (2 * kStep * problem.sd(i));
  }
  return column;
}

/// Correlation of the points: their covariance over both standard deviations.
MatrixXd CalcCorrelation(const Problem& problem, const NoiseModel& model) {
  MatrixXd S(problem.sd.size(), problem.sd.size());
  for (Eigen::Index i = 0; i < S.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      S(i, j) =
          CalcAllanCovariance(model, problem.segments, problem.points[static_cast<std::size_t>(i)].cluster,
                              problem.points[static_cast<std::size_t>(j)].cluster) /
          (problem.sd(i) * problem.sd(j));
      S(j, i) = S(i, j);
    }
  }
  return S;
}

/// Standard deviations of the weighted estimate; infinite when the points do not determine it.
VectorXd CalcEstimateDeviations(const MatrixXd& A, const MatrixXd& S) {
  const VectorXd norms = A.colwise().norm();
  const MatrixXd scaled = A * norms.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  if (qr.rank() < A.cols()) return VectorXd::Constant(A.cols(), std::numeric_limits<double>::infinity());
  const MatrixXd G = qr.solve(MatrixXd::Identity(A.rows(), A.rows()));
  return (G * S * G.transpose()).diagonal().cwiseMax(0).cwiseSqrt().cwiseQuotient(norms);
}

bool IsIdentifiable(const FittedTerm& term) {
  return term.value > 0 && term.interval.high - term.interval.low <= kWidestInterval * term.value;
}

/// A coefficient from its square and the square's standard deviation.
FittedTerm MakeTerm(double value, double square_sd, double confidence) {
  const double half = CalcNormalQuantile(0.5 * (1 + confidence)) * square_sd;
  FittedTerm term{
      value, {std::sqrt(std::max(0.0, Square(value) - half)), std::sqrt(Square(value) + half)}, false};
  term.identifiable = IsIdentifiable(term);
  return term;
}

FittedTerm MakeTime(double value, double log_sd, double confidence) {
  const double factor = std::exp(CalcNormalQuantile(0.5 * (1 + confidence)) * log_sd);
  FittedTerm term{value, {value / factor, value * factor}, false};
  term.identifiable = IsIdentifiable(term);
  return term;
}

void AddIntervals(const Problem& problem, double confidence, AllanFit& fit) {
  MatrixXd A = MakeDesign(problem, fit.model.shape);
  const bool has_time = fit.model.coefficients[Index(NoiseTerm::kGaussMarkov)] > 0;
  if (has_time) {
    A.conservativeResize(Eigen::NoChange, A.cols() + 1);
    A.rightCols(1) = CalcTimeColumn(problem, fit.model);
  }
  const VectorXd sd = CalcEstimateDeviations(A, CalcCorrelation(problem, fit.model));
  for (std::size_t j = 0; j < problem.terms.size(); ++j) {
    const std::size_t i = Index(problem.terms[j]);
    fit.terms[i] = MakeTerm(fit.model.coefficients[i], sd(static_cast<Eigen::Index>(j)), confidence);
  }
  if (has_time)
    fit.gauss_markov_time_s = MakeTime(fit.model.shape.gauss_markov_time_s, sd(sd.size() - 1), confidence);
}

void AddMisfit(const Problem& problem, AllanFit& fit) {
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const AllanPoint& point = problem.points[i];
    const double off = std::abs(point.variance - CalcAllanVariance(fit.model, point.cluster.samples)) /
                       problem.sd(static_cast<Eigen::Index>(i));
    if (off <= fit.worst_misfit) continue;
    fit.worst_misfit = off;
    fit.worst_misfit_tau_s = fit.model.shape.period_s * static_cast<double>(point.cluster.samples);
  }
}

NoiseShape MakeShape(double period_s, const AllanFitOptions& options) {
  return {period_s, options.flicker, 100 * period_s};
}

}  // namespace

NoiseModel FitNoiseModel(std::span<const AllanPoint> points, std::span<const SegmentGroup> segments,
                         double period_s, const AllanFitOptions& options) {
  Problem problem = MakeProblem(points, segments, options);
  return FitModel(problem, MakeShape(period_s, options));
}

AllanFit FitAllan(std::span<const AllanPoint> points, std::span<const SegmentGroup> segments, double period_s,
                  const AllanFitOptions& options) {
  Problem problem = MakeProblem(points, segments, options);
  AllanFit fit;
  fit.model = FitModel(problem, MakeShape(period_s, options));
  problem.sd = CalcDeviations(problem, fit.model);
  AddIntervals(problem, options.confidence, fit);
  AddMisfit(problem, fit);
  for (const AllanPoint& point : points)
    fit.degrees_of_freedom.push_back(CalcDegreesOfFreedom(fit.model, segments, point.cluster));
  return fit;
}

}  // namespace piperun::estimator
