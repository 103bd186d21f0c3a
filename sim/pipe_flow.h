#pragma once

#include <array>
#include <cstddef>

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

/// Velocity profile of fully developed pipe flow, u(r)/U.
struct VelocityProfile {
  double exponent = 7;            ///< n of the power law; 1/sqrt(f), within 5 % of Nikuradse's fit
  double turbulent_fraction = 1;  ///< the rest is Hagen-Poiseuille's parabola
};

VelocityProfile CalcVelocityProfile(double reynolds, double friction_factor);

/// What a ball sees of a profile, for U = 1 and bore radius 1.
struct DiscMean {
  double velocity = 0;  ///< mean of u over the ball's frontal disc
  double gradient = 0;  ///< mean of du/d(offset) over it, the derivative of `velocity` with the offset
};

/// Mean velocity over the frontal disc of a ball, d/D = lambda, with its centre at `offset` (in bore radii)
/// from the axis. Turbulent: the power law
///
///   u/U = (n+1)(2n+1)/(2n^2) (1 - r/R)^(1/n)
///
/// (Nikuradse; Schlichting, Boundary-Layer Theory, ch. XX), tabulated at construction and interpolated by
/// cubics: error below 1e-4 of U. Laminar: 2 (1 - offset^2 - lambda^2/2), exact.
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
  DiscMean EvalTurbulent(double exponent, double offset) const;
  /// Integral of the interpolant of one exponent from node `cell` to `offset`.
  double IntegrateCell(std::size_t row, int cell, double offset) const;

  double lambda_;
  double step_;  // of the offset
  std::array<std::array<DiscMean, kOffsets>, kExponents> nodes_;
  std::array<std::array<double, kOffsets>, kExponents> flux_;  // up to each node
};

}  // namespace piperun::sim
