#include <cmath>

#include "acoustics/source.h"
#include "base/check.h"

namespace piperun::acoustics::leaks::turbulent_jet {
namespace {

constexpr double kLitrePerMinute_m3_s = 1e-3 / 60;
constexpr double kReferenceDrop_Pa = 3e5;
/// Integral of (1 + x^2)^(-5/4) over x > 0: sqrt(pi)/2 Gamma(3/4)/Gamma(5/4).
constexpr double kShapeIntegral = 1.198140234735592;

struct TurbulentJetParams : ParamsOf<TurbulentJetParams> {
  double relative_fluctuation = 2e-3;
  double flow_exponent = 0;
  double pressure_exponent = 0;
  double strouhal = 0.15;

  void Visit(ParamVisitor& v) override {
    v.Number({.name = "relative_fluctuation",
              .doc = "rms volume-velocity fluctuation over the leak's flow, at 1 L/min and 3 bar (eps0)"},
             Range::Between(0, 1), relative_fluctuation);
    v.Number(
        {.name = "flow_exponent", .doc = "growth of the relative fluctuation with flow over 1 L/min (a)"},
        Range::Between(-3, 3), flow_exponent);
    v.Number({.name = "pressure_exponent",
              .doc = "growth of the relative fluctuation with pressure drop over 3 bar (b)"},
             Range::Between(-3, 3), pressure_exponent);
    v.Number({.name = "strouhal", .doc = "corner frequency times hole diameter over jet speed (St)"},
             Range::Positive(), strouhal);
  }
};

/// Noise of the turbulent jet through the hole:
///   S_q(f) = (eps Q)^2 g(f),  g(f) = (1 + (f/fc)^2)^(-5/4) / (1.198 fc),  integral of g = 1,
///   fc = St U / d,  U = sqrt(2 dP / rho),  eps = eps0 (dP / 3 bar)^b (Q / 1 L/min)^a.
/// An engineering model: the corner agrees in order with the 1-4 kHz of small holes in a petrol line (Eckert
/// & Maresca, EPA/600/A-93/095), the tail of -25 dB/decade with hydrophone records of a 152 mm PVC rig
/// (-20 to -24 dB/decade, 0.5-3 kHz). No calibrated in-pipe source level of a water leak is published: eps0
/// is uncertain by 15 dB either way. a = -0.5, b = 1.25 gives the dipole-like p^2 ~ Q dP^2.5.
/// Cavitation, whistling and the higher modes above cut-on are not in it.
class TurbulentJet : public LeakSound {
 public:
  TurbulentJet(const TurbulentJetParams& p, double hole_diameter_m, const LeakState& state,
               double water_density_kg_m3) {
    if (!(state.flow_m3_s > 0 && state.pressure_drop_Pa > 0)) return;
    const double jet_speed_m_s = std::sqrt(2 * state.pressure_drop_Pa / water_density_kg_m3);
    corner_Hz_ = p.strouhal * jet_speed_m_s / hole_diameter_m;
    const double eps = p.relative_fluctuation *
                       std::pow(state.pressure_drop_Pa / kReferenceDrop_Pa, p.pressure_exponent) *
                       std::pow(state.flow_m3_s / kLitrePerMinute_m3_s, p.flow_exponent);
    const double q_rms_m3_s = eps * state.flow_m3_s;
    plateau_ = q_rms_m3_s * q_rms_m3_s / (kShapeIntegral * corner_Hz_);
  }

  double VolumeVelocityPsd(double f_Hz) const override {
    const double x = f_Hz / corner_Hz_;
    const double y = 1 + x * x;
    return plateau_ / (y * std::sqrt(std::sqrt(y)));
  }

 private:
  double corner_Hz_ = 1;
  double plateau_ = 0;  // (m3/s)^2/Hz; zero: silent
};

std::unique_ptr<LeakSound> Make(const Params& params, double hole_diameter_m, const LeakState& state,
                                double water_density_kg_m3) {
  Demand(hole_diameter_m > 0 && water_density_kg_m3 > 0, "a leak has a hole and water to run through it");
  return std::make_unique<TurbulentJet>(dynamic_cast<const TurbulentJetParams&>(params), hole_diameter_m,
                                        state, water_density_kg_m3);
}

}  // namespace

LeakSoundKind Kind() {
  return {"turbulent_jet",
          "broadband noise of the jet; level and corner frequency from flow, pressure drop and hole",
          MakeParams<TurbulentJetParams>, Make};
}

}  // namespace piperun::acoustics::leaks::turbulent_jet
