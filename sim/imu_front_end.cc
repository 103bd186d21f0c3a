#include "sim/imu_front_end.h"

#include <algorithm>
#include <cmath>

namespace piperun::sim {
namespace {

void Start(FrontEndState& state, const Vector3d& x, const Vector3d& bias, const FrontEnd& front_end) {
  const Vector3d digital = (x + bias).cwiseMax(-front_end.range).cwiseMin(front_end.range);
  state.analogue = MakeSteady(front_end.filter.analogue, x);
  state.digital = MakeSteady(front_end.filter.digital, digital);
  state.boxcar = MakeSteady(digital);
  state.started = true;
}

Vector3d Clip(const Vector3d& z, double range, unsigned& saturated) {
  Vector3d clipped = z;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(z[axis]) <= range) continue;
    saturated |= 1U << axis;
    clipped[axis] = std::copysign(range, z[axis]);
  }
  return clipped;
}

}  // namespace

Vector3d StepFrontEnd(FrontEndState& state, const Vector3d& x, const Vector3d& white, const Vector3d& bias,
                      const FrontEnd& front_end, unsigned& saturated) {
  const ImuFilter& filter = front_end.filter;
  if (!state.started) Start(state, x, bias, front_end);
  Vector3d z = x + front_end.noise_sd * white;
  if (filter.has_analogue) z = Step(state.analogue, z, filter.analogue);
  Vector3d y = Clip(z + bias, front_end.range, saturated);
  if (filter.has_digital) y = Step(state.digital, y, filter.digital);
  if (filter.taps > 0) y = Step(state.boxcar, y, filter.taps);
  return y;
}

}  // namespace piperun::sim
