#include "base/random.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace piperun {

namespace {

/// Small enough to stay in registers where it is used.
[[gnu::always_inline]] inline std::array<std::uint64_t, 4> Encrypt(
    const std::array<std::uint64_t, 4>& counter, const std::array<std::uint64_t, 2>& key) {
  const r123::Philox4x64::ctr_type c{{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x64::key_type k{{key[0], key[1]}};
  const auto r = r123::Philox4x64{}(c, k);
  return {r[0], r[1], r[2], r[3]};
}

}  // namespace

std::array<std::uint64_t, 4> Philox4x64(const std::array<std::uint64_t, 4>& counter,
                                        const std::array<std::uint64_t, 2>& key) {
  return Encrypt(counter, key);
}

std::uint64_t HashName(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return hash;
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view channel, std::uint64_t run)
    : key_{seed, HashName(channel)}, run_(run) {}

std::array<std::uint64_t, 4> RandomStream::Bits(std::uint64_t sample, std::uint64_t slot) const {
  return Encrypt({sample, slot, run_, 0}, key_);
}

std::array<double, 4> RandomStream::Uniforms(std::uint64_t sample, std::uint64_t slot) const {
  const auto bits = Encrypt({sample, slot, run_, 0}, key_);
  std::array<double, 4> u{};
  // the centres of 2^52 equal cells, all exact in a double: never 0, never 1, symmetric about 1/2
  for (std::size_t i = 0; i < 4; ++i) u[i] = (static_cast<double>(bits[i] >> 12) + 0.5) * 0x1p-52;
  return u;
}

namespace {

/// Taylor series of cos(a) and sin(a)/a in a^2: 1/n! with alternating signs, n even and odd.
constexpr int kTerms = 9;
constexpr std::array<double, kTerms> MakeSeries(int first) {
  std::array<double, kTerms> series{};
  double factor = 1;
  for (int i = 0, n = first; i < kTerms; ++i, n += 2) {
    series[static_cast<std::size_t>(i)] = factor;
    factor /= -(n + 1.0) * (n + 2.0);
  }
  return series;
}

double EvalSeries(const std::array<double, kTerms>& series, double a2) {
  double sum = series.back();
  for (std::size_t i = kTerms - 1; i-- > 0;) sum = sum * a2 + series[i];
  return sum;
}

/// A point of the unit circle, one of 2^32 equally spaced: the two highest bits choose the quadrant, the
/// others the angle a from its middle, |a| < pi/4, where the series leave out less than 1e-17.
std::array<double, 2> PickDirection(std::uint32_t bits) {
  static constexpr auto kCosine = MakeSeries(0), kSine = MakeSeries(1);
  const double a = (static_cast<double>(bits & 0x3fffffff) + 0.5 - 0x1p29) * (0x1p-31 * std::numbers::pi);
  const double cosine = EvalSeries(kCosine, a * a), sine = a * EvalSeries(kSine, a * a);
  switch (bits >> 30) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

}  // namespace

std::array<double, 6> RandomStream::SixNormals(std::uint64_t sample, std::uint64_t slot) const {
  const auto bits = Encrypt({sample, slot, run_, 0}, key_);
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double u = (static_cast<double>(bits[i] >> 32) + 0.5) * 0x1p-32;
    const double radius = std::sqrt(-2 * std::log(u));
    const auto direction = PickDirection(static_cast<std::uint32_t>(bits[i]));
    n[2 * i] = radius * direction[0];
    n[2 * i + 1] = radius * direction[1];
  }
  return n;
}

std::array<double, 4> RandomStream::Normals(std::uint64_t sample, std::uint64_t slot) const {
  const auto u = Uniforms(sample, slot);
  std::array<double, 4> n{};
  for (std::size_t i = 0; i < 4; i += 2) {
    const double radius = std::sqrt(-2 * std::log(u[i]));
    const double angle = 2 * std::numbers::pi * u[i + 1];
    n[i] = radius * std::cos(angle);
    n[i + 1] = radius * std::sin(angle);
  }
  return n;
}

}  // namespace piperun
