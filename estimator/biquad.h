#pragma once

#include <array>
#include <cstddef>

#include "base/check.h"

namespace piperun::estimator {

/// y_n = b0 x_n + b1 x_(n-1) + b2 x_(n-2) - a1 y_(n-1) - a2 y_(n-2)
struct BiquadCoefficients {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

/// Second-order sections in series, transposed direct form II. A value: copy it to save its state.
class BiquadCascade {
 public:
  static constexpr std::size_t kMaxSections = 4;

  void Append(const BiquadCoefficients& section) {
    Demand(size_ < kMaxSections, "a biquad cascade holds four sections");
    sections_[size_++].c = section;
  }
  /// Adds the sections of `other` behind these.
  void Append(const BiquadCascade& other) {
    for (std::size_t i = 0; i < other.size_; ++i) Append(other.sections_[i].c);
  }
  double Step(double x) {
    for (Section& s : sections_) {  // unused ones pass x on; a fixed count unrolls
      const double y = s.c.b0 * x + s.z1;
      s.z1 = s.c.b1 * x - s.c.a1 * y + s.z2;
      s.z2 = s.c.b2 * x - s.c.a2 * y;
      x = y;
    }
    return x;
  }
  /// The state in which a constant input x has always been there.
  void Settle(double x);

 private:
  struct Section {
    BiquadCoefficients c;
    double z1 = 0, z2 = 0;
  };
  std::array<Section, kMaxSections> sections_;
  std::size_t size_ = 0;
};

/// Butterworth filters of even order (2 or 4) by the bilinear transform with prewarped corner:
/// |H(f)|^2 = 1 / (1 + (tan(pi f / fs) / tan(pi fc / fs))^(+-2 order)), so exactly -3.01 dB at fc.
/// Range: 0 < fc < fs / 2; callers check user input first.
BiquadCascade ButterworthLowPass(int order, double corner_Hz, double rate_Hz);
BiquadCascade ButterworthHighPass(int order, double corner_Hz, double rate_Hz);
/// High pass at low_Hz followed by low pass at high_Hz, each of order 4.
BiquadCascade ButterworthBand(double low_Hz, double high_Hz, double rate_Hz);

}  // namespace piperun::estimator
