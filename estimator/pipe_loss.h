#pragma once

#include "base/network.h"

namespace piperun::estimator {

/// Attenuation of sound in a water-filled pipe, from what the map says of its wall, in dB per metre at f:
///
///     X = 2 B a / (E h),  c = c_f / sqrt(1 + X),  a_dB = (20 / ln 10) (omega / c) eta X / (2 (1 + X))
///
/// with B = rho c_f^2 the water's bulk modulus, a the wall's mean radius, h its thickness, E its Young's
/// modulus and eta its loss factor (Korteweg's wave with a lossy wall; the water's own viscosity, below 2 %
/// of this in plastic, is left out). Water at 10 C. Range: below a tenth of the pipe's ring frequency within
/// 6 %.
double CalcAttenuation_dB_m(const Pipe& pipe, double f_Hz);

}  // namespace piperun::estimator
