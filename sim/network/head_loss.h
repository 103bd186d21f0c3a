#pragma once

#include <cmath>

#include "sim/network/model.h"

namespace piperun::sim {

/// Head lost by a flow, and how fast it grows with the flow.
struct HeadLoss {
  double loss_m = 0;
  double slope_s_m2 = 0;  ///< d(loss)/d(flow), > 0
};

/// What a pipe's head loss depends on beside the flow.
struct PipeResistance {
  double friction = 0;            ///< h = friction |q|^(n-1) q; for Darcy-Weisbach times the friction factor
  double minor_s2_m5 = 0;         ///< h = minor |q| q
  double relative_roughness = 0;  ///< Darcy-Weisbach only, as the next
  double viscous_flow_m3_s = 0;   ///< viscosity times bore: Re = 4 q / (pi viscous_flow)
};

PipeResistance CalcPipeResistance(const PipeLink& pipe, const HydraulicOptions& options);

/// Coefficient m of a minor loss h = m q^2 = K v^2/(2 g).
double CalcMinorLoss_s2_m5(double loss_coefficient, double diameter_m);

/// h = (r |q|^(n-1) + m |q|) q: Hazen-Williams (n = 1.852) and Chezy-Manning (n = 2), `power` = |q|^(n-1).
/// Below the slope `least_slope` the friction is made linear, so that a still pipe does not stall Newton's
/// method; the break in the curve is EPANET's.
inline HeadLoss CalcPowerLoss(double flow_m3_s, double power, double exponent, const PipeResistance& pipe,
                              double least_slope_s_m2) {
  double per_flow = pipe.friction * power;
  double slope = exponent * per_flow;
  if (slope < least_slope_s_m2) slope = per_flow = least_slope_s_m2 / exponent;
  const double minor = pipe.minor_s2_m5 * std::abs(flow_m3_s);
  return {(per_flow + minor) * flow_m3_s, slope + 2 * minor};
}

/// Friction factor and its derivative by the flow: Swamee & Jain, J. Hydraul. Div. ASCE 102, 657 (1976), for
/// Re >= 4000; Dunlop's cubic (1991) between 2000 and 4000.
struct FrictionFactor {
  double value = 0;
  double slope_s_m3 = 0;
};
FrictionFactor CalcTurbulentFriction(double flow_m3_s, const PipeResistance& pipe);

/// Darcy-Weisbach h = (f r |q| + m |q|) q; Hagen-Poiseuille for Re <= 2000.
HeadLoss CalcDarcyWeisbachLoss(double flow_m3_s, const PipeResistance& pipe);

/// h = m |q| q of a valve, linear below `least_slope`; next to nothing when m = 0.
HeadLoss CalcMinorHeadLoss(double flow_m3_s, double minor_s2_m5, double least_slope_s_m2);

/// Straight line of the piece of a curve that holds x (the outer pieces go on beyond the ends).
struct CurveLine {
  double intercept = 0;
  double slope = 0;
};
CurveLine FindCurveLine(const Curve& curve, double x);
/// y at x, held constant beyond the ends.
double InterpolateCurve(const Curve& curve, double x);

}  // namespace piperun::sim
