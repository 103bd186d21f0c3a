#include <numbers>

#include "acoustics/jet_sound.h"
#include "acoustics/sound.h"
#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics::sounds::draw_off {
namespace {

struct DrawOffParams : ParamsOf<DrawOffParams> {
  double flow_m3_s = 1e-4;
  double opening_diameter_m = 0.005;
  JetParams jet{};

  void Visit(ParamVisitor& v) override {
    v.Number({.name = "flow_m3_s", .doc = "water drawn; it sounds, the hydraulics do not know of it"},
             {.min = 0, .max = 1, .min_open = true}, flow_m3_s);
    v.Number(
        {.name = "opening_diameter_m", .doc = "of a circle with the area of the tap's narrowest opening"},
        {.min = 0, .max = 1, .min_open = true}, opening_diameter_m);
    jet.Visit(v);
  }
};

/// More than the pressure drives through the opening without any loss, A (2 dP / rho)^(1/2), cannot be drawn.
void RequirePossible(const DrawOffParams& p, const SoundSite& site) {
  const double area_m2 = std::numbers::pi / 4 * p.opening_diameter_m * p.opening_diameter_m;
  const double most_m3_s = area_m2 * CalcJetSpeed_m_s(site.gauge_pressure_Pa, site.water.density_kg_m3);
  if (p.flow_m3_s <= most_m3_s) return;
  throw InputError(FormatNumber(p.flow_m3_s) + " is not allowed; through this opening " +
                       FormatDigits(site.gauge_pressure_Pa, 4) + " Pa drive at most " +
                       FormatDigits(most_m3_s, 4) + " m3/s: draw less or widen opening_diameter_m",
                   "flow_m3_s");
}

/// A tap, hydrant or service that draws water: the jet of acoustics/jet.h with the flow and the opening given
/// and the pipe's pressure, all of it lost in the opening. The service line between main and tap is left out.
/// As uncertain as a leak's level, 15 dB either way: it is the false alarm a leak detector has to live with.
SiteSound Make(const Params& params, const SoundSite& site) {
  const auto& p = dynamic_cast<const DrawOffParams&>(params);
  if (!(site.gauge_pressure_Pa > 0)) return {};
  RequirePossible(p, site);
  const JetSpectrum jet(p.jet, p.opening_diameter_m, {p.flow_m3_s, site.gauge_pressure_Pa},
                        site.water.density_kg_m3);
  return {.noise = std::make_shared<JetSound>(jet), .role = Role::kDrawOff};
}

}  // namespace

SoundKind Kind() {
  return {"draw_off", "water drawn through a tap: the jet of its opening under the pipe's pressure",
          MakeParams<DrawOffParams>, Make};
}

}  // namespace piperun::acoustics::sounds::draw_off
