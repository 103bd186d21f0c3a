#pragma once

#include "base/params.h"

namespace piperun::acoustics {

/// What the hydrophone hears besides leaks.
struct AmbientParams {
  double distant_level_dB_re_1uPa2_Hz = 80;    ///< distant, duct-borne noise at 100 Hz
  double distant_slope_dB_per_decade = -25;
  bool flow_noise = true;                      ///< turbulent wall pressure at the ball's slip speed (Goody 2004)

  void Visit(ParamVisitor& v);
};

}  // namespace piperun::acoustics
