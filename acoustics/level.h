#pragma once

#include <cmath>

namespace piperun::acoustics {

/// Level to squared pressure: 1e-12 * 10^(L/10). A spectral level in dB re 1 uPa^2/Hz gives Pa^2/Hz, a
/// broadband level in dB re 1 uPa gives Pa^2.
inline double CalcPressureSquared(double level_dB) { return 1e-12 * std::pow(10.0, level_dB / 10); }

/// Inverse of CalcPressureSquared; minus infinity for zero.
inline double CalcLevel_dB(double pressure_squared) { return 10 * std::log10(pressure_squared * 1e12); }

}  // namespace piperun::acoustics
