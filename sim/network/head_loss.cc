#include "sim/network/head_loss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/network/epanet_constants.h"
#include "sim/network/fixed_power.h"

namespace piperun::sim {
namespace {

using std::numbers::pi;

// Swamee & Jain: f = 0.25 / log10(e/(3.7 d) + 5.74/Re^0.9)^2 = 1/y^2 with y = -2/ln(10) ln(...). The flow
// enters through w = q / (nu d) = Re pi/4.
constexpr double kMinusTwoByLn10 = -2 / std::numbers::ln10;
constexpr double kTurbulentW = 1000 * pi;  // Re = 4000
constexpr double kLaminarW = 500 * pi;     // Re = 2000
const double kSwameeJain = 5.74 * std::pow(pi / 4, 0.9);
const FixedPower kReynoldsPower(0.9);
const double kSwameeJainAt4000 = 5.74 / std::pow(4000, 0.9);

double Square(double x) { return x * x; }

/// The cubic in Re/2000 that meets laminar flow at 2000 and Swamee & Jain at 4000, value and slope.
FrictionFactor CalcTransitionalFriction(double w, const PipeResistance& pipe) {
  const double y2 = pipe.relative_roughness / 3.7 + kSwameeJainAt4000;
  const double y3 = kMinusTwoByLn10 * std::log(y2);
  const double fa = 1 / (y3 * y3);
  const double fb = (2 + 0.9 * 2 * kMinusTwoByLn10 * kSwameeJainAt4000 / (y2 * y3)) * fa;
  const double r = w / kLaminarW;
  const double x1 = 7 * fa - fb;
  const double x2 = 0.128 - 17 * fa + 2.5 * fb;
  const double x3 = -0.128 + 13 * fa - 2 * fb;
  const double x4 = 0.032 - 3 * fa + 0.5 * fb;
  return {x1 + r * (x2 + r * (x3 + r * x4)),
          (x2 + r * (2 * x3 + r * 3 * x4)) / (pipe.viscous_flow_m3_s * kLaminarW)};
}

double CalcFriction(const PipeLink& pipe, HeadLossLaw law) {
  const double d = pipe.diameter_m;
  const double area = pi * d * d / 4;
  switch (law) {
    case HeadLossLaw::kHazenWilliams:
      return epanet::kHazenWilliams * pipe.length_m /
             (std::pow(pipe.roughness, epanet::kHazenWilliamsFlowExponent) *
              std::pow(d, epanet::kHazenWilliamsBoreExponent));
    case HeadLossLaw::kDarcyWeisbach:
      return pipe.length_m / (2 * epanet::kGravity_m_s2 * d * area * area);
    case HeadLossLaw::kChezyManning:
      return Square(pipe.roughness / area) * pipe.length_m /
             (epanet::kManningSquared * std::pow(d / 4, epanet::kManningRadiusExponent));
  }
  return 0;
}

}  // namespace

PipeResistance CalcPipeResistance(const PipeLink& pipe, const HydraulicOptions& options) {
  return {CalcFriction(pipe, options.law), CalcMinorLoss_s2_m5(pipe.minor_loss, pipe.diameter_m),
          pipe.roughness / pipe.diameter_m, options.viscosity_m2_s * pipe.diameter_m};
}

double CalcMinorLoss_s2_m5(double loss_coefficient, double diameter_m) {
  return epanet::kMinorLoss_s2_m * loss_coefficient / Square(Square(diameter_m));
}

FrictionFactor CalcTurbulentFriction(double flow_m3_s, const PipeResistance& pipe) {
  const double q = std::abs(flow_m3_s);
  const double w = q / pipe.viscous_flow_m3_s;
  if (w < kTurbulentW) return CalcTransitionalFriction(w, pipe);
  const double y1 = kSwameeJain / kReynoldsPower(w);
  const double y2 = pipe.relative_roughness / 3.7 + y1;
  const double y3 = kMinusTwoByLn10 * std::log(y2);
  const double f = 1 / (y3 * y3);
  return {f, 1.8 * f * y1 * kMinusTwoByLn10 / (y2 * y3 * q)};
}

HeadLoss CalcDarcyWeisbachLoss(double flow_m3_s, const PipeResistance& pipe) {
  const double q = std::abs(flow_m3_s);
  if (q <= kLaminarW * pipe.viscous_flow_m3_s) {
    const double linear = 16 * pi * pipe.viscous_flow_m3_s * pipe.friction;
    return {flow_m3_s * (linear + pipe.minor_s2_m5 * q), linear + 2 * pipe.minor_s2_m5 * q};
  }
  const FrictionFactor f = CalcTurbulentFriction(flow_m3_s, pipe);
  const double r = f.value * pipe.friction + pipe.minor_s2_m5;
  return {r * q * flow_m3_s, 2 * r * q + f.slope_s_m3 * pipe.friction * q * q};
}

HeadLoss CalcMinorHeadLoss(double flow_m3_s, double minor_s2_m5, double least_slope_s_m2) {
  if (minor_s2_m5 <= 0) return {epanet::kOpenSlope_s_m2 * flow_m3_s, epanet::kOpenSlope_s_m2};
  const double slope = 2 * minor_s2_m5 * std::abs(flow_m3_s);
  if (slope < least_slope_s_m2) return {least_slope_s_m2 / 2 * flow_m3_s, least_slope_s_m2 / 2};
  return {slope * flow_m3_s / 2, slope};
}

CurveLine FindCurveLine(const Curve& curve, double x) {
  std::size_t k = 1;
  while (k + 1 < curve.size() && curve[k].x < x) ++k;
  const double slope = (curve[k].y - curve[k - 1].y) / (curve[k].x - curve[k - 1].x);
  return {curve[k - 1].y - slope * curve[k - 1].x, slope};
}

double InterpolateCurve(const Curve& curve, double x) {
  if (x <= curve.front().x) return curve.front().y;
  if (x >= curve.back().x) return curve.back().y;
  const CurveLine line = FindCurveLine(curve, x);
  return line.intercept + line.slope * x;
}

}  // namespace piperun::sim
