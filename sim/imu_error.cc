#include "sim/imu_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace piperun::sim {
namespace {

// Slots within a triad. Each term has its own, or its own half of one, so that switching one on or off
// changes no other.
constexpr std::uint64_t kNoiseSlot = 0;
constexpr std::uint64_t kWalkSlot = 1;  // and b_GM
constexpr std::uint64_t kPoleSlot = 2;  // four, of two poles each
constexpr std::uint64_t kBiasSlot = 8;
constexpr std::uint64_t kScaleSlot = 9;
constexpr std::uint64_t kPoleStartSlot = 10;  // four
static_assert(kPoleStartSlot + kFlickerPoles / 2 <= kTriadSlots);

// and beyond kMoreTriadSlots
constexpr std::uint64_t kScaleDriftSlot = kMoreTriadSlots;
constexpr std::uint64_t kRoundingSlot = kMoreTriadSlots + 1;
constexpr std::uint64_t kStepNoiseSlot = kMoreTriadSlots + 2;
constexpr std::uint64_t kStartSlot = kMoreTriadSlots + 3;  // of b_GM and s_i
constexpr std::uint64_t kRoundingStartSlot = kMoreTriadSlots + 4;
constexpr std::uint64_t kMisalignmentSlot = kMoreTriadSlots + 5;

constexpr double kUpdatesPerTime = 16;  // of a slow process

Vector3d Normal3(const TriadStream& s, std::uint64_t sample, std::uint64_t slot) {
  const auto n = s.random.Normals(sample, s.first_slot + slot);
  return {n[0], n[1], n[2]};
}

GaussMarkov MakeGaussMarkov(double sd, double correlation_s, double dt_s) {
  return {sd, std::exp(-dt_s / correlation_s), sd * std::sqrt(-std::expm1(-2 * dt_s / correlation_s))};
}

/// Updated every sample, or every T / 16 where that is longer.
GaussMarkov MakeHeldGaussMarkov(double sd, double correlation_s, double dt_s) {
  const double hold = std::max(1.0, std::floor(correlation_s / (kUpdatesPerTime * dt_s)));
  GaussMarkov process = MakeGaussMarkov(sd, correlation_s, hold * dt_s);
  process.hold = static_cast<std::int64_t>(hold);
  return process;
}

Vector3d First(const std::array<double, 6>& n) { return {n[0], n[1], n[2]}; }
Vector3d Second(const std::array<double, 6>& n) { return {n[3], n[4], n[5]}; }

std::array<double, 6> SixNormals(const TriadStream& s, std::uint64_t sample, std::uint64_t slot) {
  return s.random.SixNormals(sample, s.first_slot + slot);
}

/// Three numbers even on (-1/2, 1/2).
Vector3d Even3(const TriadStream& s, std::uint64_t sample, std::uint64_t slot) {
  const auto u = s.random.Uniforms(sample, s.first_slot + slot);
  return Vector3d(u[0], u[1], u[2]) - Vector3d::Constant(0.5);
}

Matrix3d DrawMisalignment(double sd, const TriadStream& stream) {
  Matrix3d m = Matrix3d::Zero();
  const auto n = SixNormals(stream, 0, kMisalignmentSlot);
  m << 0, n[0], n[1], n[2], 0, n[3], n[4], n[5], 0;
  return sd * m;
}

TriadCurvature MakeCurvature(const TriadErrorParams& p) {
  TriadCurvature c{p.scale_second_order, 0.5 * p.scale_asymmetry, p.vibration_rectification};
  c.on = !(c.second_order.isZero(0) && c.half_asymmetry.isZero(0) && c.rectification.isZero(0));
  return c;
}

Vector3d CalcCurvature(const Vector3d& x, const Vector3d& f, const TriadCurvature& c) {
  const Vector3d size = x.cwiseAbs();
  const Vector3d squares = c.whole_force ? Vector3d::Constant(f.squaredNorm()) : Vector3d(f.cwiseAbs2());
  return c.second_order.cwiseProduct(size).cwiseProduct(x) + c.half_asymmetry.cwiseProduct(size) +
         c.rectification.cwiseProduct(squares);
}

void MakeDrift(const TriadErrorParams& p, double dt_s, TriadErrorCoefficients& c) {
  c.markov = MakeGaussMarkov(p.gauss_markov_sd, p.gauss_markov_time_s, dt_s);
  c.scale_drift = MakeHeldGaussMarkov(p.scale_instability, p.scale_instability_time_s, dt_s);
  c.bias_per_K = p.temperature_bias;
  c.scale_per_K = p.temperature_scale;
  c.ramp = dt_s * p.rate_ramp;
  c.quantum_rate = std::sqrt(12.0) * p.quantisation / dt_s;
  c.has_deterministic_drift = !(c.bias_per_K.isZero(0) && c.ramp.isZero(0));
  c.has_scale_drift = !c.scale_per_K.isZero(0) || c.scale_drift.sd > 0;
}

Vector3d Next(const GaussMarkov& process, const Vector3d& x, const Vector3d& normals) {
  return process.decay * x + process.drive * normals;
}

/// The poles whose time has come, two from each block of normals.
void StepPoles(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
               const TriadErrorCoefficients& c) {
  for (std::size_t i = 0; i < kFlickerPoles; i += 2) {
    if (k < state.pole_due[i] && k < state.pole_due[i + 1]) continue;
    const auto n = SixNormals(stream, static_cast<std::uint64_t>(k), kPoleSlot + i / 2);
    for (const std::size_t j : {i, i + 1}) {
      if (k < state.pole_due[j]) continue;
      state.poles[j] = Next(c.poles[j], state.poles[j], j == i ? First(n) : Second(n));
      state.pole_due[j] += c.poles[j].hold;
    }
  }
}

void StepWalkAndMarkov(TriadErrorState& state, std::uint64_t k, const TriadStream& stream,
                       const TriadErrorCoefficients& c) {
  const auto n = SixNormals(stream, k, kWalkSlot);
  state.walk += c.walk_sd * First(n);
  state.markov = Next(c.markov, state.markov, Second(n));
}

void StepScaleMarkov(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                     const TriadErrorCoefficients& c) {
  if (k < state.scale_due) return;
  const auto n = SixNormals(stream, static_cast<std::uint64_t>(k), kScaleDriftSlot);
  state.scale_markov = Next(c.scale_drift, state.scale_markov, First(n));
  state.scale_due += c.scale_drift.hold;
}

}  // namespace

