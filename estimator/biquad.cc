#include "estimator/biquad.h"

#include <cmath>
#include <numbers>

namespace piperun::estimator {
namespace {

enum class Side { kLow, kHigh };

/// One conjugate pole pair of quality Q at the prewarped corner k = tan(pi fc / fs).
BiquadCoefficients MakeSection(Side side, double k, double Q) {
  const double a0 = 1 + k / Q + k * k;
  BiquadCoefficients c;
  c.b0 = (side == Side::kLow ? k * k : 1) / a0;
  c.b1 = (side == Side::kLow ? 2 : -2) * c.b0;
  c.b2 = c.b0;
  c.a1 = 2 * (k * k - 1) / a0;
  c.a2 = (1 - k / Q + k * k) / a0;
  return c;
}

BiquadCascade Butterworth(Side side, int order, double corner_Hz, double rate_Hz) {
  Demand(order == 2 || order == 4, "Butterworth filters here have order 2 or 4");
  Demand(corner_Hz > 0 && corner_Hz < 0.5 * rate_Hz, "a filter's corner lies between 0 and half the rate");
  const double k = std::tan(std::numbers::pi * corner_Hz / rate_Hz);
  BiquadCascade cascade;
  for (int i = 0; i < order / 2; ++i) {
    // poles at angles (2i + 1) pi / (2 order) from the real axis of the left half plane's edge
    const double Q = 1 / (2 * std::sin((2 * i + 1) * std::numbers::pi / (2 * order)));
    cascade.Append(MakeSection(side, k, Q));
  }
  return cascade;
}

}  // namespace

void BiquadCascade::Settle(double x) {
  for (std::size_t i = 0; i < size_; ++i) {
    Section& s = sections_[i];
    const double y = x * (s.c.b0 + s.c.b1 + s.c.b2) / (1 + s.c.a1 + s.c.a2);
    s.z2 = s.c.b2 * x - s.c.a2 * y;
    s.z1 = s.c.b1 * x - s.c.a1 * y + s.z2;
    x = y;
  }
}

BiquadCascade ButterworthLowPass(int order, double corner_Hz, double rate_Hz) {
  return Butterworth(Side::kLow, order, corner_Hz, rate_Hz);
}

BiquadCascade ButterworthHighPass(int order, double corner_Hz, double rate_Hz) {
  return Butterworth(Side::kHigh, order, corner_Hz, rate_Hz);
}

BiquadCascade ButterworthBand(double low_Hz, double high_Hz, double rate_Hz) {
  BiquadCascade band = ButterworthHighPass(4, low_Hz, rate_Hz);
  band.Append(ButterworthLowPass(4, high_Hz, rate_Hz));
  return band;
}

}  // namespace piperun::estimator
