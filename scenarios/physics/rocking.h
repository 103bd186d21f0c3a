#pragma once

namespace piperun::scenarios::physics {

/// The reference ball rolling to and fro across its pipe, let go at an angle.
struct Rocking {
  double period_s = 0;            ///< mean over the whole time
  double last_amplitude_rad = 0;  ///< of the last swing
  double end_rad = 0;             ///< where it is at the end
};

Rocking RockFor(double seconds, double amplitude_rad, double rate_Hz, double rolling_length_m);

/// (2 pi/w0) / AGM(1, cos(a/2)), w0^2 = W / ((m + m_a + I/r^2)(R - r)); AGM: arithmetic-geometric mean.
double CalcRockingPeriod_s(double amplitude_rad);

}  // namespace piperun::scenarios::physics
