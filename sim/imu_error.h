#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/params.h"
#include "base/pose.h"
#include "base/random.h"
#include "base/time.h"
#include "sim/output_register.h"

namespace piperun::sim {

/// Names of the fields whose unit differs between gyroscope (u = rad/s) and accelerometer (u = m/s^2).
struct TriadFieldNames {
  std::string_view bias;
  std::string_view bias_sd;
  std::string_view noise;
  std::string_view bias_instability;
  std::string_view rate_random_walk;
  std::string_view range;
  std::string_view resolution;
};
extern const TriadFieldNames kGyroFields;
extern const TriadFieldNames kAccelFields;

/// Errors of three orthogonal inertial axes, in the triad's own unit u. The defaults are those of an ideal
/// sensor. In the sensor frame S, with x the true mean over the sampling interval and one row per axis,
///
///   y = Q{ clip{ (I + diag(s) + M) x + b0 + b_B(t) + b_K(t) + n } }
///
/// s: scale-factor error, fixed + sd per run; M: misalignment, M_ij (i != j) the part of x_j that axis i
/// sees, to first order an angle in rad (a common rotation is the antisymmetric part), diagonal added to s;
/// b0: bias, fixed + drawn at turn-on; n: white noise of density N, sd N / sqrt(dt) per sample; b_B: bias
/// instability (below); b_K: random walk of the bias, step K sqrt(dt). Terms and symbols: IEEE Std 952-1997,
/// annex C.
struct TriadErrorParams {
  Vector3d bias = Vector3d::Zero();          ///< u
  double bias_sd = 0;                        ///< u, per axis and run
  Vector3d scale_error = Vector3d::Zero();   ///< dimensionless
  double scale_error_sd = 0;                 ///< dimensionless, per axis and run
  Matrix3d misalignment = Matrix3d::Zero();  ///< M, dimensionless
  double noise = 0;                          ///< N, u / sqrt(Hz)
  double bias_instability = 0;               ///< B, u
  double rate_random_walk = 0;               ///< K, u / s / sqrt(Hz)
  std::optional<double> range;               ///< u, clips at +-range
  double resolution = 0;                     ///< u per count of the output register

  void Visit(ParamVisitor& v, const TriadFieldNames& names);
};

inline constexpr std::size_t kFlickerPoles = 8;

/// Slots of a channel's RandomStream that one triad uses: kTriadSlots from `first_slot`.
struct TriadStream {
  RandomStream random;
  std::uint64_t first_slot = 0;
};
inline constexpr std::uint64_t kTriadSlots = 16;

/// What follows from the parameters, the sampling rate and the run's draws.
///
/// Bias instability is a sum of eight stationary first-order Gauss-Markov processes with correlation times
/// T_i = 1e-2, 1e-1 .. 1e5 s, each of variance sigma^2 = B^2 ln(10) / pi. Their Allan deviation is flat at
/// sqrt(2 ln 2 / pi) B = 0.664 B within 1.3 % from 0.3 s to 1000 s; a pole faster than the sampling interval
/// acts as white noise.
struct TriadErrorCoefficients {
  Matrix3d sensitivity;                            ///< I + diag(s) + M
  Vector3d bias;                                   ///< b0, u
  double noise_sd = 0;                             ///< u
  double pole_sd = 0;                              ///< sigma, u
  std::array<double, kFlickerPoles> pole_decay{};  ///< exp(-dt / T_i)
  std::array<double, kFlickerPoles> pole_drive{};  ///< sigma sqrt(1 - exp(-2 dt / T_i)), u
  double walk_sd = 0;                              ///< K sqrt(dt), u
  OutputRegister output;
};

/// What drifts. A value: copy it to save, assign it to restore.
struct TriadErrorState {
  std::array<Vector3d, kFlickerPoles> poles;
  Vector3d walk = Vector3d::Zero();
};

/// Draws turn-on bias and scale-factor error of the run.
TriadErrorCoefficients MakeCoefficients(const TriadErrorParams& params, Rate rate, const TriadStream& stream);

/// The state at sample 0: every pole drawn from its stationary distribution, the walk at zero.
TriadErrorState MakeState(const TriadErrorCoefficients& c, const TriadStream& stream);

/// The part of the error that is no white noise: b0 + b_B + b_K, in u.
Vector3d CalcBias(const TriadErrorState& state, const TriadErrorCoefficients& c);

/// Advances `state` to sample k (from sample k - 1; nothing moves for k = 0) and returns everything that adds
/// to the reading there: b0 + b_B + b_K + n, in u. Call once per sample, in order.
Vector3d StepError(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                   const TriadErrorCoefficients& c);

/// The reading of true value `x` with additive error `error`.
inline Vector3d CalcReading(const Vector3d& x, const Vector3d& error, const TriadErrorCoefficients& c) {
  return c.output.Read(Vector3d(c.sensitivity * x + error));
}

}  // namespace piperun::sim
