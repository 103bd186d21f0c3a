#include "sim/junction_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "base/check.h"
#include "sim/jet.h"
#include "sim/junction_wall.h"

namespace piperun::sim {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFadeLength = 1.5;    // radii
constexpr double kFineSpacing = 0.15;  // radii
// mu, in mean diagonals of the normal equations, tried one after the other until the error between the points
// of the fit is as small as on them
constexpr std::array<double, 5> kRegularisation{1e-9, 1e-6, 1e-4, 1e-3, 1e-2};
constexpr double kGoodFit = 0.8;  // greatest normal velocity, in mean velocities

double CalcNormalVelocity(const WallPoint& point, const Vector3d& source) {
  const Vector3d d = point.p_N - source;
  const double r2 = d.squaredNorm();
  return d.dot(point.normal) / (4 * std::numbers::pi * r2 * std::sqrt(r2));
}

/// Least squares: a row per point, scaled by the root of its area. Conditions: a row per section, the flux
/// through it. Columns: sources; of the right sides: unit flows.
struct Equations {
  MatrixXd rows, targets;
  MatrixXd flux, flux_targets;
  MatrixXd normal;  ///< rows^T rows, its lower triangle
};

/// Normal velocities at a point per unit of each source.
Eigen::RowVectorXd CalcRow(const WallPoint& point, const std::vector<Vector3d>& sources) {
  Eigen::RowVectorXd row(static_cast<Eigen::Index>(sources.size()));
  for (Eigen::Index j = 0; j < row.size(); ++j) {
    row[j] = CalcNormalVelocity(point, sources[static_cast<std::size_t>(j)]);
  }
  return row;
}

double SumArea(const std::vector<WallPoint>& points) {
  return std::accumulate(points.begin(), points.end(), 0.0,
                         [](double sum, const WallPoint& point) { return sum + point.area_m2; });
}

Equations MakeEquations(const JunctionWall& wall, const Joint& joint) {
  const auto arms = static_cast<Eigen::Index>(joint.arms.size());
  const auto sources = static_cast<Eigen::Index>(wall.sources.size());
  const auto sections = static_cast<Eigen::Index>(wall.sections.size());
  auto count = static_cast<Eigen::Index>(wall.wall.size());
  for (const ArmSection& section : wall.sections) {
    if (section.to_end_m == 0) count += static_cast<Eigen::Index>(section.points.size());
  }
  Equations e{MatrixXd(count, sources), MatrixXd::Zero(count, arms), MatrixXd::Zero(sections, sources),
              MatrixXd::Zero(sections, arms), MatrixXd::Zero(sources, sources)};
  const double influx = 1 / SumArea(wall.wall);
  Eigen::Index row = 0;
  for (const WallPoint& point : wall.wall) {
    const double root = std::sqrt(point.area_m2);
    e.rows.row(row) = root * CalcRow(point, wall.sources);
    e.targets.row(row++).setConstant(-root * influx);
  }
  for (Eigen::Index k = 0; k < sections; ++k) {
    const ArmSection& section = wall.sections[static_cast<std::size_t>(k)];
    const auto arm = static_cast<Eigen::Index>(section.arm);
    const double radius = joint.arms[section.arm].radius_m, pi = std::numbers::pi;
    e.flux_targets.row(k).setConstant(-influx * 2 * pi * radius * section.to_end_m);
    e.flux_targets(k, arm) += 1;
    for (const WallPoint& point : section.points) {
      const Eigen::RowVectorXd velocity = CalcRow(point, wall.sources);
      e.flux.row(k) += point.area_m2 * velocity;
      if (section.to_end_m > 0) continue;
      const double root = std::sqrt(point.area_m2);
      e.rows.row(row) = root * velocity;
      e.targets(row++, arm) = root / (pi * radius * radius);
    }
  }
  e.normal.selfadjointView<Eigen::Lower>().rankUpdate(e.rows.transpose());
  return e;
}

/// min |rows q - targets|^2 + mu |q|^2 under flux q = flux_targets, by normal equations and multipliers. The
/// conditions are imposed thrice, which takes the rounding of the first time away.
MatrixXd SolveStrengths(const Equations& e, double regularisation) {
  const Eigen::Index n = e.rows.cols();
  MatrixXd normal = e.normal;
  normal.diagonal().array() += regularisation * normal.trace() / static_cast<double>(n);
  const Eigen::LLT<MatrixXd> factor(normal);
  Demand(factor.info() == Eigen::Success, "regularised normal equations are positive definite");
  const MatrixXd response = factor.solve(e.flux.transpose());
  const Eigen::LDLT<MatrixXd> conditions(e.flux * response);
  MatrixXd q = factor.solve(e.rows.transpose() * e.targets);
  for (int pass = 0; pass < 3; ++pass) q += response * conditions.solve(e.flux_targets - e.flux * q);
  return q;
}

/// Normal velocities on a finer wall than the one the strengths were fitted to, for one flow.
JunctionFit CalcFit(const JunctionWall& fine, const PointSources& sources, std::span<const double> outflow,
                    const Joint& joint) {
  const double area = SumArea(fine.wall);
  double unit = 0, influx = 0, square = 0;
  for (std::size_t i = 0; i < outflow.size(); ++i) {
    const double section = std::numbers::pi * joint.arms[i].radius_m * joint.arms[i].radius_m;
    unit = std::max(unit, std::abs(outflow[i]) / section);
    influx += outflow[i];
  }
  JunctionFit fit;
  for (const WallPoint& point : fine.wall) {
    const double error = sources.EvalVelocity(outflow, point.p_N).dot(point.normal) + influx / area;
    fit.wall_max = std::max(fit.wall_max, std::abs(error) / unit);
    square += point.area_m2 * error * error;
  }
  fit.wall_rms = std::sqrt(square / area) / unit;
  return fit;
}

/// The worst of the flows from one arm to the next.
JunctionFit CalcWorstFit(const JunctionWall& fine, const PointSources& sources, const Joint& joint) {
  const std::size_t arms = joint.arms.size();
  JunctionFit worst;
  for (std::size_t i = 0; i + 1 < arms || (i < arms && arms > 2); ++i) {
    std::vector<double> outflow(arms);
    outflow[i] = -1;
    outflow[(i + 1) % arms] = 1;
    const JunctionFit fit = CalcFit(fine, sources, outflow, joint);
    worst.wall_rms = std::max(worst.wall_rms, fit.wall_rms);
    worst.wall_max = std::max(worst.wall_max, fit.wall_max);
  }
  return worst;
}

}  // namespace

