#include "base/random.h"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/function_clones.h"

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
    : key_{seed, HashName(channel)}, run_(run), quantiles_(&TheNormalQuantiles()) {}

std::array<std::uint64_t, 4> RandomStream::Bits(std::uint64_t sample, std::uint64_t slot) const {
  return Encrypt({sample, slot, run_, 0}, key_);
}

PIPERUN_CLONE_FOR("bmi2")
void RandomStream::FillBits(std::uint64_t sample, std::uint64_t slot, std::span<std::uint64_t> words) const {
  for (; words.size() >= 4; words = words.subspan(4)) {
    const auto bits = Encrypt({sample, slot++, run_, 0}, key_);
    words[0] = bits[0], words[1] = bits[1], words[2] = bits[2], words[3] = bits[3];
  }
  if (words.empty()) return;
  const auto last = Encrypt({sample, slot, run_, 0}, key_);
  std::copy_n(last.begin(), words.size(), words.begin());
}

std::array<double, 4> RandomStream::Uniforms(std::uint64_t sample, std::uint64_t slot) const {
  const auto bits = Encrypt({sample, slot, run_, 0}, key_);
  std::array<double, 4> u{};
  // the centres of 2^52 equal cells, all exact in a double: never 0, never 1, symmetric about 1/2
  for (std::size_t i = 0; i < 4; ++i) u[i] = (static_cast<double>(bits[i] >> 12) + 0.5) * 0x1p-52;
  return u;
}

std::array<double, 6> RandomStream::SixNormals(std::uint64_t sample, std::uint64_t slot) const {
  const auto bits = Encrypt({sample, slot, run_, 0}, key_);
  const NormalQuantiles& quantile = *quantiles_;
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < 3; ++i) {
    n[2 * i] = quantile(static_cast<std::uint32_t>(bits[i] >> 32));
    n[2 * i + 1] = quantile(static_cast<std::uint32_t>(bits[i]));
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
