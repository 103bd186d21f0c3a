#include "sim/network/pump_law.h"

#include <cmath>

#include "base/number.h"
#include "sim/network/epanet_constants.h"

namespace piperun::sim {
namespace {

constexpr double kShutoffRatio = 1.33334;  // EPANET's 4/3
constexpr double kMaxExponent = 20;

std::optional<PumpLaw> FitPowerFunction(double h0, CurvePoint design, CurvePoint last) {
  if (!(h0 > design.y && design.y > last.y && last.y >= 0 && design.x > 0 && last.x > design.x)) {
    return std::nullopt;
  }
  PumpLaw law;
  law.shutoff_head_m = h0;
  law.exponent = std::log((h0 - last.y) / (h0 - design.y)) / std::log(last.x / design.x);
  law.coefficient = (h0 - design.y) / std::pow(design.x, law.exponent);
  law.first_flow_m3_s = design.x;
  if (!(law.exponent > 0 && law.exponent <= kMaxExponent)) return std::nullopt;
  return law;
}

std::optional<PumpLaw> FollowCurve(const Curve& curve) {
  if (curve.size() < 2) return std::nullopt;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i].y >= curve[i - 1].y) return std::nullopt;
  }
  PumpLaw law;
  law.shutoff_head_m = curve.front().y;
  law.first_flow_m3_s = (curve.front().x + curve.back().x) / 2;
  return law;
}

std::optional<PumpLaw> CalcCurveLaw(PumpKind kind, const Curve& curve) {
  if (curve.empty()) return std::nullopt;
  if (kind == PumpKind::kCurve) return FollowCurve(curve);
  if (curve.size() == 1) {
    return FitPowerFunction(kShutoffRatio * curve[0].y, curve[0], {2 * curve[0].x, 0});
  }
  return FitPowerFunction(curve[0].y, curve[1], curve[2]);
}

}  // namespace

PumpKind FindPumpKind(const Curve& curve) {
  const bool is_fit = curve.size() == 1 || (curve.size() == 3 && curve[0].x == 0);
  return is_fit ? PumpKind::kPowerFunction : PumpKind::kCurve;
}

std::optional<PumpLaw> CalcPumpLaw(PumpKind kind, const Curve& curve, std::string* problem) {
  if (kind == PumpKind::kConstantPower) return PumpLaw{.first_flow_m3_s = epanet::kFirstPowerPumpFlow_m3_s};
  const auto law = CalcCurveLaw(kind, curve);
  if (!law && problem != nullptr) {
    *problem = "must fall: one design point with flow and head > 0, or heads that fall as the flow rises";
  }
  return law;
}

}  // namespace piperun::sim
