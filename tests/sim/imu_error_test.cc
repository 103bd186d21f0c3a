#include "sim/imu_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/allan.h"

namespace piperun::sim {
namespace {

using testing::CalcAllanVariance;
using testing::CalcEdfFlicker;
using testing::CalcEdfRandomWalk;
using testing::CalcEdfWhite;

constexpr double kSigmas = 4.5;  // of an estimate; two-sided 7e-6 if it were normal

TriadStream MakeStream(std::uint64_t run = 0, std::uint64_t first_slot = 0) {
  return {RandomStream(20, "imu0", run), first_slot};
}

/// Errors of the three axes over n samples.
std::array<std::vector<double>, 3> Record(const TriadErrorParams& params, Rate rate, std::int64_t n,
                                          const TriadStream& stream = MakeStream()) {
  const TriadErrorCoefficients c = MakeCoefficients(params, rate, stream);
  TriadErrorState state = MakeState(c, stream);
  std::array<std::vector<double>, 3> axes;
  for (std::int64_t k = 0; k < n; ++k) {
    const Vector3d e = StepError(state, k, stream, c);
    for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)].push_back(e[i]);
  }
  return axes;
}

/// Mean of the three axes' Allan variances.
double MeanAllanVariance(const std::array<std::vector<double>, 3>& axes, std::size_t m) {
  return (CalcAllanVariance(axes[0], m) + CalcAllanVariance(axes[1], m) + CalcAllanVariance(axes[2], m)) / 3;
}

/// Allan variance at m samples of a stationary sequence with autocovariance r(n), summed term by term:
/// Var(mean of m) - Cov(means of neighbouring m).
template <class Autocovariance>
double StationaryAllanVariance(std::size_t m, const Autocovariance& r) {
  const double M = static_cast<double>(m);
  double within = r(0) * M, between = 0;
  for (std::size_t n = 1; n < 2 * m; ++n) {
    const double N = static_cast<double>(n);
    if (n < m) within += 2 * (M - N) * r(n);
    between += (n <= m ? N : 2 * M - N) * r(n);
  }
  return (within - between) / (M * M);
}

/// Of a Gauss-Markov sequence r(n) = variance decay^n.
double GaussMarkovAllanVariance(double variance, double decay, std::size_t m) {
  const double rate = std::log(decay);
  return StationaryAllanVariance(
      m, [&](std::size_t n) { return variance * std::exp(rate * static_cast<double>(n)); });
}

/// Of one that moves every `hold` samples by `decay`: seen from a random sample, r falls along chords.
double HeldAllanVariance(const GaussMarkov& process, std::size_t m) {
  const auto hold = static_cast<std::size_t>(process.hold);
  const double rate = std::log(process.decay);
  return process.sd * process.sd * StationaryAllanVariance(m, [&](std::size_t n) {
           const double part = static_cast<double>(n % hold) / static_cast<double>(hold);
           return std::exp(rate * static_cast<double>(n / hold)) * (1 - part * (1 - process.decay));
         });
}

TEST(ImuError, WhiteNoiseHasTheSdPerSampleAndTheAllanDeviationOfItsDensity) {
  TriadErrorParams p;
  p.noise = 1.745e-4;  // 0.01 deg/s/sqrt(Hz)
  const Rate rate(400);
  const std::size_t n = 400'000;
  const auto axes = Record(p, rate, n);
  for (const auto& x : axes) {
    double sum = 0, squares = 0;
    for (const double e : x) sum += e, squares += e * e;
    const double sd = p.noise * 20;  // N / sqrt(dt)
    EXPECT_NEAR(squares / n, sd * sd, kSigmas * sd * sd * std::sqrt(2.0 / n));
    EXPECT_NEAR(sum / n, 0, kSigmas * sd / std::sqrt(1.0 * n));
  }
  for (const std::size_t m : {1, 10, 100, 1000}) {
    const double expected = p.noise * p.noise / (static_cast<double>(m) / 400);  // N^2 / tau
    const double bound = kSigmas * std::sqrt(2 / (3 * CalcEdfWhite(n, m)));
    EXPECT_NEAR(MeanAllanVariance(axes, m) / expected, 1, bound) << m;
  }
}

TEST(ImuError, RateRandomWalkHasTheAllanDeviationOfItsDensity) {
  TriadErrorParams p;
  p.rate_random_walk = 2e-5;
  const std::size_t n = 400'000;
  const auto axes = Record(p, Rate(100), n);
  for (const std::size_t m : {1, 4, 32, 256, 2048}) {
    const double M = static_cast<double>(m);
    // sum of m steps of K sqrt(dt): K^2 dt (2 m^2 + 1) / (6 m), which tends to K^2 tau / 3
    const double expected = p.rate_random_walk * p.rate_random_walk * 0.01 * (2 * M * M + 1) / (6 * M);
    const double bound = kSigmas * std::sqrt(2 / (3 * CalcEdfRandomWalk(n, m)));
    EXPECT_NEAR(MeanAllanVariance(axes, m) / expected, 1, bound) << m;
  }
}

