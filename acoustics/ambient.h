#pragma once

#include "base/params.h"

namespace piperun::acoustics {

/// How a blow on the ball sounds (acoustics/impact.h). The ring is an engineering value, right in order of
/// magnitude: a rigid 60 mm ball that crosses a joint at 0.5 m/s takes some 0.02 N s, and joints are heard 8
/// (+- 3) dB over the default distant noise between 1 and 4 kHz for 50 to 100 ms (facts of the trade, no
/// calibrated record). 20 Pa/(N s) makes that of 0.02 N s within 1 ms.
struct ImpactParams {
  bool on = true;
  double contact_time_s = 0.001;  ///< of a rigid blow (Hertz): hard plastic 1 ms, steel on steel 0.2 ms
  double ring_Pa_per_N_s = 20;    ///< rms pressure at the beginning of the ring over the impulse of the blow
  double ring_low_Hz = 1000;      ///< the ring's band
  double ring_high_Hz = 4000;
  double ring_decay_s = 0.075;  ///< in which the ring falls by 20 dB

  /// Throws InputError unless ring_low_Hz < ring_high_Hz.
  void Check() const;
  void Visit(ParamVisitor& v);
};

/// Band noise of a hard ball that rolls or slides along the wall (acoustics/rolling.h). Engineering values:
/// no record of a bare ball is published; vendors coat the ball with foam because of it.
struct RollingParams {
  bool on = false;
  double level_dB_re_1uPa2_Hz = 75;  ///< in the band, at 1 m/s
  double low_Hz = 200;               ///< the band's half-power ends
  double high_Hz = 2000;

  /// Throws InputError unless low_Hz < high_Hz.
  void Check() const;
  void Visit(ParamVisitor& v);
};

/// What the hydrophone hears besides leaks. Engineering defaults, uncertain by 15 dB: no calibrated record
/// from inside a main is published. The slope is anchored by -25.6 dB/decade (100-1000 Hz) in leak-free
/// records of a 152 mm PVC rig.
struct AmbientParams {
  double distant_level_dB_re_1uPa2_Hz = 80;  ///< distant, duct-borne noise at 100 Hz
  double distant_slope_dB_per_decade = -25;
  bool flow_noise = true;  ///< turbulent wall pressure at the ball's slip speed (Goody 2004)
  ImpactParams impacts{};
  RollingParams rolling{};

  void Visit(ParamVisitor& v);
};

/// S(f) = 10^((L + m log10(f / 100 Hz)) / 10) uPa^2/Hz, L the level at 100 Hz, m the slope; one-sided, in
/// Pa^2/Hz, the same everywhere in the network. Range f > 0.
double CalcDistantNoisePsd(const AmbientParams& ambient, double f_Hz);

}  // namespace piperun::acoustics
