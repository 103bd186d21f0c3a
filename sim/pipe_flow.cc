#include "sim/pipe_flow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace piperun::sim {
namespace {

constexpr double kLaminarRe = 2300;
constexpr double kTurbulentRe = 4000;
constexpr double kMinExponent = 3;
constexpr double kMaxExponent = 14;

double SolveColebrook(double reynolds, double relative_roughness) {
  const double a = relative_roughness / 3.7, b = 2.51 / reynolds;
  // Newton on g(x) = x + 2 log10(a + b x), x = 1/sqrt(f); g is increasing and concave, so it converges
  double x = 7;
  for (int i = 0; i < 50; ++i) {
    const double dx = (x + 2 * std::log10(a + b * x)) / (1 + 2 * b / (std::numbers::ln10 * (a + b * x)));
    x -= dx;
    if (std::abs(dx) < 1e-15 * x) break;
  }
  return 1 / (x * x);
}

constexpr double kKarman = 0.387;

/// The power law for U = 1.
struct PowerLaw {
  double exponent;

  double operator()(double radius) const {
    const double peak = (exponent + 1) * (2 * exponent + 1) / (2 * exponent * exponent);
    return peak * std::pow(std::max(0.0, 1 - radius), 1 / exponent);
  }
  /// Integral over the circle of radius r around the axis: 2 pi int u rho drho in closed form.
  double IntegrateCore(double r) const {
    const double q = 1 / exponent, y = 1 - r;
    const double primitive_1 = (1 - std::pow(y, q + 1)) / (q + 1),
                 primitive_2 = (1 - std::pow(y, q + 2)) / (q + 2);
    return 2 * std::numbers::pi * (*this)(0) * (primitive_1 - primitive_2);
  }
};

/// What the log law's slope multiplies: ln y + 3/2, whose mean over the bore is nil.
struct LogLaw {
  double operator()(double radius) const { return std::log(std::max(1e-18, 1 - radius)) + 1.5; }
  double IntegrateCore(double r) const {
    const double y = 1 - r, log_y = std::log(std::max(1e-18, y));
    const double primitive = -0.75 - (y * log_y - y - 0.5 * y * y * log_y + 0.25 * y * y);
    return 2 * std::numbers::pi * (primitive + 0.75 * r * r);
  }
};

/// Integral of f over [0, pi] by midpoints in t, phi = pi (t - sin(2 pi t)/(2 pi)): the substitution
/// flattens both ends, where the integrands below have their power-law singularities.
template <class F>
double IntegrateHalfTurn(F f) {
  using std::numbers::pi;
  constexpr int kPoints = 48;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = (i + 0.5) / kPoints;
    sum += f(pi * t - 0.5 * std::sin(2 * pi * t)) * (1 - std::cos(2 * pi * t));
  }
  return sum * pi / kPoints;
}

/// The disc is cut into arcs of constant distance from the axis. Those that close around it make up the core.
template <class Law>
double CalcDiscVelocity(const Law& law, double lambda, double offset) {
  const double area = std::numbers::pi * lambda * lambda;
  if (offset == 0) return law.IntegrateCore(lambda) / area;
  const double inner = std::abs(offset - lambda), outer = offset + lambda;
  const double mid = 0.5 * (outer + inner), half = 0.5 * (outer - inner);
  const double arcs = half * IntegrateHalfTurn([&](double phi) {
                        const double rho = mid + half * std::cos(phi);
                        const double cosine =
                            (rho * rho + offset * offset - lambda * lambda) / (2 * rho * offset);
                        const double opening = 2 * std::acos(std::clamp(cosine, -1.0, 1.0));
                        return law(rho) * rho * opening * std::sin(phi);
                      });
  const double core = offset < lambda ? law.IntegrateCore(lambda - offset) : 0;
  return (core + arcs) / area;
}

/// Mean of grad u over the disc = integral of u n over its rim / area.
template <class Law>
double CalcDiscGradient(const Law& law, double lambda, double offset) {
  const double rim = IntegrateHalfTurn([&](double phi) {
    const double c = std::cos(phi);
    const double rho = std::sqrt(std::max(0.0, offset * offset + lambda * lambda + 2 * offset * lambda * c));
    return law(rho) * c;
  });
  return 2 * rim / (std::numbers::pi * lambda);
}

