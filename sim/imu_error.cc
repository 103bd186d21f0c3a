#include "sim/imu_error.h"

#include <cmath>
#include <numbers>

namespace piperun::sim {
namespace {

// Slots within a triad. Each term has its own, so that switching one on or off changes no other.
constexpr std::uint64_t kNoiseSlot = 0;
constexpr std::uint64_t kWalkSlot = 1;
constexpr std::uint64_t kPoleSlot = 2;  // six: 24 normals
constexpr std::uint64_t kBiasSlot = 8;
constexpr std::uint64_t kScaleSlot = 9;
constexpr std::uint64_t kPoleStartSlot = 10;  // six
static_assert(kPoleStartSlot + 3 * kFlickerPoles / 4 == kTriadSlots);

constexpr double kFastestPole_s = 1e-2;

Vector3d Normal3(const TriadStream& s, std::uint64_t sample, std::uint64_t slot) {
  const auto n = s.random.Normals(sample, s.first_slot + slot);
  return {n[0], n[1], n[2]};
}

/// Three normals per pole, four per slot.
std::array<Vector3d, kFlickerPoles> PoleNormals(const TriadStream& s, std::uint64_t sample,
                                                std::uint64_t slot) {
  std::array<double, 3 * kFlickerPoles> flat;
  for (std::size_t i = 0; i < flat.size(); i += 4) {
    const auto n = s.random.Normals(sample, s.first_slot + slot + i / 4);
    for (std::size_t j = 0; j < 4; ++j) flat[i + j] = n[j];
  }
  std::array<Vector3d, kFlickerPoles> poles;
  for (std::size_t i = 0; i < kFlickerPoles; ++i) poles[i] = {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
  return poles;
}

void StepPoles(TriadErrorState& state, std::uint64_t k, const TriadStream& stream,
               const TriadErrorCoefficients& c) {
  const auto normals = PoleNormals(stream, k, kPoleSlot);
  for (std::size_t i = 0; i < kFlickerPoles; ++i) {
    state.poles[i] = c.pole_decay[i] * state.poles[i] + c.pole_drive[i] * normals[i];
  }
}

}  // namespace

const TriadFieldNames kGyroFields{
    .bias = "bias_rad_s",
    .bias_sd = "bias_sd_rad_s",
    .noise = "noise_rad_s_sqrtHz",
    .bias_instability = "bias_instability_rad_s",
    .rate_random_walk = "rate_random_walk_rad_s2_sqrtHz",
    .range = "range_rad_s",
    .resolution = "resolution_rad_s",
};

const TriadFieldNames kAccelFields{
    .bias = "bias_m_s2",
    .bias_sd = "bias_sd_m_s2",
    .noise = "noise_m_s2_sqrtHz",
    .bias_instability = "bias_instability_m_s2",
    .rate_random_walk = "rate_random_walk_m_s3_sqrtHz",
    .range = "range_m_s2",
    .resolution = "resolution_m_s2",
};

void TriadErrorParams::Visit(ParamVisitor& v, const TriadFieldNames& names) {
  const Range small = Range::Between(-0.5, 0.5);
  v.Vector({names.bias, "Constant bias of the three axes."}, Range::Any(), bias);
  v.Number({names.bias_sd, "Turn-on bias: standard deviation per axis, drawn once per run."},
           Range::NonNegative(), bias_sd);
  v.Vector({"scale_error", "Constant scale-factor error of the three axes (0.01 reads 1 % too much)."}, small,
           scale_error);
  v.Number({"scale_error_sd", "Scale-factor error: standard deviation per axis, drawn once per run."},
           Range::Between(0, 0.1), scale_error_sd);
  v.Matrix({"misalignment", "M, row by row: M_ij is the part of true axis j that axis i reads too much."},
           small, misalignment);
  v.Number({names.noise, "White noise density N (angle or velocity random walk)."}, Range::NonNegative(),
           noise);
  v.Number({names.bias_instability, "Bias instability B; the Allan deviation is flat at 0.664 B."},
           Range::NonNegative(), bias_instability);
  v.Number({names.rate_random_walk, "Random walk K of the bias."}, Range::NonNegative(), rate_random_walk);
  v.NumberOr({names.range, "The reading saturates at plus and minus this value."}, Range::Positive(), "none",
             range);
  v.Number({names.resolution, "One count of the output register; 0 means unrounded."}, Range::NonNegative(),
           resolution);
}

TriadErrorCoefficients MakeCoefficients(const TriadErrorParams& p, Rate rate, const TriadStream& stream) {
  const double dt = rate.Period_s();
  const Vector3d scale = p.scale_error + p.scale_error_sd * Normal3(stream, 0, kScaleSlot);
  TriadErrorCoefficients c;
  c.sensitivity = Matrix3d::Identity() + p.misalignment;
  c.sensitivity.diagonal() += scale;
  c.bias = p.bias + p.bias_sd * Normal3(stream, 0, kBiasSlot);
  c.noise_sd = p.noise / std::sqrt(dt);
  c.pole_sd = p.bias_instability * std::sqrt(std::numbers::ln10 / std::numbers::pi);
  double correlation_s = kFastestPole_s;
  for (std::size_t i = 0; i < kFlickerPoles; ++i, correlation_s *= 10) {
    c.pole_decay[i] = std::exp(-dt / correlation_s);
    c.pole_drive[i] = c.pole_sd * std::sqrt(-std::expm1(-2 * dt / correlation_s));
  }
  c.walk_sd = p.rate_random_walk * std::sqrt(dt);
  if (p.range) c.output.range = *p.range;
  c.output.resolution = p.resolution;
  return c;
}

TriadErrorState MakeState(const TriadErrorCoefficients& c, const TriadStream& stream) {
  TriadErrorState state;
  state.poles = PoleNormals(stream, 0, kPoleStartSlot);
  for (Vector3d& pole : state.poles) pole *= c.pole_sd;
  return state;
}

Vector3d CalcBias(const TriadErrorState& state, const TriadErrorCoefficients& c) {
  Vector3d bias = c.bias + state.walk;
  if (c.pole_sd > 0) {
    for (const Vector3d& pole : state.poles) bias += pole;
  }
  return bias;
}

Vector3d StepError(TriadErrorState& state, std::int64_t k, const TriadStream& stream,
                   const TriadErrorCoefficients& c) {
  const auto sample = static_cast<std::uint64_t>(k);
  if (k > 0 && c.walk_sd > 0) state.walk += c.walk_sd * Normal3(stream, sample, kWalkSlot);
  if (k > 0 && c.pole_sd > 0) StepPoles(state, sample, stream, c);
  Vector3d error = CalcBias(state, c);
  if (c.noise_sd > 0) error += c.noise_sd * Normal3(stream, sample, kNoiseSlot);
  return error;
}

}  // namespace piperun::sim
