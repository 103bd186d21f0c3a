#include "acoustics/ambient.h"

#include <cmath>

#include "acoustics/level.h"
#include "base/check.h"
#include "base/number.h"

namespace piperun::acoustics {

void ImpactParams::Check() const {
  if (ring_low_Hz < ring_high_Hz) return;
  throw InputError(FormatNumber(ring_high_Hz) + " is not allowed; it must be above ring_low_Hz, " +
                       FormatNumber(ring_low_Hz),
                   "ring_high_Hz");
}

void ImpactParams::Visit(ParamVisitor& v) {
  v.Flag({.name = "on", .doc = "blows on the ball are heard"}, on);
  v.Number({.name = "contact_time_s", .doc = "how long a rigid ball and the wall touch in a blow"},
           Range::Between(1e-5, 0.1), contact_time_s);
  v.Number({.name = "ring_Pa_per_N_s",
            .doc = "rms pressure at the beginning of the ring of pipe and shell, over the impulse of a blow "
                   "that is short against the ring's periods"},
           Range::NonNegative(), ring_Pa_per_N_s);
  v.Number({.name = "ring_low_Hz", .doc = "lower end of the ring's band"}, Range::Between(1, 1e6),
           ring_low_Hz);
  v.Number({.name = "ring_high_Hz", .doc = "upper end of the ring's band"}, Range::Between(1, 1e6),
           ring_high_Hz);
  v.Number({.name = "ring_decay_s", .doc = "time in which the ring falls by 20 dB"}, Range::Between(1e-4, 10),
           ring_decay_s);
}

void RollingParams::Check() const {
  if (low_Hz < high_Hz) return;
  throw InputError(
      FormatNumber(high_Hz) + " is not allowed; it must be above low_Hz, " + FormatNumber(low_Hz), "high_Hz");
}

void RollingParams::Visit(ParamVisitor& v) {
  v.Flag({.name = "on", .doc = "a rigid ball that rolls or slides along the wall is heard"}, on);
  v.Number({.name = "level_dB_re_1uPa2_Hz",
            .doc = "spectral level in the band at 1 m/s; it goes with 30 log10 of the speed"},
           Range::Between(-200, 200), level_dB_re_1uPa2_Hz);
  v.Number({.name = "low_Hz", .doc = "lower half-power end of the band"}, Range::Between(1, 1e6), low_Hz);
  v.Number({.name = "high_Hz", .doc = "upper half-power end of the band"}, Range::Between(1, 1e6), high_Hz);
}

void AmbientParams::Visit(ParamVisitor& v) {
  v.Number({.name = "distant_level_dB_re_1uPa2_Hz",
            .doc = "spectral level at 100 Hz of the noise that reaches the ball along the pipe from afar"},
           Range::Between(-200, 200), distant_level_dB_re_1uPa2_Hz);
  v.Number({.name = "distant_slope_dB_per_decade", .doc = "how that level changes per decade of frequency"},
           Range::Between(-100, 100), distant_slope_dB_per_decade);
  v.Flag({.name = "flow_noise", .doc = "turbulent wall pressure at the ball's slip speed"}, flow_noise);
  v.Struct({.name = "impacts", .doc = "how a blow on the ball sounds"}, impacts);
  v.Struct({.name = "rolling", .doc = "how a ball sounds that rolls or slides along the wall"}, rolling);
}

double CalcDistantNoisePsd(const AmbientParams& ambient, double f_Hz) {
  const double decades = std::log10(f_Hz / 100);
  return CalcPressureSquared(ambient.distant_level_dB_re_1uPa2_Hz +
                             ambient.distant_slope_dB_per_decade * decades);
}

}  // namespace piperun::acoustics
