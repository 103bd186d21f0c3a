#include "acoustics/jet.h"

#include <cmath>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

constexpr double kLitrePerMinute_m3_s = 1e-3 / 60;
constexpr double kReferenceDrop_Pa = 3e5;
/// Integral of (1 + x^2)^(-5/4) over x > 0: sqrt(pi)/2 Gamma(3/4)/Gamma(5/4).
constexpr double kShapeIntegral = 1.198140234735592;

}  // namespace

void JetParams::Visit(ParamVisitor& v) {
  v.Number({.name = "relative_fluctuation",
            .doc = "rms volume-velocity fluctuation over the leak's flow, at 1 L/min and 3 bar (eps0)"},
           Range::Between(0, 1), relative_fluctuation);
  v.Number({.name = "flow_exponent", .doc = "growth of the relative fluctuation with flow over 1 L/min (a)"},
           Range::Between(-3, 3), flow_exponent);
  v.Number({.name = "pressure_exponent",
            .doc = "growth of the relative fluctuation with pressure drop over 3 bar (b)"},
           Range::Between(-3, 3), pressure_exponent);
  v.Number({.name = "strouhal", .doc = "corner frequency times hole diameter over jet speed (St)"},
           Range::Positive(), strouhal);
}

double CalcJetSpeed_m_s(double pressure_drop_Pa, double water_density_kg_m3) {
  return std::sqrt(2 * pressure_drop_Pa / water_density_kg_m3);
}

JetSpectrum::JetSpectrum(const JetParams& p, double hole_diameter_m, const LeakState& state,
                         double water_density_kg_m3) {
  Demand(hole_diameter_m > 0 && water_density_kg_m3 > 0, "a leak has a hole and water to run through it");
  if (!IsFlowing(state)) return;
  corner_Hz_ = p.strouhal * CalcJetSpeed_m_s(state.pressure_drop_Pa, water_density_kg_m3) / hole_diameter_m;
  const double eps = p.relative_fluctuation *
                     std::pow(state.pressure_drop_Pa / kReferenceDrop_Pa, p.pressure_exponent) *
                     std::pow(state.flow_m3_s / kLitrePerMinute_m3_s, p.flow_exponent);
  const double q_rms_m3_s = eps * state.flow_m3_s;
  plateau_ = q_rms_m3_s * q_rms_m3_s / (kShapeIntegral * corner_Hz_);
}

double JetSpectrum::operator()(double f_Hz) const {
  const double x = f_Hz / corner_Hz_;
  const double y = 1 + x * x;
  return plateau_ / (y * std::sqrt(std::sqrt(y)));
}

}  // namespace piperun::acoustics
