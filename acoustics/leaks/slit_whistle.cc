#include <cmath>
#include <numbers>

#include "acoustics/jet.h"
#include "acoustics/source.h"

namespace piperun::acoustics::leaks::slit_whistle {
namespace {

struct SlitWhistleParams : ParamsOf<SlitWhistleParams> {
  JetParams jet{};
  double edge_length_m = 4e-3;
  double whistle_strouhal = 0.25;
  double bandwidth_Hz = 100;
  double whistle_fluctuation = 2e-3;
  std::int64_t harmonics = 3;
  double harmonic_step_dB = -10;

  void Visit(ParamVisitor& v) override {
    jet.Visit(v);
    v.Number({.name = "edge_length_m", .doc = "way of the jet along the slit's walls, from edge to edge"},
             Range::Between(1e-4, 0.1), edge_length_m);
    v.Number({.name = "whistle_strouhal", .doc = "frequency of the whistle times edge length over jet speed"},
             Range::Between(0.05, 2), whistle_strouhal);
    v.Number({.name = "bandwidth_Hz", .doc = "of each line, between its half-power points"},
             Range::Between(50, 5000), bandwidth_Hz);
    v.Number({.name = "whistle_fluctuation",
              .doc = "rms volume-velocity fluctuation of the first line over the leak's flow"},
             Range::Between(0, 1), whistle_fluctuation);
    v.Integer({.name = "harmonics", .doc = "how many lines there are, the first included"}, 1, 20, harmonics);
    v.Number({.name = "harmonic_step_dB", .doc = "level of each line over the one below"},
             Range::Between(-60, 0), harmonic_step_dB);
  }
};

/// A slit whose two edges feed the jet's instability back to itself: narrow bands over the jet's noise,
///   S_w(f) = sum over n of (eps_w Q)^2 10^((n-1) step/10) N(f; n f_0, s),   f_0 = St_t U / t,
/// N the normal density, its half-power width 2 (2 ln 2)^(1/2) s = `bandwidth_Hz`. Orifices whistle for St_t
/// = f t / U of 0.2 to 0.4, t their thickness (Moussou, Testud, Auregan & Hirschberg, PVP2007-26157; from
/// memory). Turbulence of the jet widens the line, which has neither a steady phase nor a lock-in to echoes
/// of the pipe: a narrow-band noise. The width is at least 50 Hz, three bins of the frames it is rendered in.
/// Calibrated on nothing else: no level of a whistling leak is published, eps_w is an engineering value and
/// holds within 15 dB.
class SlitWhistle : public LeakSound {
 public:
  SlitWhistle(const SlitWhistleParams& p, double hole_diameter_m, const LeakState& state,
              double water_density_kg_m3)
      : jet_(p.jet, hole_diameter_m, state, water_density_kg_m3),
        deviation_Hz_(p.bandwidth_Hz / (2 * std::sqrt(2 * std::numbers::ln2))) {
    if (!IsFlowing(state)) return;
    first_Hz_ =
        p.whistle_strouhal * CalcJetSpeed_m_s(state.pressure_drop_Pa, water_density_kg_m3) / p.edge_length_m;
    const double q_rms_m3_s = p.whistle_fluctuation * state.flow_m3_s;
    const double step = std::pow(10.0, p.harmonic_step_dB / 10);
    double power = q_rms_m3_s * q_rms_m3_s;
    for (std::int64_t n = 0; n < p.harmonics; ++n, power *= step) powers_.push_back(power);
  }

  double VolumeVelocityPsd(double f_Hz) const override {
    double psd = jet_(f_Hz);
    for (std::size_t n = 0; n < powers_.size(); ++n) {
      psd += powers_[n] * Line(f_Hz - static_cast<double>(n + 1) * first_Hz_);
    }
    return psd;
  }

 private:
  double Line(double distance_Hz) const {
    const double x = distance_Hz / deviation_Hz_;
    return std::exp(-0.5 * x * x) / (deviation_Hz_ * std::sqrt(2 * std::numbers::pi));
  }

  JetSpectrum jet_;
  double deviation_Hz_;
  double first_Hz_ = 0;
  std::vector<double> powers_;  // (m3/s)^2 of the lines; none: silent
};

std::unique_ptr<LeakSound> Make(const Params& params, double hole_diameter_m, const LeakState& state,
                                double water_density_kg_m3) {
  return std::make_unique<SlitWhistle>(dynamic_cast<const SlitWhistleParams&>(params), hole_diameter_m, state,
                                       water_density_kg_m3);
}

}  // namespace

LeakSoundKind Kind() {
  return {"slit_whistle", "turbulent jet with the narrow bands of a whistling slit and their harmonics",
          MakeParams<SlitWhistleParams>, Make};
}

}  // namespace piperun::acoustics::leaks::slit_whistle
