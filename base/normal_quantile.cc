#include "base/normal_quantile.h"

#include <cmath>
#include <numbers>

namespace piperun {
namespace {

/// x >= 0 beyond which a normal lies with probability q <= 1/2: Newton's method on ln(erfc(x / sqrt 2) / 2) -
/// ln q, which is concave, from the bound exp(-x^2 / 2) / 2 >= q.
double CalcQuantile(double q) {
  double x = std::sqrt(-2 * std::log(2 * q));
  for (int i = 0; i < 8; ++i) {
    const double tail = 0.5 * std::erfc(x / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
    x += std::log(tail / q) * tail / density;
  }
  return x;
}

/// Coefficients, lowest first, of the polynomial of fifth degree through (z_i, x_i).
std::array<double, 6> Interpolate(const std::array<double, 6>& z, std::array<double, 6> x) {
  for (std::size_t order = 1; order < 6; ++order) {  // divided differences
    for (std::size_t i = 5; i >= order; --i) x[i] = (x[i] - x[i - 1]) / (z[i] - z[i - order]);
  }
  std::array<double, 6> c{};
  for (std::size_t i = 6; i-- > 0;) {  // Newton's form, multiplied out
    for (std::size_t k = 5; k > 0; --k) c[k] = c[k - 1] - z[i] * c[k];
    c[0] = x[i] - z[i] * c[0];
  }
  return c;
}

}  // namespace

NormalQuantiles::NormalQuantiles() {
  constexpr double kWidth = 1.0 / (1 << kPieceBits);
  for (std::size_t piece = 0; piece < kPieces; ++piece) {
    const int exponent = static_cast<int>(piece >> kPieceBits) - 1;
    const double middle = kWidth * (static_cast<double>(piece % (1 << kPieceBits)) + 0.5) - 0.5;
    std::array<double, 6> z{}, x{};
    for (std::size_t i = 0; i < 6; ++i) {
      z[i] = middle + 0.5 * kWidth * std::cos((static_cast<double>(i) + 0.5) / 6 * std::numbers::pi);
      x[i] = CalcQuantile(std::ldexp(z[i] + 1.5, exponent - 32));
    }
    pieces_[piece] = Interpolate(z, x);
  }
}

const NormalQuantiles& TheNormalQuantiles() {
  static const NormalQuantiles quantiles;
  return quantiles;
}

}  // namespace piperun
