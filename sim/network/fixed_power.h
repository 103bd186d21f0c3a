#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace piperun::sim {

/// x^a for one exponent a and many x: head loss laws are little else. x = 2^e m, m = c (1 + r), c the middle
/// of the 128th part of [1, 2) that holds m, hence
///   x^a = 2^(a e) c^a (1 + r)^a,
/// two values of tables and five terms of the binomial series, |r| < 2^-8. Relative error below 1e-15, less
/// than half the time of std::pow. x = 0 and x outside [2^-64, 2^64) are left to std::pow.
class FixedPower {
 public:
  /// 0 <= exponent <= 2: the terms cut off are then below 1e-16.
  explicit FixedPower(double exponent);

  double exponent() const { return exponent_; }

  double operator()(double x) const {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t scale = (bits >> 52) - kLowestScale;  // huge for 0, NaN and x < 0, too
    if (scale >= scales_.size()) [[unlikely]]
      return std::pow(x, exponent_);
    const Part& part = parts_[(bits >> (52 - kPartBits)) % kParts];
    const double r = std::bit_cast<double>((bits & kFraction) | kOne) * part.inverse - 1;
    const double r2 = r * r;  // in pairs: half as long a chain of operations as Horner's rule
    const double rest = (a_[1] + r * a_[2]) + r2 * (a_[3] + r * a_[4]);
    const double whole = scales_[scale] * part.power;
    return whole + whole * (r * a_[0] + r2 * rest);
  }

 private:
  static constexpr int kPartBits = 7;
  static constexpr std::size_t kParts = 1u << kPartBits;
  static constexpr std::uint64_t kLowestScale = 1023 - 64;  ///< biased exponent of 2^-64
  static constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1;
  static constexpr std::uint64_t kOne = std::bit_cast<std::uint64_t>(1.0);

  struct Part {
    double inverse = 0;  ///< 1/c, rounded; c is what it is the inverse of
    double power = 0;    ///< c^a
  };

  double exponent_;
  std::array<double, 5> a_{};  ///< binomial coefficients (a over 1) ... (a over 5)
  std::array<Part, kParts> parts_{};
  std::array<double, 128> scales_{};  ///< 2^(a e), e from -64
};

}  // namespace piperun::sim
