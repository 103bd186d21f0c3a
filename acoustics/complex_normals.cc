#include "acoustics/complex_normals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr int kIndexBits = 10;
constexpr std::uint64_t kCells = 1 << kIndexBits;
constexpr std::uint64_t kOctaveStop = std::uint64_t{1} << (2 * kIndexBits - 1);  // ends the count of zeros

/// Antiderivative of ln m.
double IntegrateLog(double m) { return m * std::log(m) - m; }

}  // namespace

ComplexNormals::ComplexNormals() {
  const double cell = 1 / static_cast<double>(kCells);
  for (std::uint64_t i = 0; i < kCells; ++i) {
    const double m = 1 + static_cast<double>(i) * cell;
    mantissa_logs_.push_back(static_cast<float>((IntegrateLog(m + cell) - IntegrateLog(m)) / cell));
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) * cell;
    phasors_.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
  }
}

inline float ComplexNormals::Exponential(std::uint64_t word) const {
  const int octave = std::countl_zero(word | kOctaveStop) + 1;
  return static_cast<float>(octave) * std::numbers::ln2_v<float> -
         mantissa_logs_[(word >> kIndexBits) % kCells];
}

void ComplexNormals::Draw(const RandomStream& random, std::uint64_t sample, std::uint64_t first_slot,
                          std::span<float> exponentials, std::span<std::complex<float>> phasors) const {
  Demand(exponentials.size() == phasors.size(), "one phase per modulus");
  std::array<std::uint64_t, 256> words;
  for (std::size_t begin = 0; begin < phasors.size(); begin += words.size()) {
    const std::size_t count = std::min(words.size(), phasors.size() - begin);
    random.FillBits(sample, first_slot + begin / 4, std::span(words).first(count));
    for (std::size_t i = 0; i < count; ++i) exponentials[begin + i] = Exponential(words[i]);
    for (std::size_t i = 0; i < count; ++i) phasors[begin + i] = phasors_[words[i] % kCells];
  }
}

}  // namespace piperun::acoustics
