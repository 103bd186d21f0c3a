#include <cmath>
#include <numbers>

#include "acoustics/jet_sound.h"
#include "acoustics/sound.h"

namespace piperun::acoustics::sounds::throttled_valve {
namespace {

struct ThrottledValveParams : ParamsOf<ThrottledValveParams> {
  double pressure_drop_Pa = 1e5;
  std::optional<double> flow_m3_s;  ///< nothing: the pipe's
  JetParams jet{};

  void Visit(ParamVisitor& v) override {
    v.Number({.name = "pressure_drop_Pa", .doc = "lost in the valve; the hydraulics do not know of it"},
             {.min = 0, .max = 1e7, .min_open = true}, pressure_drop_Pa);
    v.NumberOr({.name = "flow_m3_s", .doc = "through the valve, which may stand on a branch beside the pipe"},
               {.min = 0, .max = 10, .min_open = true}, "of_pipe", flow_m3_s);
    jet.Visit(v);
  }
};

/// A valve that is nearly shut: the jet of acoustics/jet.h with flow Q and drop dP through the opening that
/// passes just that, d = (4 Q / (pi U))^(1/2), U = (2 dP / rho)^(1/2). Its noise is taken to enter the pipe
/// as volume velocity, as a leak's does, and the valve to let sound pass; of an in-line throttle, whose drop
/// drives the two sides against each other, that is the order of magnitude only (15 dB).
SiteSound Make(const Params& params, const SoundSite& site) {
  const auto& p = dynamic_cast<const ThrottledValveParams&>(params);
  const LeakState state{p.flow_m3_s.value_or(site.flow_m3_s), p.pressure_drop_Pa};
  if (!IsFlowing(state)) return {};
  const double density_kg_m3 = site.water.density_kg_m3;
  const double area_m2 = state.flow_m3_s / CalcJetSpeed_m_s(state.pressure_drop_Pa, density_kg_m3);
  const JetSpectrum jet(p.jet, std::sqrt(4 * area_m2 / std::numbers::pi), state, density_kg_m3);
  return {.noise = std::make_shared<JetSound>(jet), .role = Role::kValve};
}

}  // namespace

SoundKind Kind() {
  return {"throttled_valve",
          "jet of a valve that is nearly shut; level and corner from flow and pressure drop",
          MakeParams<ThrottledValveParams>, Make};
}

}  // namespace piperun::acoustics::sounds::throttled_valve
