#pragma once

#include <array>
#include <cstdint>

#include "base/flicker.h"
#include "base/pose.h"
#include "base/random.h"
#include "base/time.h"
#include "sim/imu_error_params.h"
#include "sim/output_register.h"

namespace piperun::sim {

inline constexpr std::size_t kFlickerPoles = kFlickerTimes_s.size();

/// Slots of a channel's RandomStream that one triad uses: kTriadSlots from `first_slot`, and as many again
/// from `first_slot` + kMoreTriadSlots.
struct TriadStream {
  RandomStream random;
  std::uint64_t first_slot = 0;
};
inline constexpr std::uint64_t kTriadSlots = 16;
inline constexpr std::uint64_t kMoreTriadSlots = 32;

/// Stationary first-order Gauss-Markov process x <- exp(-dt/T) x + sigma sqrt(1 - exp(-2 dt/T)) w.
struct GaussMarkov {
  double sd = 0;          ///< sigma
  double decay = 1;       ///< exp(-dt / T)
  double drive = 0;       ///< sigma sqrt(1 - exp(-2 dt / T))
  std::int64_t hold = 1;  ///< dt is so many samples: the process stays as it is in between
};

/// What is not linear in the true input, term by term as in TriadErrorParams.
struct TriadCurvature {
  Vector3d second_order = Vector3d::Zero();
  Vector3d half_asymmetry = Vector3d::Zero();
  Vector3d rectification = Vector3d::Zero();
  bool whole_force = false;  ///< rectifies |f|^2, not the axis's own
  bool on = false;
};

/// What follows from the parameters, the sampling rate and the run's draws.
///
/// Bias instability is the sum of Gauss-Markov processes of base/flicker.h. A pole faster than the sampling
/// interval acts as white noise, a slow one moves in steps of T_i / 16, which its Allan variance does not
/// tell from moving with every sample (below 0.1 %).
struct TriadErrorCoefficients {
  Matrix3d sensitivity;                            ///< I + diag(s) + M
  Vector3d bias;                                   ///< b0, u
  double noise_sd = 0;                             ///< u
  double pole_sd = 0;                              ///< sigma, u
  std::array<GaussMarkov, kFlickerPoles> poles{};  ///< u
  double walk_sd = 0;                              ///< K sqrt(dt), u
  OutputRegister output;

  TriadCurvature curvature;
  Matrix3d g_sensitivity = Matrix3d::Zero();
  bool has_g_sensitivity = false;
  GaussMarkov markov;                       ///< b_GM, u
  GaussMarkov scale_drift;                  ///< s_i
  Vector3d bias_per_K = Vector3d::Zero();   ///< c_T
  Vector3d scale_per_K = Vector3d::Zero();  ///< s_T
  Vector3d ramp = Vector3d::Zero();         ///< R dt, u per sample
  double quantum_rate = 0;                  ///< sqrt(12) Q / dt, u
  bool has_deterministic_drift = false;     ///< c_T or R
  bool has_scale_drift = false;             ///< s_T or s_i
};

/// What drifts. A value: copy it to save, assign it to restore.
struct TriadErrorState {
  std::array<Vector3d, kFlickerPoles> poles;
  std::array<std::int64_t, kFlickerPoles> pole_due{};  ///< sample at which each moves next
  std::int64_t scale_due = 0;
  Vector3d walk = Vector3d::Zero();
  Vector3d markov = Vector3d::Zero();               ///< b_GM
  Vector3d scale_markov = Vector3d::Zero();         ///< s_i
  Vector3d rounding = Vector3d::Zero();             ///< of the integrated output before, in counts
  Vector3d deterministic_drift = Vector3d::Zero();  ///< c_T (T - T0) + R t
  Vector3d scale_drift = Vector3d::Zero();          ///< s_T (T - T0) + s_i
};

/// Draws turn-on bias, scale-factor error and misalignment of the run.
TriadErrorCoefficients MakeCoefficients(const TriadErrorParams& params, Rate rate, const TriadStream& stream);

/// The state at sample 0: every Gauss-Markov process drawn from its stationary distribution, the walk at
/// zero.
TriadErrorState MakeState(const TriadErrorCoefficients& c, const TriadStream& stream);

/// The part of the error that is no white noise: b0 + c_T (T - T0) + b_GM + b_B + b_K + R t, in u.
Vector3d CalcBias(const TriadErrorState& state, const TriadErrorCoefficients& c);

/// Advances what drifts to sample k (from sample k - 1; nothing random moves for k = 0). Call once per
/// sample, in order. `warming_K` is the temperature above the reference.
void StepDrift(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
               const TriadErrorCoefficients& c, double warming_K = 0);

/// White noise of sample k, and the rounding of the integrated output: (e_k - e_{k-1}) LSB / dt, LSB =
/// sqrt(12) Q, e_k even on +-1/2 and independent, as the motion or the dither of the sensor spreads the
/// integral over a count. In u. Call once per sample, in order.
Vector3d StepWhite(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                   const TriadErrorCoefficients& c);

/// StepDrift, then everything that adds to the reading: CalcBias + StepWhite, in u.
Vector3d StepError(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                   const TriadErrorCoefficients& c, double warming_K = 0);

/// White noise of physics step n with density N, for a chain whose filters it passes; in units of its sd.
Vector3d DrawStepNoise(std::int64_t n, const TriadStream& stream);

/// What the axes make of the true input x under the specific force f, before anything adds to it: (I + diag(s
/// + s_T (T - T0) + s_i) + M) x + s2 |x| x + a/2 |x| + v f^2 + G f. All but the curvature may be given means.
Vector3d CalcResponse(const Vector3d& x, const Vector3d& f, const TriadErrorState& state,
                      const TriadErrorCoefficients& c);

/// The reading of true value `x` with additive error `error`.
inline Vector3d CalcReading(const Vector3d& x, const Vector3d& error, const TriadErrorCoefficients& c) {
  return c.output.Read(Vector3d(c.sensitivity * x + error));
}

}  // namespace piperun::sim
