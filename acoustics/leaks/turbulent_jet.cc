#include "acoustics/jet_sound.h"

namespace piperun::acoustics::leaks::turbulent_jet {
namespace {

struct TurbulentJetParams : ParamsOf<TurbulentJetParams> {
  JetParams jet{};

  void Visit(ParamVisitor& v) override { jet.Visit(v); }
};

/// Noise of the turbulent jet through the hole, without cavitation, whistling and the higher modes above
/// cut-on.
std::unique_ptr<LeakSound> Make(const Params& params, double hole_diameter_m, const LeakState& state,
                                double water_density_kg_m3) {
  const auto& p = dynamic_cast<const TurbulentJetParams&>(params);
  return std::make_unique<JetSound>(JetSpectrum(p.jet, hole_diameter_m, state, water_density_kg_m3));
}

}  // namespace

LeakSoundKind Kind() {
  return {"turbulent_jet",
          "broadband noise of the jet; level and corner frequency from flow, pressure drop and hole",
          MakeParams<TurbulentJetParams>, Make};
}

}  // namespace piperun::acoustics::leaks::turbulent_jet