/// Cubic Lagrange weights at x in units of the nodes' spacing, for four neighbouring nodes of `count`.
struct CubicWeights {
  int first;
  std::array<double, 4> w;
};

std::array<double, 4> CalcLagrangeWeights(double a) {
  const double b = a - 1, c = a - 2, d = a - 3;
  return {-b * c * d / 6, a * c * d / 2, -a * b * d / 2, a * b * c / 6};
}

CubicWeights CalcCubicWeights(double x, int count) {
  const int first = std::clamp(static_cast<int>(x) - 1, 0, count - 4);
  return {first, CalcLagrangeWeights(x - first)};
}

/// 1/n of a profile in units of the table's spacing.
double CalcExponentNode(double exponent, int count) {
  Demand(exponent >= kMinExponent && exponent <= kMaxExponent, "the profile's exponent lies in [3, 14]");
  return (1 / exponent - 1 / kMaxExponent) / (1 / kMinExponent - 1 / kMaxExponent) * (count - 1);
}

}  // namespace

double CalcTurbulentFraction(double reynolds) {
  const double x = std::clamp((reynolds - kLaminarRe) / (kTurbulentRe - kLaminarRe), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

double CalcFrictionFactor(double reynolds, double relative_roughness) {
  Demand(reynolds >= 0 && relative_roughness >= 0 && relative_roughness <= 0.05,
         "friction is known for Re >= 0 and e/D in [0, 0.05]");
  if (reynolds == 0) return 0;
  const double turbulent = CalcTurbulentFraction(reynolds);
  double f = (1 - turbulent) * 64 / reynolds;
  if (turbulent > 0) f += turbulent * SolveColebrook(reynolds, relative_roughness);
  return f;
}

ProfileLaw FindProfileLaw(std::string_view key) {
  Demand(key == "power_law" || key == "log_law", "every profile that scenarios may name is known");
  return key == "log_law" ? ProfileLaw::kLogLaw : ProfileLaw::kPowerLaw;
}

VelocityProfile CalcVelocityProfile(double reynolds, double friction_factor, ProfileLaw law) {
  const double turbulent = CalcTurbulentFraction(reynolds);
  if (turbulent == 0) return {.turbulent_fraction = 0};
  if (law == ProfileLaw::kLogLaw) {
    return {.turbulent_fraction = turbulent, .log_slope = std::sqrt(friction_factor / 8) / kKarman};
  }
  return {1 / std::sqrt(friction_factor), turbulent};
}

DiscMeanTable::DiscMeanTable(double lambda) : lambda_(lambda), step_((1 - lambda) / (kOffsets - 1)) {
  Demand(lambda > 0 && lambda <= kMaxDiameterRatio, "d/D lies in (0, 0.95]");
  const auto fill = [&](Row& row, const auto& law) {
    for (int j = 0; j < kOffsets; ++j) {
      const double offset = j * step_;
      row[static_cast<std::size_t>(j)] = {CalcDiscVelocity(law, lambda, offset),
                                          CalcDiscGradient(law, lambda, offset)};
    }
  };
  for (std::size_t i = 0; i < kExponents; ++i) {
    const double q =
        1 / kMaxExponent + static_cast<double>(i) * (1 / kMinExponent - 1 / kMaxExponent) / (kExponents - 1);
    fill(nodes_[i], PowerLaw{1 / q});
    SumFlux(nodes_[i], flux_[i]);
  }
  fill(log_nodes_, LogLaw{});
  SumFlux(log_nodes_, log_flux_);
}

void DiscMeanTable::SumFlux(const Row& row, std::array<double, kOffsets>& flux) const {
  flux[0] = 0;
  for (int j = 0; j + 1 < kOffsets; ++j) {
    const auto node = static_cast<std::size_t>(j);
    flux[node + 1] = flux[node] + IntegrateCell(row, j, (j + 1) * step_);
  }
}

double DiscMeanTable::IntegrateCell(const Row& row, int cell, double offset) const {
  // the integrand is of fourth degree: three points of Gauss are exact
  constexpr std::array<double, 3> kPoint{-0.7745966692414834, 0, 0.7745966692414834};
  constexpr std::array<double, 3> kWeight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const double begin = cell * step_, half = 0.5 * (offset - begin);
  const int first = std::clamp(cell - 1, 0, kOffsets - 4);
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = begin + half * (1 + kPoint[k]);
    const std::array<double, 4> w = CalcLagrangeWeights(x / step_ - first);
    double velocity = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      velocity += w[j] * row[static_cast<std::size_t>(first) + j].velocity;
    }
    sum += kWeight[k] * velocity * x;
  }
  return half * sum;
}

