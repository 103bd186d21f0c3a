#pragma once

#include <bit>
#include <cstdint>

namespace piperun::acoustics {

/// exp(-x) for 0 <= x <= 80 within 2e-7 of its value. Sums, products and shifts only, so that a loop over it
/// runs in vector registers and gives the same bits with every mathematics library. With
/// -x = n ln 2 + r, |r| <= ln(2)/2: 2^n times the Taylor polynomial of degree 7 in r.
inline float CalcDecay(float x) {
  constexpr float kLog2e = 1.44269504F, kLn2High = 0.693359375F, kLn2Low = -2.12194440e-4F;
  constexpr float kRounder = 0x1.8p23F;  // adding it rounds to a whole number, found in the lowest bits
  const float shifted = -x * kLog2e + kRounder;
  const float n = shifted - kRounder;
  const float r = (-x - n * kLn2High) - n * kLn2Low;
  float p = 1.F / 5040;
  p = p * r + 1.F / 720;
  p = p * r + 1.F / 120;
  p = p * r + 1.F / 24;
  p = p * r + 1.F / 6;
  p = p * r + 0.5F;
  p = p * r + 1;
  p = p * r + 1;
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(shifted) << 23;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(p) + exponent);
}

}  // namespace piperun::acoustics
