#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace piperun {

/// Standard normal deviates by inversion of the normal distribution, from a table.
///
/// Of 32 random bits the highest chooses the side, and the others, m, the tail q = (m + 1/2) / 2^32 < 1/2
/// beyond x. Every octave of q is cut into eight pieces, and x is a polynomial of fifth degree in q on each,
/// through the quantiles at its Chebyshev points: within 1e-10 of the exact one for all m. |x| <= 6.34, which
/// a normal exceeds once in 4e9 draws.
class NormalQuantiles {
 public:
  /// Takes about a millisecond.
  NormalQuantiles();

  double operator()(std::uint32_t n) const {
    const double tail = static_cast<double>(n & 0x7fffffff) + 0.5;
    const auto bits = std::bit_cast<std::uint64_t>(tail);
    const Piece& c = pieces_[(bits >> (52 - kPieceBits)) - kFirstPiece];
    // the mantissa less 3/2
    const double z = std::bit_cast<double>((bits & kMantissa) | kOne) - 1.5;
    const double z2 = z * z;
    const double x = (c[0] + c[1] * z) + z2 * ((c[2] + c[3] * z) + z2 * (c[4] + c[5] * z));
    const std::uint64_t sign = static_cast<std::uint64_t>(~n & 0x80000000) << 32;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ sign);
  }

 private:
  using Piece = std::array<double, 6>;
  static constexpr int kPieceBits = 3;
  static constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1;
  static constexpr std::uint64_t kOne = std::uint64_t{1023} << 52;
  static constexpr std::uint64_t kFirstPiece = std::uint64_t{1022} << kPieceBits;  // of 1/2, the smallest
  static constexpr std::size_t kPieces = std::size_t{32} << kPieceBits;            // up to 2^31

  std::array<Piece, kPieces> pieces_;
};

/// The table, made when it is first asked for.
const NormalQuantiles& TheNormalQuantiles();

}  // namespace piperun
