#include "estimator/roof_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace piperun::estimator {
namespace {

constexpr std::size_t kTablePoints = 4096;
constexpr double kFitted = 5;  // x0, A, c, d and the choice of template

template <class F>
void ForEachBin(const BinRange& bins, F&& f) {
  const auto channel = static_cast<std::size_t>(bins.channel);
  for (std::int64_t i = bins.first; i <= bins.last; ++i) {
    const ProfileBin& bin = bins.profile->At(i);
    if (bin.weight > 0) f(bin.chainage_m, bin.levels_dB[channel], std::min(bin.weight, BinRange::kMaxWeight));
  }
}

}  // namespace

Roof::Roof(double slope_dB_m, double height_dB, double reach_m)
    : points_per_m_(static_cast<double>(kTablePoints - 1) / reach_m), table_(kTablePoints) {
  for (std::size_t i = 0; i < kTablePoints; ++i) {
    const double offset_m = static_cast<double>(i) / points_per_m_;
    table_[i] = 10 * std::log10(1 + std::pow(10, 0.1 * (height_dB - slope_dB_m * offset_m)));
  }
}

RoofFit FitRoof(const BinRange& bins, double x0_m, const Roof& roof) {
  // normal equations of the basis (1, u, m), u = x - x0
  Matrix3d N = Matrix3d::Zero();
  Vector3d r = Vector3d::Zero();
  ForEachBin(bins, [&](double chainage_m, double level_dB, double w) {
    const double u = chainage_m - x0_m;
    const Vector3d basis(1, u, roof.Level_dB(u));
    N += w * basis * basis.transpose();
    r += w * level_dB * basis;
  });
  const double det = N(0, 0) * N(1, 1) - N(0, 1) * N(0, 1);
  if (!(det > 0)) return {};
  // m and level with constant and trend projected out
  const auto solve = [&](double a, double b) {
    return Eigen::Vector2d((N(1, 1) * a - N(0, 1) * b) / det, (N(0, 0) * b - N(0, 1) * a) / det);
  };
  const Eigen::Vector2d line_m = solve(N(0, 2), N(1, 2)), line_y = solve(r[0], r[1]);
  const double mm = N(2, 2) - line_m[0] * N(0, 2) - line_m[1] * N(1, 2);
  const double my = r[2] - line_y[0] * N(0, 2) - line_y[1] * N(1, 2);
  if (!(mm > 0)) return {};
  RoofFit fit;
  fit.amplitude = my / mm;
  fit.trough_dB = line_y[0] - fit.amplitude * line_m[0];
  fit.trend_dB_m = line_y[1] - fit.amplitude * line_m[1];
  fit.reduction_dB2 = my > 0 ? my * my / mm : 0;
  return fit;
}

FitQuality CalcQuality(const BinRange& bins, double x0_m, const Roof& roof, const RoofFit& fit) {
  double squares = 0, products = 0, before = 0, n = 0;
  ForEachBin(bins, [&](double chainage_m, double level_dB, double w) {
    const double u = chainage_m - x0_m;
    const double expected = fit.trough_dB + fit.trend_dB_m * u + fit.amplitude * roof.Level_dB(u);
    const double residual = std::sqrt(w) * (level_dB - expected);
    squares += residual * residual;
    products += residual * before;
    before = residual;
    n += 1;
  });
  const double r = squares > 0 ? std::clamp(products / squares, 0.0, 0.95) : 0;
  const double inflation = (1 + r) / (1 - r);
  FitQuality quality;
  quality.variance_dB2 = std::numeric_limits<double>::infinity();
  quality.freedom = n / inflation - kFitted;
  if (n <= kFitted) return quality;
  quality.variance_dB2 = inflation * squares / (n - kFitted);
  if (quality.freedom < 1) return quality;
  if (fit.reduction_dB2 == 0) return quality;
  const double t2 = fit.reduction_dB2 / quality.variance_dB2;
  quality.z = std::sqrt(quality.freedom * std::log1p(t2 / quality.freedom));
  return quality;
}

double CalcNormalTail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

}  // namespace piperun::estimator