DiscMean DiscMeanTable::EvalRow(const Row& row, double offset) const {
  const CubicWeights column = CalcCubicWeights(offset / step_, kOffsets);
  DiscMean mean;
  for (std::size_t j = 0; j < 4; ++j) {
    const DiscMean& node = row[static_cast<std::size_t>(column.first) + j];
    mean.velocity += column.w[j] * node.velocity;
    mean.gradient += column.w[j] * node.gradient;
  }
  return mean;
}

DiscMean DiscMeanTable::EvalPowerLaw(double exponent, double offset) const {
  const CubicWeights row = CalcCubicWeights(CalcExponentNode(exponent, kExponents), kExponents);
  const CubicWeights column = CalcCubicWeights(offset / step_, kOffsets);
  DiscMean mean;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const DiscMean& node =
          nodes_[static_cast<std::size_t>(row.first) + i][static_cast<std::size_t>(column.first) + j];
      const double weight = row.w[i] * column.w[j];
      mean.velocity += weight * node.velocity;
      mean.gradient += weight * node.gradient;
    }
  }
  return mean;
}

DiscMean DiscMeanTable::Eval(const VelocityProfile& profile, double offset_from_axis) const {
  const double offset = std::min(offset_from_axis, 1 - lambda_);
  const double turbulent = profile.turbulent_fraction;
  DiscMean mean;
  if (profile.log_slope > 0) {
    const DiscMean shape = EvalRow(log_nodes_, offset);
    mean = {1 + profile.log_slope * shape.velocity, profile.log_slope * shape.gradient};
  } else if (turbulent > 0) {
    mean = EvalPowerLaw(profile.exponent, offset);
  }
  const double laminar_velocity = 2 * (1 - offset * offset - 0.5 * lambda_ * lambda_);
  const double laminar_gradient = -4 * offset;
  return {turbulent * mean.velocity + (1 - turbulent) * laminar_velocity,
          turbulent * mean.gradient + (1 - turbulent) * laminar_gradient};
}

double DiscMeanTable::EvalRowFlux(const Row& row, const std::array<double, kOffsets>& flux,
                                  double offset) const {
  const int cell = std::clamp(static_cast<int>(offset / step_), 0, kOffsets - 2);
  return flux[static_cast<std::size_t>(cell)] + IntegrateCell(row, cell, offset);
}

double DiscMeanTable::EvalPowerLawFlux(double exponent, double offset) const {
  const CubicWeights rows = CalcCubicWeights(CalcExponentNode(exponent, kExponents), kExponents);
  double flux = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t row = static_cast<std::size_t>(rows.first) + i;
    flux += rows.w[i] * EvalRowFlux(nodes_[row], flux_[row], offset);
  }
  return flux;
}

double DiscMeanTable::EvalFlux(const VelocityProfile& profile, double offset) const {
  const double turbulent = profile.turbulent_fraction, square = offset * offset;
  const double laminar = square * (1 - 0.5 * lambda_ * lambda_ - 0.5 * square);
  if (turbulent == 0) return laminar;
  const double flux = profile.log_slope > 0
                          ? 0.5 * square + profile.log_slope * EvalRowFlux(log_nodes_, log_flux_, offset)
                          : EvalPowerLawFlux(profile.exponent, offset);
  return turbulent * flux + (1 - turbulent) * laminar;
}

}  // namespace piperun::sim
