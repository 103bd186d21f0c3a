#pragma once

#include <array>
#include <numbers>

namespace piperun {

/// Bias instability (flicker noise) of coefficient B as the sum of eight stationary first-order Gauss-Markov
/// processes, one per decade, each of variance B^2 ln(10) / pi. Their density is that of IEEE Std 952's
/// flicker noise, B^2 / (2 pi f), and their Allan deviation flat at sqrt(2 ln 2 / pi) B = 0.664 B, within
/// 1.5 % from 0.2 s to 20,000 s. The simulator makes it so, and the Allan tool fits it in the same form.
inline constexpr std::array<double, 8> kFlickerTimes_s{1e-2, 1e-1, 1, 1e1, 1e2, 1e3, 1e4, 1e5};
/// Of each process, for B = 1.
inline constexpr double kFlickerVariance = std::numbers::ln10 / std::numbers::pi;

}  // namespace piperun