bool JunctionFlow::Covers(const Joint& joint) {
  for (std::size_t i = 0; i < joint.arms.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (joint.arms[i].outward.dot(joint.arms[j].outward) > std::cos(kMinAngle_rad)) return false;
    }
  }
  return joint.arms.size() >= 2;
}

JunctionFlow::JunctionFlow(const Joint& joint, std::span<const double> core_m) {
  Demand(Covers(joint) && core_m.size() == joint.arms.size(), "two arms or more, none parallel");
  const JunctionWall wall = MakeJunctionWall(joint, core_m);
  const Equations equations = MakeEquations(wall, joint);
  const JunctionWall fine = MakeJunctionWall(joint, core_m, kFineSpacing);
  for (const double regularisation : kRegularisation) {
    PointSources sources(wall.sources, SolveStrengths(equations, regularisation));
    const JunctionFit fit = CalcWorstFit(fine, sources, joint);
    if (sources_ && fit.wall_max >= fit_.wall_max) continue;
    fit_ = fit;
    sources_.emplace(std::move(sources));
    if (fit_.wall_max < kGoodFit) break;
  }
  fit_.sources = static_cast<int>(wall.sources.size());
  fit_.wall_points = static_cast<int>(wall.wall.size());
  for (std::size_t i = 0; i < core_m.size(); ++i) {
    const double radius = joint.arms[i].radius_m;
    const double fade_m = std::min(kFadeLength * radius, 0.6 * core_m[i]);
    arms_.push_back({MakeArmAxes(joint, i), radius, core_m[i] - fade_m, core_m[i], {}});
  }
  std::vector<double> unit(arms_.size());
  for (Arm& arm : arms_) {
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      unit.assign(arms_.size(), 0);
      unit[i] = 1;
      arm.h.push_back(FindHarmonics(arm, unit));
    }
  }
}

