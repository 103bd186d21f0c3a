#pragma once

#include "acoustics/ambient.h"

namespace piperun::acoustics {

/// Noise that a rigid ball makes as it rolls or slides along the wall at speed v, one-sided, in Pa^2/Hz:
///
///   S(f) = 10^(L/10) uPa^2/Hz (v / 1 m/s)^3 B(f),
///   B(f) = x_l / (1 + x_l) / (1 + x_h),   x_l = (f/f_l)^2, x_h = (f/f_h)^2,
///
/// the level going with 30 log10 v (an engineering law). B is a first-order band-pass, half power at its ends
/// where these lie far apart. Whether the ball rolls at all is for CalcRollingSpeed (acoustics/scene.h) to
/// say. Range v >= 0, f > 0.
double CalcRollingPsd(const RollingParams& params, double speed_m_s, double f_Hz);

}  // namespace piperun::acoustics
