#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "sim/ball.h"

namespace piperun::sim {

/// Share of turbulence in the flow of a pipe at Re = U D / nu: 0 up to 2 300, 1 from 4 000, a cubic blend
/// with level ends (3x^2 - 2x^3) between. A modelling choice: real transition is intermittent.
double CalcTurbulentFraction(double reynolds);

/// Darcy friction factor: 64/Re in laminar flow; Colebrook's (J. Inst. Civ. Eng. 11, 133 (1939))
///
///   1/sqrt(f) = -2 log10( e/(3.7 D) + 2.51/(Re sqrt(f)) )
///
/// solved to rounding in turbulent flow; blended by CalcTurbulentFraction between. Zero for water at rest.
/// Range: Re >= 0, relative roughness e/D in [0, 0.05] (aborts outside).
double CalcFrictionFactor(double reynolds, double relative_roughness);

/// Mean velocity across a pipe in turbulent flow, y = 1 - r/R:
///
///   power_law  u/U = (n+1)(2n+1)/(2n^2) y^(1/n),   n = 1/sqrt(f)
///   log_law    u/U = 1 + a (ln y + 3/2),           a = (u*/U)/kappa = sqrt(f/8)/0.387
///
/// Nikuradse; Schlichting, Boundary-Layer Theory, ch. XX: 1/sqrt(f) is within 5 % of the measured exponents.
/// kappa: Pirozzoli et al., J. Fluid Mech. 926, A28 (2021). Both have the bulk speed exactly, know roughness
/// by f, and lack the wake and a level middle; the log law has the wall's shear in place of an infinite one.
/// It holds down to the buffer layer; below y = exp(-1/a - 3/2), 1e-4 at f = 0.02, it would be negative:
/// 2e-5 of the flow, left in.
enum class ProfileLaw { kPowerLaw, kLogLaw };

/// By its key, "power_law" or "log_law"; aborts on another.
ProfileLaw FindProfileLaw(std::string_view key);

/// Velocity profile of fully developed pipe flow, u(r)/U.
struct VelocityProfile {
  double exponent = 7;            ///< n of the power law
  double turbulent_fraction = 1;  ///< the rest is Hagen-Poiseuille's parabola
  double log_slope = 0;           ///< a of the log law; 0: the power law
};

VelocityProfile CalcVelocityProfile(double reynolds, double friction_factor,
                                    ProfileLaw law = ProfileLaw::kPowerLaw);

/// What a ball sees of a profile, for U = 1 and bore radius 1.
struct DiscMean {
  double velocity = 0;  ///< mean of u over the ball's frontal disc
  double gradient = 0;  ///< mean of du/d(offset) over it, the derivative of `velocity` with the offset
};

/// Mean velocity over the frontal disc of a ball, d/D = lambda, with its centre at `offset` (in bore radii)
/// from the axis. Turbulent: tabulated at construction and interpolated by cubics, error below 1e-4 of U; the
/// log law is linear in its slope and takes one row. Laminar: 2 (1 - offset^2 - lambda^2/2), exact.
/// Range: 0 < lambda <= 0.95, 0 <= offset, n in [3, 14] (aborts outside). The ball touches at 1 - lambda;
/// farther out, where a joint or a closed end gives it more room than the pipe, it sees what it saw there.
class DiscMeanTable {
 public:
  explicit DiscMeanTable(double lambda);
  DiscMean Eval(const VelocityProfile& profile, double offset_from_axis) const;
  /// Integral of velocity times offset from the axis to `offset`: the stream function of what the ball sees.
  /// The primitive of Eval's very interpolant, so that a flow made of both conserves mass to rounding.
  double EvalFlux(const VelocityProfile& profile, double offset) const;
  double lambda() const { return lambda_; }

 private:
  static constexpr int kExponents = 9;  // nodes in 1/n
  static constexpr int kOffsets = 33;
  using Row = std::array<DiscMean, kOffsets>;
  DiscMean EvalPowerLaw(double exponent, double offset) const;
  DiscMean EvalRow(const Row& row, double offset) const;
  double EvalPowerLawFlux(double exponent, double offset) const;
  void SumFlux(const Row& row, std::array<double, kOffsets>& flux) const;
  double EvalRowFlux(const Row& row, const std::array<double, kOffsets>& flux, double offset) const;
  /// Integral of a row's interpolant from node `cell` to `offset`.
  double IntegrateCell(const Row& row, int cell, double offset) const;

  double lambda_;
  double step_;  // of the offset
  std::array<Row, kExponents> nodes_;
  std::array<std::array<double, kOffsets>, kExponents> flux_;  // up to each node
  Row log_nodes_;                                              // of ln(1 - r/R) + 3/2
  std::array<double, kOffsets> log_flux_;
};

}  // namespace piperun::sim