/// Fourier coefficients of dPsi/dr around the wall, mean over the fading part.
JunctionFlow::Harmonics JunctionFlow::FindHarmonics(const Arm& arm,
                                                    std::span<const double> outflow_m3_s) const {
  constexpr int kAngles = 4 * static_cast<int>(kHarmonics), kRings = 5;
  const double turn_m = 0.5 * (arm.fade_begin_m + arm.core_m);
  Harmonics h{};
  for (int k = 0; k < kRings * kAngles; ++k) {
    const double angle = 2 * std::numbers::pi * (k % kAngles) / kAngles;
    const double part = (0.5 + static_cast<double>(k / kAngles)) / kRings;
    const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
    const Vector3d p = arm.axes * Vector3d(arm.radius_m * out.x(), arm.radius_m * out.y(),
                                           std::lerp(arm.fade_begin_m, arm.core_m, part));
    const double slope = sources_->EvalPrimitive(outflow_m3_s, p, arm.axes, turn_m).slope.dot(out);
    for (std::size_t m = 0; m < kHarmonics; ++m) {
      const double mode = static_cast<double>(m + 1) * angle;
      h[m] += 2 * slope / (kAngles * kRings) * std::complex<double>(std::cos(mode), -std::sin(mode));
    }
  }
  return h;
}

/// h = Re f(zeta), zeta = (x + i y)/R, R f' = sum_m (a_m - i b_m) zeta^(m-1): grad h = (Re, -Im) R f'.
CrossPrimitive JunctionFlow::EvalHarmonics(const Arm& arm, std::span<const double> outflow_m3_s,
                                           const Eigen::Vector2d& p) const {
  const std::complex<double> zeta(p.x() / arm.radius_m, p.y() / arm.radius_m);
  std::complex<double> slope = 0, curvature = 0;
  for (std::size_t m = kHarmonics; m-- > 0;) {
    std::complex<double> coefficient = 0;
    for (std::size_t i = 0; i < arms_.size(); ++i) coefficient += outflow_m3_s[i] * arm.h[i][m];
    curvature = curvature * zeta + slope;
    slope = slope * zeta + coefficient;
  }
  curvature /= arm.radius_m;
  CrossPrimitive h;
  h.slope = {slope.real(), -slope.imag()};
  h.hessian << curvature.real(), -curvature.imag(), -curvature.imag(), -curvature.real();
  return h;
}

VelocityGradient JunctionFlow::Eval(std::span<const double> outflow_m3_s, std::size_t arm,
                                    const Vector3d& p_N) const {
  const Arm& a = arms_[arm];
  const VelocityGradient core = sources_->Eval(outflow_m3_s, p_N);
  const Vector3d p = a.axes.transpose() * p_N;  // from here on in the arm's axes
  if (p.z() <= a.fade_begin_m) return core;
  const double slope_1_m = -1 / (a.core_m - a.fade_begin_m);
  const Jet chi = CalcSmoothStep((p.z() - a.core_m) * slope_1_m, slope_1_m);
  const double uniform_m_s = outflow_m3_s[arm] / (std::numbers::pi * a.radius_m * a.radius_m);
  const double turn_m = 0.5 * (a.fade_begin_m + a.core_m);
  const CrossPrimitive psi = sources_->EvalPrimitive(outflow_m3_s, p_N, a.axes, turn_m);
  const CrossPrimitive h = EvalHarmonics(a, outflow_m3_s, p.head<2>());

  const Vector3d excess = a.axes.transpose() * core.velocity_m_s - uniform_m_s * Vector3d::UnitZ();
  Vector3d cross = Vector3d::Zero();
  cross.head<2>() = psi.slope - h.slope + 0.5 * uniform_m_s * p.head<2>();
  Matrix3d gradient = chi.value * (a.axes.transpose() * core.gradient_1_s * a.axes);
  gradient.col(2) += chi.d1 * excess + chi.d2 * cross;
  gradient.topLeftCorner<2, 2>() +=
      chi.d1 * (psi.hessian - h.hessian + 0.5 * uniform_m_s * Eigen::Matrix2d::Identity());
  gradient.topRightCorner<2, 1>() += chi.d1 * excess.head<2>();  // d/dz of the cross flow is grad_T Phi
  const Vector3d velocity = uniform_m_s * Vector3d::UnitZ() + chi.value * excess + chi.d1 * cross;
  return {a.axes * velocity, a.axes * gradient * a.axes.transpose()};
}

Vector3d JunctionFlow::EvalVelocity(std::span<const double> outflow_m3_s, std::size_t arm,
                                    const Vector3d& p_N) const {
  if (std::all_of(outflow_m3_s.begin(), outflow_m3_s.end(), [](double q) { return q == 0; })) {
    return Vector3d::Zero();
  }
  const bool in_core = arms_[arm].axes.col(2).dot(p_N) <= arms_[arm].fade_begin_m;
  return in_core ? sources_->EvalVelocity(outflow_m3_s, p_N) : Eval(outflow_m3_s, arm, p_N).velocity_m_s;
}

}  // namespace piperun::sim
