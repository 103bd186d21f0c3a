#include <cmath>
#include <numbers>

#include "acoustics/jet.h"
#include "acoustics/source.h"

namespace piperun::acoustics::leaks::cavitating_jet {
namespace {

constexpr double kRayleigh = 0.9147;  // collapse time over R sqrt(rho / p), Phil. Mag. 34, 94 (1917)

struct CavitatingJetParams : ParamsOf<CavitatingJetParams> {
  JetParams jet{};
  double outside_pressure_Pa = 108200;
  double vapour_pressure_Pa = 1228;
  double inception_number = 0.6;
  double cavity_radius_m = 1e-4;
  double cavitation_fluctuation = 2e-3;

  void Visit(ParamVisitor& v) override {
    jet.Visit(v);
    v.Number(
        {.name = "outside_pressure_Pa",
         .doc = "absolute pressure where the jet ends: the default is air and 0.7 m of water in the soil"},
        Range::Between(1e4, 1e7), outside_pressure_Pa);
    v.Number({.name = "vapour_pressure_Pa", .doc = "of the water: 1228 at 10 C, 2339 at 20 C"},
             Range::Between(0, 1e4), vapour_pressure_Pa);
    v.Number({.name = "inception_number", .doc = "cavitation number below which the jet cavitates"},
             Range::Between(0.01, 10), inception_number);
    v.Number(
        {.name = "cavity_radius_m", .doc = "largest radius of a cavity; sets the corner of its collapse"},
        Range::Between(1e-6, 1e-2), cavity_radius_m);
    v.Number({.name = "cavitation_fluctuation",
              .doc = "rms volume-velocity fluctuation by cavities over the flow, far below inception"},
             Range::Between(0, 1), cavitation_fluctuation);
  }
};

/// A jet with cavities that collapse where it ends. Let sigma = (p_out - p_v) / dP (1.07, 0.36, 0.21 at 1, 3,
/// 5 bar into wet soil). Below the inception number sigma_i, collapses add to the jet's spectrum
///   S_c(f) = (eps_c Q (1 - sigma/sigma_i))^2 (2 / (pi f_c)) / (1 + (f/f_c)^2),   f_c = 1 / (2 pi tau),
///   tau = 0.915 R sqrt(rho / (p_out - p_v)),
/// the spectrum of independent pulses that last Rayleigh's collapse time: flat to f_c, 18 kHz by default,
/// within 1.2 dB up to 10 kHz. It is rendered as Gaussian noise, the limit of many collapses per
/// millisecond; single clicks near inception are not modelled.
/// Calibrated on nothing: no level of a cavitating leak is published. sigma_i (0.2 to 1 and above for
/// submerged jets, depending on edge and gas) and eps_c are engineering values, levels hold within 15 dB.
/// Holes of 1-4 mm in plastic were found not to cavitate (Papastefanou, Joseph & Brennan, Acta Acustica 98,
/// 847, 2012): an option for high pressures, not a default.
class CavitatingJet : public LeakSound {
 public:
  CavitatingJet(const CavitatingJetParams& p, double hole_diameter_m, const LeakState& state,
                double water_density_kg_m3)
      : jet_(p.jet, hole_diameter_m, state, water_density_kg_m3) {
    if (!IsFlowing(state)) return;
    const double excess_Pa = p.outside_pressure_Pa - p.vapour_pressure_Pa;
    const double sigma = excess_Pa / state.pressure_drop_Pa;
    if (sigma >= p.inception_number) return;
    const double collapse_s = kRayleigh * p.cavity_radius_m * std::sqrt(water_density_kg_m3 / excess_Pa);
    corner_Hz_ = 1 / (2 * std::numbers::pi * collapse_s);
    const double q_rms_m3_s = p.cavitation_fluctuation * state.flow_m3_s * (1 - sigma / p.inception_number);
    plateau_ = q_rms_m3_s * q_rms_m3_s * 2 / (std::numbers::pi * corner_Hz_);
  }

  double VolumeVelocityPsd(double f_Hz) const override {
    const double x = f_Hz / corner_Hz_;
    return jet_(f_Hz) + plateau_ / (1 + x * x);
  }

 private:
  JetSpectrum jet_;
  double corner_Hz_ = 1;
  double plateau_ = 0;  // (m3/s)^2/Hz; zero: above inception
};

std::unique_ptr<LeakSound> Make(const Params& params, double hole_diameter_m, const LeakState& state,
                                double water_density_kg_m3) {
  return std::make_unique<CavitatingJet>(dynamic_cast<const CavitatingJetParams&>(params), hole_diameter_m,
                                         state, water_density_kg_m3);
}

}  // namespace

LeakSoundKind Kind() {
  return {"cavitating_jet", "turbulent jet that, below a cavitation number, also hisses flat to above 10 kHz",
          MakeParams<CavitatingJetParams>, Make};
}

}  // namespace piperun::acoustics::leaks::cavitating_jet
