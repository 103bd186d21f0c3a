#include "sim/network/link_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

constexpr double kLeastOpening = 1e-6;
constexpr double kLeastCurveSlope_s_m2 = 1e-6 / epanet::kSquareFoot_m2;
constexpr double kMaxLoss_s2_m5 = 1e8 * epanet::kFoot_m / (epanet::kCubicFoot_m3 * epanet::kCubicFoot_m3);

HeadLoss OpenLoss(double flow_m3_s) { return {epanet::kOpenSlope_s_m2 * flow_m3_s, epanet::kOpenSlope_s_m2}; }

/// A pressure breaker loses its setting whatever the flow: nearly no slope.
HeadLoss CalcFixedLoss(double loss_m) { return {loss_m, 1 / epanet::kPinWeight_m2_s}; }

HeadLoss CalcCurveLoss(const Curve& curve, double flow_m3_s) {
  const double q = std::max(std::abs(flow_m3_s), epanet::kZeroFlow_m3_s);
  const CurveLine line = FindCurveLine(curve, q);
  const double slope = std::max(line.slope, kLeastCurveSlope_s_m2);
  return {std::copysign(line.intercept + slope * q, flow_m3_s), slope};
}

/// Kv/Kvo [%] at an opening: from the curve, which runs from (0, 0) to (100, 100) beyond its ends.
double FindRelativeKv(double opening, const Curve& curve) {
  if (curve.empty()) return opening;
  const CurvePoint first = curve.front(), last = curve.back();
  if (opening < first.x) return opening / first.x * first.y;
  if (opening > last.x) return last.y + (opening - last.x) / (1 - last.x) * (1 - last.y);
  return InterpolateCurve(curve, opening);
}

}  // namespace

HeadLoss CalcClosedLoss(double flow_m3_s) {
  return {epanet::kClosedSlope_s_m2 * flow_m3_s, epanet::kClosedSlope_s_m2};
}

double CalcPositionalLoss(double opening_percent, double open_loss, const Curve& curve) {
  if (opening_percent >= 100) return open_loss;
  if (opening_percent <= 0) return kMaxLoss_s2_m5;
  const double kv = std::clamp(FindRelativeKv(opening_percent, curve) / 100, kLeastOpening, 1.0);
  return std::min(open_loss / (kv * kv), kMaxLoss_s2_m5);
}

LinkLaws::LinkLaws(const HydraulicModel& model)
    : law_(model.options.law),
      power_(law_ == HeadLossLaw::kHazenWilliams ? epanet::kHazenWilliamsFlowExponent - 1 : 1),
      least_slope_s_m2_(model.options.least_slope_s_m2) {
  for (const PipeLink& pipe : model.pipes) {
    pipes_.push_back(CalcPipeResistance(pipe, model.options));
    first_pipe_flow_m3_s_.push_back(epanet::kFirstSpeed_m_s * std::numbers::pi * pipe.diameter_m *
                                    pipe.diameter_m / 4);
  }
  for (const PumpLink& pump : model.pumps) {
    const auto law = CalcPumpLaw(pump.kind, pump.curve);
    Demand(law.has_value(), "the reader refuses pump curves that do not fall");
    pumps_.push_back({pump.kind, *law, pump.curve, epanet::kPumpPower_m4_J * pump.power_W});
  }
  for (const ValveLink& valve : model.valves) {
    valves_.push_back(
        {valve.kind, valve.diameter_m, CalcMinorLoss_s2_m5(valve.minor_loss, valve.diameter_m), valve.curve});
  }
}

/// One loop per law, so that the law is asked for once, not at every pipe.
void LinkLaws::CalcPipeLosses(const HydraulicState& state, std::vector<HeadLoss>& losses) const {
  const auto calc_all = [&](auto calc_open) {
    for (std::size_t i = 0; i < pipes_.size(); ++i) {
      const double q = state.flow_m3_s[i];
      losses[i] = IsClosed(state.status[i]) ? CalcClosedLoss(q) : calc_open(q, pipes_[i]);
    }
  };
  const double least_slope = least_slope_s_m2_;
  switch (law_) {
    case HeadLossLaw::kHazenWilliams:
      return calc_all([&](double q, const PipeResistance& pipe) {
        return CalcPowerLoss(q, power_(std::abs(q)), epanet::kHazenWilliamsFlowExponent, pipe, least_slope);
      });
    case HeadLossLaw::kDarcyWeisbach:
      return calc_all(CalcDarcyWeisbachLoss);
    case HeadLossLaw::kChezyManning:
      return calc_all([&](double q, const PipeResistance& pipe) {
        return CalcPowerLoss(q, std::abs(q), 2, pipe, least_slope);
      });
  }
}

