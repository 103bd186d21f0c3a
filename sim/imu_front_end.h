#pragma once

#include <cstdint>

#include "sim/imu_filter.h"

namespace piperun::sim {

/// What a triad does to its signal before samples are formed, physics step by physics step:
///   z_n = A{ x_n + n_n } + b,  y_n = D{ clip{ z_n } }
/// with x the axes' response, n white noise, A the analogue low-pass, b the drifting bias, which no low-pass
/// changes, D the digital filter.
struct FrontEnd {
  ImuFilter filter;
  double noise_sd = 0;  ///< per step
  double range;
};

/// A value. Starts steady: before the first step the input has always been that of the first step.
struct FrontEndState {
  LowPassState analogue;
  LowPassState digital;
  BoxcarState boxcar;
  bool started = false;
};

/// y_n from x_n, `white` (unit variance) and b. Sets the bits of `saturated` for axes that were clipped.
Vector3d StepFrontEnd(FrontEndState& state, const Vector3d& x, const Vector3d& white, const Vector3d& bias,
                      const FrontEnd& front_end, unsigned& saturated);

}  // namespace piperun::sim
