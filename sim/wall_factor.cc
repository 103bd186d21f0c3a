#include "sim/wall_factor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/check.h"

namespace piperun::sim {
namespace {

constexpr std::array<WallFactorLawInfo, 5> kLaws{{
    {WallFactorLaw::kKehlenbeckDiFelice, "kehlenbeck_di_felice", "Kehlenbeck & Di Felice", 0.9},
    {WallFactorLaw::kDiFelice, "di_felice", "Di Felice", 0.9},
    {WallFactorLaw::kMunroe, "munroe", "Munroe", 0.8},
    {WallFactorLaw::kNewton, "newton", "Newton", 0.9},
    {WallFactorLaw::kNone, "none", "no wall factor", 1},
}};

double KehlenbeckDiFelice(double l, const Reynolds& re) {
  constexpr double kBranchesCross = 35.039852192352;
  const double k = 0.041 * std::exp(0.524 * re.log);
  const double l0 = (0.283 + 1.2 * k) / (1 + k);
  const double p = re.value <= kBranchesCross ? 1.44 + 0.5466 * std::exp(0.434 * re.log)
                                              : 2.3 + 37.3 * std::exp(-0.8686 * re.log);
  return (1 - std::pow(l, p)) / (1 + std::pow(l / l0, p));
}

double DiFelice(double l, const Reynolds& re) {
  const double exponent = 0.85 + 2.45 / (1 + 0.1 * re.value);
  return std::pow((1 - l) / (1 - 0.33 * l), exponent);
}

constexpr double kTableBegin = 3.6888794541139363;  // ln 40
constexpr double kTableEnd = 16.11809565095832;     // ln 1e7

}  // namespace

const WallFactorLawInfo& FindWallFactorLaw(WallFactorLaw law) { return kLaws[static_cast<std::size_t>(law)]; }

const WallFactorLawInfo& FindWallFactorLaw(std::string_view key) {
  const auto found = std::ranges::find(kLaws, key, &WallFactorLawInfo::key);
  Demand(found != kLaws.end(), "every wall factor that scenarios may name is known");
  return *found;
}

double CalcWallFactor(WallFactorLaw law, double diameter_ratio, const Reynolds& free_reynolds) {
  const double l = diameter_ratio;
  switch (law) {
    case WallFactorLaw::kKehlenbeckDiFelice:
      return KehlenbeckDiFelice(l, free_reynolds);
    case WallFactorLaw::kDiFelice:
      return DiFelice(l, free_reynolds);
    case WallFactorLaw::kMunroe:
      return 1 - l * std::sqrt(l);
    case WallFactorLaw::kNewton:
      return (1 - l * l) * std::sqrt(1 - 0.5 * l * l);
    case WallFactorLaw::kNone:
      return 1;
  }
  return 1;
}

double SolveLogWallFactor(WallFactorLaw law, double diameter_ratio, const Reynolds& reynolds) {
  const auto log_f = [&](double x) {  // at Re/f = Re exp(-x)
    const double log_re = reynolds.log - x;
    return std::log(CalcWallFactor(law, diameter_ratio, {std::exp(log_re), log_re}));
  };
  double x0 = 0, y0 = log_f(x0) - x0;  // the root of y: log_f(x) = x
  double x1 = y0;
  for (int i = 0; i < 50; ++i) {
    const double y1 = log_f(x1) - x1;
    if (std::abs(y1) < 1e-15 || y1 == y0) break;
    const double x2 = x1 - y1 * (x1 - x0) / (y1 - y0);
    x0 = x1, y0 = y1, x1 = x2;
  }
  return x1;
}

WallFactorTable::WallFactorTable(WallFactorLaw law, double diameter_ratio)
    : law_(law), diameter_ratio_(diameter_ratio) {
  for (int i = 0; i < kNodes; ++i) {
    const double log_re = std::lerp(kTableBegin, kTableEnd, i / (kNodes - 1.0));
    log_f_[static_cast<std::size_t>(i)] = SolveLogWallFactor(law, diameter_ratio, {std::exp(log_re), log_re});
  }
}

double WallFactorTable::EvalLog(const Reynolds& reynolds) const {
  const double x = (reynolds.log - kTableBegin) * ((kNodes - 1) / (kTableEnd - kTableBegin));
  if (!(x >= 0 && x < kNodes - 1)) return SolveLogWallFactor(law_, diameter_ratio_, reynolds);
  const int first = std::clamp(static_cast<int>(x) - 1, 0, kNodes - 4);
  const double a = x - first, b = a - 1, c = a - 2, d = a - 3;
  const double* y = &log_f_[static_cast<std::size_t>(first)];
  return (-b * c * d * y[0] + a * b * c * y[3]) / 6 + (a * c * d * y[1] - a * b * d * y[2]) / 2;
}

}  // namespace piperun::sim