void LinkLaws::CalcLosses(const HydraulicState& state, std::vector<HeadLoss>& losses) const {
  CalcPipeLosses(state, losses);
  std::size_t link = pipes_.size();
  for (std::size_t i = 0; i < pumps_.size(); ++i, ++link) {
    const double q = state.flow_m3_s[link], speed = state.setting[link];
    losses[link] = IsClosed(state.status[link]) || speed == 0 ? CalcClosedLoss(q)
                                                              : CalcPumpLoss(static_cast<int>(i), q, speed);
  }
  for (std::size_t i = 0; i < valves_.size(); ++i, ++link) {
    losses[link] =
        CalcValveLoss(static_cast<int>(i), state.flow_m3_s[link], state.status[link], state.setting[link]);
  }
}

/// Affinity: H(q, s) = s^2 H(q / s).
HeadLoss LinkLaws::CalcPumpLoss(int pump, double flow_m3_s, double speed) const {
  const Pump& p = pumps_[pump];
  const double q = std::abs(flow_m3_s);
  if (p.kind == PumpKind::kConstantPower) {
    const double slope = p.power_coefficient_m4_s * speed * speed * speed / (q * q);
    if (slope > epanet::kClosedSlope_s_m2) return CalcClosedLoss(flow_m3_s);
    if (slope < epanet::kOpenSlope_s_m2) return OpenLoss(flow_m3_s);
    return {-p.power_coefficient_m4_s * speed * speed * speed / flow_m3_s, slope};
  }
  if (p.kind == PumpKind::kCurve) {
    const CurveLine line = FindCurveLine(p.curve, q / speed);
    const double slope = -line.slope * speed;
    return {-line.intercept * speed * speed + slope * flow_m3_s, slope};
  }
  const double n = p.law.exponent;
  const double shutoff = p.law.shutoff_head_m * speed * speed;
  const double slope = n * p.law.coefficient * std::pow(speed, 2 - n) * std::pow(q, n - 1);
  if (slope < least_slope_s_m2_) return {-shutoff + least_slope_s_m2_ * flow_m3_s, least_slope_s_m2_};
  return {-shutoff + slope * flow_m3_s / n, slope};
}

HeadLoss LinkLaws::CalcValveLoss(int valve, double flow_m3_s, LinkStatus status, double setting) const {
  if (IsClosed(status)) return CalcClosedLoss(flow_m3_s);
  const Valve& v = valves_[valve];
  if (v.kind == ValveKind::kGeneralPurpose) return CalcCurveLoss(v.curve, flow_m3_s);
  if (std::isnan(setting)) return CalcMinorHeadLoss(flow_m3_s, v.minor_s2_m5, least_slope_s_m2_);
  return CalcControlledLoss(v, flow_m3_s, setting);
}

HeadLoss LinkLaws::CalcControlledLoss(const Valve& valve, double flow_m3_s, double setting) const {
  double minor = valve.minor_s2_m5;
  switch (valve.kind) {
    case ValveKind::kPressureBreaker:
      if (setting > 0 && minor * flow_m3_s * flow_m3_s <= setting) return CalcFixedLoss(setting);
      break;
    case ValveKind::kThrottle:
      minor = CalcMinorLoss_s2_m5(setting, valve.diameter_m);
      break;
    case ValveKind::kPositional:
      minor = CalcPositionalLoss(setting, minor, valve.curve);
      break;
    default:
      break;
  }
  return CalcMinorHeadLoss(flow_m3_s, minor, least_slope_s_m2_);
}

double LinkLaws::FirstFlow_m3_s(int link, LinkStatus status, double setting) const {
  if (IsClosed(status)) return epanet::kZeroFlow_m3_s;
  const int pump = link - static_cast<int>(pipes_.size());
  if (pump < 0) return first_pipe_flow_m3_s_[link];
  const int valve = pump - static_cast<int>(pumps_.size());
  if (valve < 0) return setting * pumps_[pump].law.first_flow_m3_s;
  const double d = valves_[valve].diameter_m;
  return epanet::kFirstSpeed_m_s * std::numbers::pi * d * d / 4;
}

double LinkLaws::ShutoffHead_m(int pump, double speed) const {
  if (IsConstantPower(pump)) return std::numeric_limits<double>::infinity();
  return pumps_[pump].law.shutoff_head_m * speed * speed;
}

double LinkLaws::CalcOpenLoss_m(int valve, double flow_m3_s) const {
  return valves_[valve].minor_s2_m5 * flow_m3_s * flow_m3_s;
}

}  // namespace piperun::sim
