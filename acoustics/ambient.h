#pragma once

#include "base/params.h"

namespace piperun::acoustics {

/// What the hydrophone hears besides leaks. Engineering defaults, uncertain by 15 dB: no calibrated record
/// from inside a main is published. The slope is anchored by -25.6 dB/decade (100-1000 Hz) in leak-free
/// records of a 152 mm PVC rig.
struct AmbientParams {
  double distant_level_dB_re_1uPa2_Hz = 80;  ///< distant, duct-borne noise at 100 Hz
  double distant_slope_dB_per_decade = -25;
  bool flow_noise = true;  ///< turbulent wall pressure at the ball's slip speed (Goody 2004)

  void Visit(ParamVisitor& v);
};

/// S(f) = 10^((L + m log10(f / 100 Hz)) / 10) uPa^2/Hz, L the level at 100 Hz, m the slope; one-sided, in
/// Pa^2/Hz, the same everywhere in the network. Range f > 0.
double CalcDistantNoisePsd(const AmbientParams& ambient, double f_Hz);

}  // namespace piperun::acoustics
