#include "estimator/biquad.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace piperun::estimator {
namespace {

constexpr double kRate_Hz = 16000;

/// Amplitude of the filter's answer to a sine, after its transient.
double MeasureGain(BiquadCascade filter, double f_Hz) {
  const double w = 2 * std::numbers::pi * f_Hz / kRate_Hz;
  const int n = 16000;
  double re = 0, im = 0;
  for (int i = 0; i < 2 * n; ++i) {
    const double y = filter.Step(std::sin(w * i));
    if (i < n) continue;
    re += y * std::cos(w * i);
    im += y * std::sin(w * i);
  }
  return 2 * std::hypot(re, im) / n;
}

/// Butterworth's magnitude through the bilinear transform.
double ExpectedGain(double f_Hz, double corner_Hz, int order, int sign) {
  const double ratio =
      std::tan(std::numbers::pi * f_Hz / kRate_Hz) / std::tan(std::numbers::pi * corner_Hz / kRate_Hz);
  return 1 / std::sqrt(1 + std::pow(ratio, 2 * sign * order));
}

TEST(Biquad, LowPassFollowsButterworthsMagnitude) {
  for (const int order : {2, 4}) {
    for (const double f : {100., 500., 1000., 2000., 4000.}) {
      EXPECT_NEAR(MeasureGain(ButterworthLowPass(order, 1000, kRate_Hz), f), ExpectedGain(f, 1000, order, 1),
                  1e-9);
    }
  }
}

TEST(Biquad, HighPassFollowsButterworthsMagnitude) {
  for (const double f : {100., 1000., 3000., 6000.}) {
    EXPECT_NEAR(MeasureGain(ButterworthHighPass(4, 1000, kRate_Hz), f), ExpectedGain(f, 1000, 4, -1), 1e-9);
  }
}

TEST(Biquad, BandIsTheProductOfItsEdges) {
  for (const double f : {500., 1000., 2000., 4000., 6000.}) {
    EXPECT_NEAR(MeasureGain(ButterworthBand(1000, 4000, kRate_Hz), f),
                ExpectedGain(f, 1000, 4, -1) * ExpectedGain(f, 4000, 4, 1), 1e-9);
  }
}

TEST(Biquad, SettledFilterPassesAConstantFromTheFirstSample) {
  BiquadCascade filter = ButterworthLowPass(4, 5, 400);
  filter.Settle(9.8);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(filter.Step(9.8), 9.8, 1e-12);
}

}  // namespace
}  // namespace piperun::estimator
