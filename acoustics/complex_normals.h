#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"

namespace piperun::acoustics {

/// Complex normal numbers z = sqrt(2 E) e^(i phi), so that Re z and Im z are independent standard normals,
/// each from one 64-bit word and without a transcendental function:
///   E = -ln u is exponential with mean 1. The leading zeros e of the word's upper 44 bits pick the octave
///   2^-(e+1) <= u < 2^-e, ten bits one of 1024 cells in it, of which E takes the mean of -ln u;
///   phi is one of 1024 equally spaced angles, whose moments are those of a uniform one up to order 1023.
/// The mean of E is exact, its variance 8e-8 too small; |z| <= 7.9.
class ComplexNormals {
 public:
  ComplexNormals();

  /// E and e^(i phi) of numbers k = 0, 1, ... of sample `sample`; word k is lane k % 4 of slot
  /// first_slot + k / 4.
  void Draw(const RandomStream& random, std::uint64_t sample, std::uint64_t first_slot,
            std::span<float> exponentials, std::span<std::complex<float>> phasors) const;

 private:
  float Exponential(std::uint64_t word) const;

  std::vector<float> mantissa_logs_;  // mean of ln m over the cells of 1 <= m < 2
  std::vector<std::complex<float>> phasors_;
};

}  // namespace piperun::acoustics