TEST(ImuError, BiasInstabilityPolesAddUpToTheFlatAllanDeviationOfFlickerNoise) {
  TriadErrorParams p;
  p.bias_instability = 3;
  const TriadErrorCoefficients c = MakeCoefficients(p, Rate(100), MakeStream());
  const double flicker = 2 * std::numbers::ln2 / std::numbers::pi * 9;  // (0.664 B)^2, facts 4.2
  for (const std::size_t m : {30, 100, 1000, 10'000, 100'000}) {        // 0.3 s to 1000 s
    double sum = 0;
    for (const GaussMarkov& pole : c.poles) sum += HeldAllanVariance(pole, m);
    EXPECT_NEAR(std::sqrt(sum / flicker), 1, 0.015) << m;
  }
}

TEST(ImuError, PolesThatMoveInStepsKeepTheAllanVarianceOfThoseThatMoveWithEverySample) {
  TriadErrorParams p;
  p.bias_instability = 3;
  for (const double hertz : {100.0, 400.0}) {
    const TriadErrorCoefficients c = MakeCoefficients(p, Rate(hertz), MakeStream());
    EXPECT_GT(c.poles.back().hold, 1'000'000 / 16 * hertz / 100);
    for (const std::size_t m : {1, 3, 10, 100, 1000, 10'000}) {
      double held = 0, moving = 0, T = 1e-2;
      for (const GaussMarkov& pole : c.poles) {
        held += HeldAllanVariance(pole, m);
        moving += GaussMarkovAllanVariance(c.pole_sd * c.pole_sd, std::exp(-1 / hertz / T), m);
        T *= 10;
      }
      EXPECT_NEAR(std::sqrt(held / moving), 1, 1e-3) << hertz << " Hz, " << m;
    }
  }
}

TEST(ImuError, BiasInstabilityHasTheAllanDeviationOfItsPoles) {
  TriadErrorParams p;
  p.bias_instability = 5e-5;
  const Rate rate(100);
  const std::size_t n = 200'000;
  const int records = 4;
  std::array<std::array<std::vector<double>, 3>, records> axes;
  for (std::size_t r = 0; r < records; ++r) axes[r] = Record(p, rate, n, MakeStream(r));
  const double sigma2 = p.bias_instability * p.bias_instability * std::numbers::ln10 / std::numbers::pi;
  for (const std::size_t m : {1, 10, 100, 1000}) {
    double expected = 0, T = 1e-2;
    for (std::size_t i = 0; i < kFlickerPoles; ++i, T *= 10) {
      expected += GaussMarkovAllanVariance(sigma2, std::exp(-0.01 / T), m);
    }
    double mean = 0;
    for (const auto& a : axes) mean += MeanAllanVariance(a, m) / records;
    const double bound = kSigmas * std::sqrt(2 / (3 * records * CalcEdfFlicker(n, m)));
    EXPECT_NEAR(mean / expected, 1, bound) << m;
  }
}

TEST(ImuError, BiasInstabilityIsStationaryFromTheFirstSample) {
  TriadErrorParams p;
  p.bias_instability = 1;
  const int runs = 2000;
  double first = 0, later = 0;
  for (std::uint64_t run = 0; run < runs; ++run) {
    const auto axes = Record(p, Rate(10), 50, MakeStream(run));
    for (const auto& x : axes) first += x.front() * x.front(), later += x.back() * x.back();
  }
  const double variance = 8 * std::numbers::ln10 / std::numbers::pi;
  const double bound = kSigmas * std::sqrt(2.0 / (3 * runs));
  EXPECT_NEAR(first / (3 * runs) / variance, 1, bound);
  EXPECT_NEAR(later / (3 * runs) / variance, 1, bound);
}

TEST(ImuError, TurnOnBiasIsDrawnOncePerRunWithItsSd) {
  TriadErrorParams p;
  p.bias = {0.3, 0, -0.1};
  p.bias_sd = 0.02;
  const int runs = 4000;
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  for (std::uint64_t run = 0; run < runs; ++run) {
    const TriadStream stream = MakeStream(run);
    const TriadErrorCoefficients c = MakeCoefficients(p, Rate(100), stream);
    TriadErrorState state = MakeState(c, stream);
    const Vector3d first = StepError(state, 0, stream, c);
    EXPECT_EQ(first, StepError(state, 1, stream, c));
    sum += first - p.bias;
    squares += (first - p.bias).cwiseAbs2();
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sum[i] / runs, 0, kSigmas * p.bias_sd / std::sqrt(1.0 * runs));
    EXPECT_NEAR(squares[i] / runs / (p.bias_sd * p.bias_sd), 1, kSigmas * std::sqrt(2.0 / runs));
  }
}

