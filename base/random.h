#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/normal_quantile.h"

namespace piperun {

/// Philox4x64-10 (Salmon, Moraes, Dror & Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011):
/// a bijection of a 256-bit counter under a 128-bit key. No state, no memory.
std::array<std::uint64_t, 4> Philox4x64(const std::array<std::uint64_t, 4>& counter,
                                        const std::array<std::uint64_t, 2>& key);

/// 64-bit FNV-1a of a name: offset basis 0xcbf29ce484222325, prime 0x100000001b3.
std::uint64_t HashName(std::string_view name);

/// Random numbers of one named channel in one run: a pure function of (seed, name, run, sample, slot), so
/// that adding, removing or reordering channels changes nobody else's numbers. `sample` counts the channel's
/// own samples; `slot` tells independent uses within a sample apart.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view channel, std::uint64_t run);

  std::array<std::uint64_t, 4> Bits(std::uint64_t sample, std::uint64_t slot) const;
  /// The words of `slot` and the slots after it, one after the other.
  void FillBits(std::uint64_t sample, std::uint64_t slot, std::span<std::uint64_t> words) const;
  /// Uniform on the open interval (0, 1): the centres of 2^52 equal cells.
  std::array<double, 4> Uniforms(std::uint64_t sample, std::uint64_t slot) const;
  /// Standard normal by Box and Muller (Ann. Math. Stat. 29, 610, 1958); |x| <= sqrt(106 ln 2) = 8.57.
  std::array<double, 4> Normals(std::uint64_t sample, std::uint64_t slot) const;
  /// Six for half the price of four, by inversion from 32 bits each (base/normal_quantile.h): |x| <= 6.34,
  /// which a normal exceeds once in 4e9 draws. Not the numbers of Normals().
  std::array<double, 6> SixNormals(std::uint64_t sample, std::uint64_t slot) const;

 private:
  std::array<std::uint64_t, 2> key_;
  std::uint64_t run_;
  const NormalQuantiles* quantiles_;
};

}  // namespace piperun
