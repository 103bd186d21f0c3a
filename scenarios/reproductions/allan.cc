// The Allan tool against noise of known size: one term on at a time, the mean over many records.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/number.h"
#include "estimator/allan_fit.h"
#include "scenarios/figure_checks.h"
#include "scenarios/parallel.h"
#include "sim/imu_error.h"

namespace piperun::scenarios {
namespace {

using estimator::FittedTerm;
using estimator::Index;
using estimator::NoiseTerm;

constexpr double kRate_Hz = 100;
constexpr double kPeriod_s = 1 / kRate_Hz;
constexpr int kRecords = 16;
constexpr std::int64_t kSamples = 882472;  // as long as the record of the thesis this tool answers
constexpr std::int64_t kFewestSamples = 20000;

/// One record per call.
using Generator = std::function<std::vector<double>(std::int64_t samples, const RandomStream& random)>;

/// One axis of the simulator's own error model.
std::vector<double> GenerateTriad(const sim::TriadErrorParams& params, std::int64_t samples,
                                  const RandomStream& random) {
  const sim::TriadStream stream{random, 0};
  const auto coefficients = sim::MakeCoefficients(params, Rate(kRate_Hz), stream);
  auto state = sim::MakeState(coefficients, stream);
  std::vector<double> y(static_cast<std::size_t>(samples));
  for (std::int64_t k = 0; k < samples; ++k) {
    y[static_cast<std::size_t>(k)] = StepError(state, k, stream, coefficients).x();
  }
  return y;
}

Generator TriadGenerator(double sim::TriadErrorParams::*field, double value) {
  sim::TriadErrorParams params;
  params.*field = value;
  return [params](std::int64_t n, const RandomStream& random) { return GenerateTriad(params, n, random); };
}

/// Rates from differences of an integral whose rounding error is uniform, standard deviation Q.
Generator QuantisationGenerator(double Q) {
  return [Q](std::int64_t n, const RandomStream& random) {
    const double lsb = Q * std::sqrt(12.0);
    const auto error = [&](std::int64_t k) {
      return lsb * (random.Uniforms(static_cast<std::uint64_t>(k), 0)[0] - 0.5);
    };
    std::vector<double> y(static_cast<std::size_t>(n));
    double last = error(0);
    for (std::int64_t k = 0; k < n; ++k) {
      const double next = error(k + 1);
      y[static_cast<std::size_t>(k)] = (next - last) / kPeriod_s;
      last = next;
    }
    return y;
  };
}

Generator GaussMarkovGenerator(double sigma, double time_s) {
  return [=](std::int64_t n, const RandomStream& random) {
    const double decay = std::exp(-kPeriod_s / time_s),
                 drive = sigma * std::sqrt(-std::expm1(-2 * kPeriod_s / time_s));
    double b = sigma * random.Normals(0, 1)[0];
    std::vector<double> y;
    for (std::int64_t k = 0; k < n; ++k) {
      y.push_back(b);
      b = decay * b + drive * random.Normals(static_cast<std::uint64_t>(k), 0)[0];
    }
    return y;
  };
}

Generator RampGenerator(double R) {
  return [R](std::int64_t n, const RandomStream&) {
    std::vector<double> y;
    for (std::int64_t k = 0; k < n; ++k) y.push_back(R * kPeriod_s * static_cast<double>(k));
    return y;
  };
}

struct Figure {
  const char* name;
  NoiseTerm term;
  double truth;
  double tolerance;  ///< relative, of the mean over all records at full size
  Generator generate;
  bool is_time = false;
  std::int64_t shortest_cluster = 1;
};

std::vector<Figure> MakeFigures() {
  using P = sim::TriadErrorParams;
  const Generator markov = GaussMarkovGenerator(0.01, 1);
  return {{"Q", NoiseTerm::kQuantisation, 1e-4, 0.003, QuantisationGenerator(1e-4)},
          {"N", NoiseTerm::kWhite, 0.01, 0.003, TriadGenerator(&P::noise, 0.01)},
          {"B", NoiseTerm::kFlicker, 0.01, 0.015, TriadGenerator(&P::bias_instability, 0.01), false, 11},
          {"K", NoiseTerm::kRateRandomWalk, 0.01, 0.005, TriadGenerator(&P::rate_random_walk, 0.01)},
          {"R", NoiseTerm::kRamp, 2e-5, 0.001, RampGenerator(2e-5)},
          {"Gauss-Markov sigma", NoiseTerm::kGaussMarkov, 0.01, 0.03, markov},
          {"Gauss-Markov time", NoiseTerm::kGaussMarkov, 1, 0.03, markov, true}};
}

double FitRecord(const Figure& figure, std::int64_t samples, const RandomStream& random) {
  estimator::AllanAccumulator accumulator;
  accumulator.Append(figure.generate(samples, random));
  estimator::AllanFitOptions options;
  options.terms[Index(NoiseTerm::kGaussMarkov)] = figure.term == NoiseTerm::kGaussMarkov;
  options.shortest_cluster = figure.shortest_cluster;
  const auto model = FitNoiseModel(accumulator.Points(), accumulator.Segments(), kPeriod_s, options);
  return figure.is_time ? model.shape.gauss_markov_time_s : model.coefficients[Index(figure.term)];
}

/// Records shrink first, in length down to kFewestSamples, then in number; bounds widen by the root of both.
struct Size {
  std::int64_t samples;
  int records;
  double widening;
};

Size MakeSize(double size) {
  Size s{std::max(kFewestSamples,
                  static_cast<std::int64_t>(static_cast<double>(kSamples) * std::min(size, 1.0))),
         kRecords, 1};
  s.widening = std::sqrt(static_cast<double>(kSamples) / static_cast<double>(s.samples));
  return s;
}

ReproduceReport Study(const ReproduceOptions& options) {
  const std::vector<Figure> figures = MakeFigures();
  const Size size = MakeSize(options.size);
  std::vector<double> found(figures.size() * static_cast<std::size_t>(size.records));
  const auto work = [&](int i) {
    const auto figure = static_cast<std::size_t>(i / size.records),
               record = static_cast<std::size_t>(i % size.records);
    const RandomStream random(options.seed, "allan", record);
    found[static_cast<std::size_t>(i)] = FitRecord(figures[figure], size.samples, random);
  };
  RunParallel(static_cast<int>(found.size()), options.jobs, options.stop, work, [&](double fraction) {
    if (options.progress) options.progress(fraction, "records");
  });
  ReproduceReport report;
  FigureChecks checks(report, "one term at a time, mean of " + std::to_string(size.records) + " records of " +
                                  std::to_string(size.samples) + " samples");
  for (std::size_t i = 0; i < figures.size(); ++i) {
    double sum = 0;
    for (int r = 0; r < size.records; ++r)
      sum += found[i * static_cast<std::size_t>(size.records) + static_cast<std::size_t>(r)];
    const double tolerance = figures[i].tolerance * (figures[i].term == NoiseTerm::kRamp ? 1 : size.widening);
    checks.Relative(figures[i].name, sum / size.records, figures[i].truth, tolerance, "what was put in");
  }
  return report;
}

}  // namespace

namespace reproductions::allan {
Reproduction Kind() {
  return {"allan",
          "The Allan tool finds Q, N, B, K, R and a Gauss-Markov process that were put in, one at a time",
          Study};
}
}  // namespace reproductions::allan

}  // namespace piperun::scenarios
