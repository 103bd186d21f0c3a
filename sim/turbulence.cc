#include "sim/turbulence.h"

#include <algorithm>
#include <cmath>

#include "sim/random_oscillator.h"

namespace piperun::sim {
namespace {

constexpr double kAxialCentre = 0.8, kAxial2 = 0.58, kAxial4 = 1.32;
constexpr double kAcrossCentre = 0.7, kRadial2 = 0.41, kAzimuthal2 = 0.8;
constexpr double kCentreDissipation = 1.35, kWallDissipation = 2 / 0.4, kWallLayer = 0.02;
constexpr double kIntegralLength = 0.25;  // L/R

/// div S = v (3 c_r - c_th) d/R^2, plus v k (s_s - P) kappa where the axis bends; P = S across the pipe.
Vector3d CalcDrift(const LocalTurbulence& local) {
  const TurbulentPlace& place = local.place;
  const double radius2 = place.radius_m * place.radius_m;
  Vector3d drift = (3 * kRadial2 - kAzimuthal2) / radius2 * local.scale_m_s * place.offset_W;
  if (place.curvature_W.isZero(0)) return drift;
  const double stretch = 1 / (1 - place.offset_W.dot(place.curvature_W));
  const Vector3d& kappa = place.curvature_W;
  return drift + stretch * (local.scale_m_s * local.rms.axial * kappa - local.Scale(kappa));
}

void SetTimeScales(const TurbulenceCoefficients& c, LocalTurbulence& local) {
  const TurbulentPlace& place = local.place;
  const double u = place.friction_velocity_m_s;
  const double dissipation = CalcDissipationProfile(local.x2) * u * u * u / place.radius_m;
  const double lagrangian_s = 2 * local.rms.mean_square() * u * u / (c.kolmogorov_constant * dissipation);
  const double turnover3_s3 = c.diameter_m * c.diameter_m / dissipation;
  const bool large = turnover3_s3 > lagrangian_s * lagrangian_s * lagrangian_s;
  const double whole_s = large ? std::cbrt(turnover3_s3) : lagrangian_s;
  const double second_s = c.time_scale_ratio * whole_s, first_s = whole_s - second_s;
  local.omega_1_s = 1 / std::sqrt(first_s * second_s);
  local.gamma_1_s = 1 / first_s + 1 / second_s;
}

}  // namespace

RmsProfile CalcRmsProfile(double x2) {
  return {kAxialCentre + x2 * (kAxial2 + x2 * kAxial4), kAcrossCentre + kRadial2 * x2,
          kAcrossCentre + kAzimuthal2 * x2};
}

double CalcDissipationProfile(double x2) {
  return kCentreDissipation + kWallDissipation * x2 / (1 - x2 + kWallLayer);
}

TurbulenceCoefficients CalcTurbulenceCoefficients(const TurbulenceParams& params, double diameter_m,
                                                  double response) {
  return {params.intensity, params.kolmogorov_constant, params.time_scale_ratio, params.filter, diameter_m,
          response};
}

double CalcSizeFilter(const TurbulenceCoefficients& c, double bore_radius_m) {
  if (c.filter) return *c.filter;
  const double root = std::cbrt(c.diameter_m / (kIntegralLength * bore_radius_m));
  return 1 / std::sqrt(1 + root * root);
}

LocalTurbulence CalcLocalTurbulence(const TurbulentPlace& place, const TurbulenceCoefficients& c) {
  LocalTurbulence local;
  local.place = place;
  local.x2 = std::min(1.0, place.offset_W.squaredNorm() / (place.radius_m * place.radius_m));
  local.rms = CalcRmsProfile(local.x2);
  local.scale_m_s =
      place.friction_velocity_m_s * std::sqrt(place.turbulent_fraction) * c.intensity * place.size_filter;
  if (place.friction_velocity_m_s == 0 || place.turbulent_fraction == 0) return local;
  local.around_W = place.axis_W.cross(place.offset_W) / place.radius_m;
  local.drift_W_1_s = CalcDrift(local);
  SetTimeScales(c, local);
  return local;
}

Vector3d LocalTurbulence::Scale(const Vector3d& xi_W) const {
  const Vector3d &t = place.axis_W, &q = around_W;
  return scale_m_s * (rms.radial * xi_W + (rms.axial - rms.radial) * t.dot(xi_W) * t +
                      (kAzimuthal2 - kRadial2) * q.dot(xi_W) * q);
}

Vector3d LocalTurbulence::ScaleChange(const Vector3d& xi_W, const Vector3d& w_W) const {
  const Vector3d &t = place.axis_W, &d = place.offset_W, &kappa = place.curvature_W;
  const double ds = t.dot(w_W) / (1 - d.dot(kappa)), radius = place.radius_m;
  const Vector3d dt = ds * kappa, dd = w_W - ds * t;  // of the axis and of the offset
  const Vector3d& q = around_W;
  const Vector3d dq = (dt.cross(d) + t.cross(dd)) / radius;
  const double dx2 = 2 * d.dot(dd) / (radius * radius);
  const double along = t.dot(xi_W), around = q.dot(xi_W);
  const double d_radial = kRadial2 * dx2, d_axial = (kAxial2 + 2 * kAxial4 * x2) * dx2;
  const Vector3d of_axis =
      (d_axial - d_radial) * along * t + (rms.axial - rms.radial) * (dt.dot(xi_W) * t + along * dt);
  const Vector3d of_circle = (kAzimuthal2 - kRadial2) * (dq.dot(xi_W) * q + around * dq);
  return scale_m_s * (d_radial * xi_W + of_axis + of_circle);
}

TurbulenceState StartTurbulence(const std::array<double, 6>& n) {
  return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

TurbulenceState StepTurbulence(const TurbulenceState& state, const LocalTurbulence& local,
                               const TurbulenceCoefficients& c, bool held, const std::array<double, 6>& n,
                               double dt_s) {
  if (local.omega_1_s == 0) return state;
  const OscillatorStep step = CalcOscillatorStep(local.omega_1_s, local.gamma_1_s, dt_s);
  const Vector3d push = (held ? 0 : c.response) * local.drift_W_1_s;
  const Vector3d to_both(n[0], n[1], n[2]), to_xi(n[3], n[4], n[5]);
  const auto [xi_W, eta_W] = step.Advance(state.xi_W, state.eta_W, push, to_both, to_xi);
  return {xi_W, eta_W};
}

WaterFluctuation CalcFluctuation(const TurbulenceState& state, const LocalTurbulence& local,
                                 const Vector3d& mean_velocity_W) {
  if (local.omega_1_s == 0) return {};
  WaterFluctuation fluctuation;
  fluctuation.velocity_W = local.Scale(state.xi_W);
  fluctuation.acceleration_W = local.Scale(local.omega_1_s * state.eta_W + local.drift_W_1_s) +
                               local.ScaleChange(state.xi_W, mean_velocity_W + fluctuation.velocity_W);
  return fluctuation;
}

}  // namespace piperun::sim