TEST(ImuError, ScaleFactorErrorIsDrawnOncePerRunWithItsSd) {
  TriadErrorParams p;
  p.scale_error = {0.01, 0.02, 0.03};
  p.scale_error_sd = 0.001;
  const int runs = 4000;
  Vector3d squares = Vector3d::Zero();
  for (std::uint64_t run = 0; run < runs; ++run) {
    const TriadErrorCoefficients c = MakeCoefficients(p, Rate(100), MakeStream(run));
    const Vector3d drawn = c.sensitivity.diagonal() - Vector3d::Ones() - p.scale_error;
    squares += drawn.cwiseAbs2();
    EXPECT_EQ(c.sensitivity(0, 1), 0);
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(squares[i] / runs / 1e-6, 1, kSigmas * std::sqrt(2.0 / runs));
}

TEST(ImuError, ScaleAndMisalignmentFollowTheStatedConvention) {
  TriadErrorParams p;
  p.bias = {0.5, 0, 0};
  p.scale_error = {0.01, 0, -0.02};
  p.misalignment << 0, 0.003, 0, 0, 0.1, 0, -0.004, 0, 0;
  const TriadErrorCoefficients c = MakeCoefficients(p, Rate(100), MakeStream());
  const Vector3d y = CalcReading({1, 2, 3}, p.bias, c);
  EXPECT_NEAR(y.x(), 1.01 * 1 + 0.003 * 2 + 0.5, 1e-15);
  EXPECT_NEAR(y.y(), 1.1 * 2, 1e-15);
  EXPECT_NEAR(y.z(), -0.004 * 1 + 0.98 * 3, 1e-15);
}

TEST(ImuError, SaturatesThenRoundsToTheRegister) {
  TriadErrorParams p;
  p.range = 10;
  p.resolution = 0.25;
  const TriadErrorCoefficients c = MakeCoefficients(p, Rate(100), MakeStream());
  EXPECT_EQ(CalcReading({11, -400, 3.4}, Vector3d::Zero(), c), Vector3d(10, -10, 3.5));
  EXPECT_EQ(CalcReading({0.12, -0.13, 9.9}, Vector3d::Zero(), c), Vector3d(0, -0.25, 10));
  EXPECT_EQ(CalcReading({9, 0, 0}, Vector3d(2, 0, 0), c), Vector3d(10, 0, 0));  // the error saturates as well
}

TEST(ImuError, TermsDoNotShareRandomNumbers) {
  TriadErrorParams noise, walk, flicker, all;
  noise.noise = all.noise = 0.1;
  walk.rate_random_walk = all.rate_random_walk = 0.2;
  flicker.bias_instability = all.bias_instability = 0.3;
  const Rate rate(100);
  const std::size_t n = 2000;
  const auto a = Record(noise, rate, n), b = Record(walk, rate, n), c = Record(flicker, rate, n);
  const auto sum = Record(all, rate, n);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(sum[i][k], a[i][k] + b[i][k] + c[i][k], 1e-13);
  }
}

TEST(ImuError, AxesTriadsAndRunsAreUncorrelated) {
  TriadErrorParams p;
  p.noise = 1;
  const std::size_t n = 100'000;
  const auto gyro = Record(p, Rate(1), n, MakeStream(0, 0));
  const auto accel = Record(p, Rate(1), n, MakeStream(0, kTriadSlots));
  const auto next_run = Record(p, Rate(1), n, MakeStream(1, 0));
  const auto correlation = [&](const std::vector<double>& x, const std::vector<double>& y) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += x[k] * y[k];
    return sum / static_cast<double>(n);
  };
  const double bound = kSigmas / std::sqrt(1.0 * n);
  EXPECT_NEAR(correlation(gyro[0], gyro[1]), 0, bound);
  EXPECT_NEAR(correlation(gyro[1], gyro[2]), 0, bound);
  EXPECT_NEAR(correlation(gyro[0], accel[0]), 0, bound);
  EXPECT_NEAR(correlation(gyro[0], next_run[0]), 0, bound);
}

TEST(ImuError, ACopiedStateGoesOnWithTheSameBits) {
  TriadErrorParams p;
  p.noise = 0.1;
  p.bias_instability = 0.2;
  p.rate_random_walk = 0.3;
  const TriadStream stream = MakeStream();
  const TriadErrorCoefficients c = MakeCoefficients(p, Rate(100), stream);
  TriadErrorState state = MakeState(c, stream);
  for (std::int64_t k = 0; k < 50; ++k) StepError(state, k, stream, c);
  TriadErrorState copy = state;
  for (std::int64_t k = 50; k < 100; ++k) {
    EXPECT_EQ(StepError(state, k, stream, c), StepError(copy, k, stream, c));
  }
}

}  // namespace
}  // namespace piperun::sim
