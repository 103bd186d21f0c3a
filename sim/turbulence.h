#pragma once

#include <array>
#include <optional>

#include "base/pose.h"
#include "sim/force_params.h"

namespace piperun::sim {

/// Root mean squares of the velocity fluctuations in turbulent pipe flow over the friction velocity u*, at
/// x2 = (r/R)^2:
///
///   axial      0.8 + 0.58 x2 + 1.32 x2^2
///   radial     0.7 + 0.41 x2
///   azimuthal  0.7 + 0.80 x2
///
/// Even polynomials, so that the tensor they make is smooth on the axis, through the values that laboratories
/// and simulations agree on: 0.8, 0.7, 0.7 on the axis, 1.4, 0.9, 1.1 at y = 0.3 R and, at the wall, the
/// peaks 2.7, 1.1, 1.5 (from memory; Ono, Furuichi & Tsuji, J. Fluid Mech. 975 (2023), cover u* R/nu = 990 to
/// 20 750). Good to 10 % for y > 0.05 R. They do not fall to zero in the layer of some 50 nu/u* at the wall,
/// into which no ball's centre comes.
struct RmsProfile {
  double axial = 0;
  double radial = 0;
  double azimuthal = 0;

  double mean_square() const { return (axial * axial + radial * radial + azimuthal * azimuthal) / 3; }
};
RmsProfile CalcRmsProfile(double x2);

/// Dissipation over u*^3/R: 1.35 + 5 x2/(1 - x2 + 0.02). Near the wall the production u*^3/(0.4 y) of the log
/// law, levelling off at y = 0.01 R; on the axis what makes T_L = 0.16 R/u* with C0 = 5.
double CalcDissipationProfile(double x2);

struct TurbulenceCoefficients {
  double intensity = 1;
  double kolmogorov_constant = 5;
  double time_scale_ratio = 0.1;
  std::optional<double> filter;
  double diameter_m = 0;
  double response = 0;  ///< chi, see StepTurbulence
};

/// `diameter_m` 0: a particle of the water itself. For a free ball
///
///   chi = min(1, (rho V + m_a)/(m + m_a)),
///
/// the share of a sudden change of the water's velocity that it takes part in without drag.
TurbulenceCoefficients CalcTurbulenceCoefficients(const TurbulenceParams& params, double diameter_m,
                                                  double response);

/// Share of the rms that a ball of diameter d feels in a bore of radius R: TurbulenceParams::filter, or
///
///   f = (1 + (d/L)^(2/3))^(-1/2),   L = R/4
///
/// For small d it loses the energy of the eddies smaller than itself, which Kolmogorov's law puts at
/// (d/L)^(2/3) of the whole. L = sigma^3/eps is 0.25 to 0.29 R from the axis to r = 0.6 R. A choice: 0.56 for
/// 60 mm in 150 mm, 1 for d = 0.
double CalcSizeFilter(const TurbulenceCoefficients& c, double bore_radius_m);

/// What the fluctuations at a place follow from.
struct TurbulentPlace {
  Vector3d axis_W = Vector3d::UnitX();  ///< t, unit
  Vector3d curvature_W = Vector3d::Zero();
  Vector3d offset_W = Vector3d::Zero();  ///< d, from the axis, normal to it
  double radius_m = 0;                   ///< R
  double friction_velocity_m_s = 0;      ///< u*
  double turbulent_fraction = 1;         ///< of the flow (CalcTurbulentFraction)
  double size_filter = 1;                ///< share of the rms that is felt (CalcSizeFilter)
};

/// Turbulence at one place: u' = S xi, with xi of unit variance and
///
///   S = v (s_r 1 + (s_s - s_r) t t' + (c_th - c_r) q q'/R^2),   q = t x d,   v = u* f intensity
///
/// which has the principal rms s_s, s_r, s_th of RmsProfile along the axis, the radius and around. In laminar
/// flow v is zero; in between it has the root of the turbulent fraction.
struct LocalTurbulence {
  TurbulentPlace place;
  double scale_m_s = 0;                     ///< v; 0: no fluctuations
  double x2 = 0;                            ///< (r/R)^2, at most 1: beyond the bore as at its wall
  Vector3d around_W = Vector3d::Zero();     ///< q/R
  RmsProfile rms;                           ///< over v
  Vector3d drift_W_1_s = Vector3d::Zero();  ///< div S
  double omega_1_s = 0;                     ///< 1/sqrt(T1 T2)
  double gamma_1_s = 0;                     ///< 1/T1 + 1/T2

  Vector3d Scale(const Vector3d& xi_W) const;  ///< S xi
  /// d(S xi) for xi that stays, along a way with velocity w: (w . grad S) xi.
  Vector3d ScaleChange(const Vector3d& xi_W, const Vector3d& w_W) const;
};

/// Time scales: T1 + T2 = T, T2 = ratio T,
///
///   T = max(T_L, (d^2/eps)^(1/3)),   T_L = 2 sigma^2/(C0 eps)
///
/// (Tennekes; Pope, Turbulent Flows, 12.4; the second is the turnover time of an eddy of the ball's size).
/// `intensity` scales sizes, not times.
LocalTurbulence CalcLocalTurbulence(const TurbulentPlace& place, const TurbulenceCoefficients& c);

/// Fluctuating velocity that moves along with the ball, in units of its local rms, and its partner.
struct TurbulenceState {
  Vector3d xi_W = Vector3d::Zero();
  Vector3d eta_W = Vector3d::Zero();
};

/// The stationary distribution, from six standard normals.
TurbulenceState StartTurbulence(const std::array<double, 6>& normals);

/// One step of the two-time-scale model of Sawford (Phys. Fluids A 3, 1577 (1991)):
///
///   dxi = (omega eta + chi div S) dt,    deta = (-omega xi - gamma eta) dt + sqrt(2 gamma) dW
///
/// exact for coefficients that stand for the step (sim/random_oscillator.h): integral time T and acceleration
/// rms sigma/sqrt(T1 T2) do not depend on the step. div S is the drift without which what moves with the
/// water would gather where it fluctuates least: with it and chi = 1 uniform position times Gaussian xi, eta
/// solves the Fokker-Planck equation (the well-mixed condition of Thomson, J. Fluid Mech. 180, 529 (1987)).
/// Whatever the wall holds (chi = 0) meets the statistics of one place, without a drift; `held` says so.
/// Without fluctuations (u* = 0, laminar flow) the state stands still.
TurbulenceState StepTurbulence(const TurbulenceState& state, const LocalTurbulence& local,
                               const TurbulenceCoefficients& c, bool held,
                               const std::array<double, 6>& normals, double dt_s);

/// What the fluctuations add to the water around a ball.
struct WaterFluctuation {
  Vector3d velocity_W = Vector3d::Zero();
  Vector3d acceleration_W = Vector3d::Zero();
};

/// u' = S xi and its change along the water's own way, not the ball's,
///
///   Du'/Dt = S (omega eta + div S) + ((u + u') . grad S) xi
///
/// since it stands for the pressure gradient. On average it is div <u' u'>, as it must be. u: the mean flow.
/// Left out: u' . grad u of the mean flow beyond that, and what S changes along cones.
WaterFluctuation CalcFluctuation(const TurbulenceState& state, const LocalTurbulence& local,
                                 const Vector3d& mean_velocity_W);

}  // namespace piperun::sim
