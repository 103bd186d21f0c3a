#include "acoustics/sound.h"

namespace piperun::acoustics::sounds::pump {
namespace {

struct PumpParams : ParamsOf<PumpParams> {
  std::int64_t blades = 6;
  double speed_rpm = 1480;
  double level_dB_re_1uPa = 120;
  double harmonic_step_dB = -6;
  std::int64_t harmonics = 8;

  void Visit(ParamVisitor& v) override {
    v.Integer({.name = "blades", .doc = "of the impeller (Z)"}, 1, 100, blades);
    v.Number({.name = "speed_rpm", .doc = "speed of the shaft (n)"}, {.min = 0, .max = 1e5, .min_open = true},
             speed_rpm);
    v.Number({.name = "level_dB_re_1uPa", .doc = "rms of the first tone, in the water beside the pump"},
             Range::Between(0, 200), level_dB_re_1uPa);
    v.Number({.name = "harmonic_step_dB", .doc = "level of each tone over the one below"},
             Range::Between(-60, 0), harmonic_step_dB);
    v.Integer({.name = "harmonics", .doc = "how many tones there are, the first included"}, 1, 100,
              harmonics);
  }
};

/// Blades that pass the cutwater: tones m Z n / 60, m = 1, 2, ... (148 Hz for 6 blades at 1480 / min), each
/// 6 dB below the last. 110 to 130 dB re 1 uPa near a station is an engineering value.
SiteSound Make(const Params& params, const SoundSite& site) {
  const auto& p = dynamic_cast<const PumpParams&>(params);
  const HarmonicSeries series{static_cast<double>(p.blades) * p.speed_rpm / 60, static_cast<int>(p.harmonics),
                              p.level_dB_re_1uPa, p.harmonic_step_dB};
  SiteSound sound;
  sound.tones = CalcHarmonics(series, site.wave.impedance_Pa_s_m3);
  return sound;
}

}  // namespace

SoundKind Kind() {
  return {"pump", "tones of a pump's blades, and their harmonics", MakeParams<PumpParams>, Make};
}

}  // namespace piperun::acoustics::sounds::pump
