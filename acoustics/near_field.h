#pragma once

#include "acoustics/pipe_wave.h"

namespace piperun::acoustics {

/// What the evanescent modes beside a hole add to the plane wave, on the axis of the pipe at a distance z
/// along it: |p|^2 = |p_plane|^2 (1 + n),
///
///   n = (k a^2 / R)^2 exp(-(z / (0.15 D))^2),  R^2 = a^2 + z^2,  k = 2 pi f / c_f,
///
/// a fit to the sum of 3,394 modes of a rigid pipe that holds a monopole in its wall, within 2.1 dB for f up
/// to 0.43 of the first cut-on. Above that n is held at what it is there, and higher_modes.h adds to it.
double CalcNearField(const PipeWave& wave, double z_m, double f_Hz);

/// How n falls with z: n(z) / n(0).
double CalcNearFieldFading(double bore_radius_m, double z_m);

}  // namespace piperun::acoustics
