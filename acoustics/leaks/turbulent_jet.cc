#include "acoustics/jet.h"
#include "acoustics/source.h"

namespace piperun::acoustics::leaks::turbulent_jet {
namespace {

struct TurbulentJetParams : ParamsOf<TurbulentJetParams> {
  JetParams jet{};

  void Visit(ParamVisitor& v) override { jet.Visit(v); }
};

/// Noise of the turbulent jet through the hole (acoustics/jet.h), without cavitation, whistling and the
/// higher modes above cut-on.
class TurbulentJet : public LeakSound {
 public:
  explicit TurbulentJet(const JetSpectrum& jet) : jet_(jet) {}

  double VolumeVelocityPsd(double f_Hz) const override { return jet_(f_Hz); }

 private:
  JetSpectrum jet_;
};

std::unique_ptr<LeakSound> Make(const Params& params, double hole_diameter_m, const LeakState& state,
                                double water_density_kg_m3) {
  const auto& p = dynamic_cast<const TurbulentJetParams&>(params);
  return std::make_unique<TurbulentJet>(JetSpectrum(p.jet, hole_diameter_m, state, water_density_kg_m3));
}

}  // namespace

LeakSoundKind Kind() {
  return {"turbulent_jet",
          "broadband noise of the jet; level and corner frequency from flow, pressure drop and hole",
          MakeParams<TurbulentJetParams>, Make};
}

}  // namespace piperun::acoustics::leaks::turbulent_jet
