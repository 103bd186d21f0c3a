#include "acoustics/sound.h"

namespace piperun::acoustics::sounds::mains_hum {
namespace {

struct MainsHumParams : ParamsOf<MainsHumParams> {
  double mains_Hz = 50;
  double level_dB_re_1uPa = 110;
  double harmonic_step_dB = -6;
  std::int64_t harmonics = 4;

  void Visit(ParamVisitor& v) override {
    v.Number({.name = "mains_Hz", .doc = "frequency of the supply"}, Range::Between(10, 1000), mains_Hz);
    v.Number({.name = "level_dB_re_1uPa", .doc = "rms of the first tone, in the water beside the machine"},
             Range::Between(0, 200), level_dB_re_1uPa);
    v.Number({.name = "harmonic_step_dB", .doc = "level of each tone over the one below"},
             Range::Between(-60, 0), harmonic_step_dB);
    v.Integer({.name = "harmonics", .doc = "how many tones there are, the first included"}, 1, 100,
              harmonics);
  }
};

/// The magnetic hum of motors and transformers that stand on the pipe: tones at multiples of the mains'
/// frequency. Engineering values. What the supply couples into an amplifier by wire is not sound and not
/// here.
SiteSound Make(const Params& params, const SoundSite& site) {
  const auto& p = dynamic_cast<const MainsHumParams&>(params);
  SiteSound sound;
  sound.tones =
      CalcHarmonics({p.mains_Hz, static_cast<int>(p.harmonics), p.level_dB_re_1uPa, p.harmonic_step_dB},
                    site.wave.impedance_Pa_s_m3);
  return sound;
}

}  // namespace

SoundKind Kind() {
  return {"mains_hum", "hum of a motor or transformer at the mains' frequency and its multiples",
          MakeParams<MainsHumParams>, Make};
}

}  // namespace piperun::acoustics::sounds::mains_hum