TriadErrorCoefficients MakeCoefficients(const TriadErrorParams& p, Rate rate, const TriadStream& stream) {
  const double dt = rate.Period_s();
  const Vector3d scale = p.scale_error + p.scale_error_sd * Normal3(stream, 0, kScaleSlot);
  TriadErrorCoefficients c;
  c.sensitivity = Matrix3d::Identity() + p.misalignment;
  if (p.misalignment_sd > 0) c.sensitivity += DrawMisalignment(p.misalignment_sd, stream);
  c.sensitivity.diagonal() += scale;
  c.bias = p.bias + p.bias_sd * Normal3(stream, 0, kBiasSlot);
  c.noise_sd = p.noise / std::sqrt(dt);
  c.pole_sd = p.bias_instability * std::sqrt(kFlickerVariance);
  for (std::size_t i = 0; i < kFlickerPoles; ++i) {
    c.poles[i] = MakeHeldGaussMarkov(c.pole_sd, kFlickerTimes_s[i], dt);
  }
  c.walk_sd = p.rate_random_walk * std::sqrt(dt);
  if (p.range) c.output.range = *p.range;
  c.output.resolution = p.resolution;
  c.curvature = MakeCurvature(p);
  c.g_sensitivity = p.g_sensitivity;
  c.has_g_sensitivity = !p.g_sensitivity.isZero(0);
  MakeDrift(p, dt, c);
  return c;
}

TriadErrorState MakeState(const TriadErrorCoefficients& c, const TriadStream& stream) {
  TriadErrorState state;
  for (std::size_t i = 0; i < kFlickerPoles; i += 2) {
    const auto n = SixNormals(stream, 0, kPoleStartSlot + i / 2);
    state.poles[i] = c.pole_sd * First(n);
    state.poles[i + 1] = c.pole_sd * Second(n);
  }
  for (std::size_t i = 0; i < kFlickerPoles; ++i) state.pole_due[i] = c.poles[i].hold;
  state.scale_due = c.scale_drift.hold;
  const auto n = SixNormals(stream, 0, kStartSlot);
  state.markov = c.markov.sd * First(n);
  state.scale_markov = c.scale_drift.sd * Second(n);
  state.rounding = Even3(stream, 0, kRoundingStartSlot);
  return state;
}

Vector3d CalcBias(const TriadErrorState& state, const TriadErrorCoefficients& c) {
  Vector3d bias = c.bias + state.walk;
  if (c.pole_sd > 0) {
    for (const Vector3d& pole : state.poles) bias += pole;
  }
  if (c.markov.sd > 0) bias += state.markov;
  if (c.has_deterministic_drift) bias += state.deterministic_drift;
  return bias;
}

void StepDrift(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
               const TriadErrorCoefficients& c, double warming_K) {
  if (k > 0 && (c.walk_sd > 0 || c.markov.sd > 0)) {
    StepWalkAndMarkov(state, static_cast<std::uint64_t>(k), stream, c);
  }
  if (k > 0 && c.pole_sd > 0) StepPoles(state, k, stream, c);
  if (k > 0 && c.scale_drift.sd > 0) StepScaleMarkov(state, k, stream, c);
  if (c.has_deterministic_drift) {
    state.deterministic_drift = warming_K * c.bias_per_K + static_cast<double>(k) * c.ramp;
  }
  if (c.has_scale_drift) state.scale_drift = warming_K * c.scale_per_K + state.scale_markov;
}

Vector3d StepWhite(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                   const TriadErrorCoefficients& c) {
  const auto sample = static_cast<std::uint64_t>(k);
  Vector3d white = Vector3d::Zero();
  if (c.noise_sd > 0) white = c.noise_sd * First(SixNormals(stream, sample, kNoiseSlot));
  if (c.quantum_rate > 0) {
    const Vector3d before = state.rounding;
    state.rounding = Even3(stream, sample, kRoundingSlot);
    white += c.quantum_rate * (state.rounding - before);
  }
  return white;
}

Vector3d StepError(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                   const TriadErrorCoefficients& c, double warming_K) {
  StepDrift(state, k, stream, c, warming_K);
  return CalcBias(state, c) + StepWhite(state, k, stream, c);
}

Vector3d DrawStepNoise(std::int64_t n, const TriadStream& stream) {
  return First(SixNormals(stream, static_cast<std::uint64_t>(n), kStepNoiseSlot));
}

Vector3d CalcResponse(const Vector3d& x, const Vector3d& f, const TriadErrorState& state,
                      const TriadErrorCoefficients& c) {
  Vector3d y = c.sensitivity * x;
  if (c.has_scale_drift) y += state.scale_drift.cwiseProduct(x);
  if (c.has_g_sensitivity) y += c.g_sensitivity * f;
  if (c.curvature.on) y += CalcCurvature(x, f, c.curvature);
  return y;
}

}  // namespace piperun::sim
