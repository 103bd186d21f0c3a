#pragma once

#include <cstdint>
#include <vector>

#include "base/time.h"
#include "sim/turbulence.h"

namespace piperun::sim {

/// What a record of fluctuations at one place comes out as, per axis of W.
struct TurbulenceStatistics {
  Vector3d rms_m_s = Vector3d::Zero();
  Vector3d integral_time_s = Vector3d::Zero();
  Vector3d acceleration_m_s2 = Vector3d::Zero();  ///< rms of Du'/Dt, without mean flow
  std::int64_t blocks = 0;
};

/// A record at `rate` of `blocks` blocks of W = 5 `nominal_s`, held at a place. The integral time follows
/// from the displacements X in a block, whose variance is for the two-time-scale correlation
///
///   <X^2> = 2 sigma^2 (T W - (T1^3 (1 - e^(-W/T1)) - T2^3 (1 - e^(-W/T2)))/(T1 - T2))
///
/// solved for T = T1 + T2 with T2/T as given (not 1/2). One component of T scatters by about sqrt(2/blocks).
TurbulenceStatistics MeasureTurbulence(const TurbulentPlace& place, const TurbulenceCoefficients& c,
                                       Rate rate, double nominal_s, std::int64_t blocks, std::uint64_t seed);

/// How tracers of the water lie in rings of equal area of a pipe of R = 1 with u* = 1 after `duration` R/u*,
/// released uniformly: x' = S xi, steps of `step` R/u*, mirrored at the wall together with xi and eta.
/// c.response 1 keeps them uniform; with 0 they gather where the water fluctuates least.
std::vector<std::int64_t> TraceTracers(const TurbulenceCoefficients& c, std::int64_t tracers, int rings,
                                       double duration, double step, std::uint64_t seed);

}  // namespace piperun::sim
