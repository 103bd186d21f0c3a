#include "acoustics/ambient.h"

#include <cmath>

#include "acoustics/level.h"

namespace piperun::acoustics {

void AmbientParams::Visit(ParamVisitor& v) {
  v.Number({.name = "distant_level_dB_re_1uPa2_Hz",
            .doc = "spectral level at 100 Hz of the noise that reaches the ball along the pipe from afar"},
           Range::Between(-200, 200), distant_level_dB_re_1uPa2_Hz);
  v.Number({.name = "distant_slope_dB_per_decade", .doc = "how that level changes per decade of frequency"},
           Range::Between(-100, 100), distant_slope_dB_per_decade);
  v.Flag({.name = "flow_noise", .doc = "turbulent wall pressure at the ball's slip speed"}, flow_noise);
}

double CalcDistantNoisePsd(const AmbientParams& ambient, double f_Hz) {
  const double decades = std::log10(f_Hz / 100);
  return CalcPressureSquared(ambient.distant_level_dB_re_1uPa2_Hz +
                             ambient.distant_slope_dB_per_decade * decades);
}

}  // namespace piperun::acoustics
