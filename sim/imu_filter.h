#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <optional>
#include <string>

#include "base/params.h"
#include "base/pose.h"
#include "base/time.h"

namespace piperun::sim {

/// The filters of one triad: analogue, in front of the converter, and digital, behind it. Both run at the
/// physics rate, which stands for the converter's; the output rate decimates what leaves them.
struct ImuFilterParams {
  std::optional<double> analogue_bandwidth_Hz;
  std::int64_t analogue_order = 1;
  std::string digital = "none";
  double digital_bandwidth_Hz = 100;
  std::int64_t digital_taps = 8;

  void Visit(ParamVisitor& v);
  bool on() const { return analogue_bandwidth_Hz || digital != "none"; }
};

/// First- or second-order low-pass of gain 1 at rest, as
/// y_k = b0 x_k + b1 x_{k-1} + b2 x_{k-2} - a1 y_{k-1} - a2 y_{k-2}.
struct LowPass {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

/// The bilinear transform of 1 / (1 + s / w_c) or of the Butterworth pair 1 / (1 + sqrt(2) s / w_c + (s /
/// w_c)^2), w_c = 2 pi bandwidth, warped so that |H| is 1/sqrt(2) exactly at the bandwidth (Oppenheim &
/// Schafer, Discrete-Time Signal Processing, section 7.1). Range: order 1 or 2, bandwidth below half the
/// rate.
LowPass MakeLowPass(std::int64_t order, double bandwidth_Hz, Rate rate);

/// H at a frequency, of the filter as it runs at `rate`.
std::complex<double> CalcResponse(const LowPass& filter, double frequency_Hz, Rate rate);

/// Transposed direct form II, three axes. A value.
struct LowPassState {
  Vector3d s1 = Vector3d::Zero();
  Vector3d s2 = Vector3d::Zero();
};

/// The state in which an input that has always been `x` leaves as x.
LowPassState MakeSteady(const LowPass& filter, const Vector3d& x);

inline Vector3d Step(LowPassState& state, const Vector3d& x, const LowPass& filter) {
  const Vector3d y = filter.b0 * x + state.s1;
  state.s1 = filter.b1 * x - filter.a1 * y + state.s2;
  state.s2 = filter.b2 * x - filter.a2 * y;
  return y;
}

inline constexpr std::int64_t kMostTaps = 64;

/// The last inputs of a boxcar; the mean over `taps` of them is summed anew each time, so that nothing
/// accumulates. A value.
struct BoxcarState {
  std::array<Vector3d, kMostTaps> inputs;
  std::size_t next = 0;
};

BoxcarState MakeSteady(const Vector3d& x);
Vector3d Step(BoxcarState& state, const Vector3d& x, std::size_t taps);

/// What follows from ImuFilterParams and the physics rate.
struct ImuFilter {
  bool has_analogue = false;
  LowPass analogue;
  bool has_digital = false;
  LowPass digital;       ///< where there are no taps
  std::size_t taps = 0;  ///< 0: no boxcar
};

/// Throws InputError (keys analogue_bandwidth_Hz, digital_bandwidth_Hz) for a bandwidth the physics rate
/// cannot represent.
ImuFilter MakeImuFilter(const ImuFilterParams& params, Rate rate);

}  // namespace piperun::sim
